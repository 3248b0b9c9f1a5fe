// People, and what they hold or sit in, of one level of detail, drawn at once by the graphics card or
// what stands in for it.
"use strict";

const PARTS = 7, FOREARM = 1; // of a figure: see animation/figures/clothes.py
const SHADOW_DARK = 0.34, SHADOW_WIDE = 0.48, OVER_MARKINGS = 0.012; // opacity; metres; metres above the floor

// Light is worked out for each corner: without a graphics card each pixel is dear.
const SHADE = `
  vec3 shaded(vec3 colour, vec3 normal) {
    float sun = max(dot(normal, vec3(0.35, -0.42, 0.84)), 0.0);
    return colour * (0.56 + 0.13 * normal.z + 0.42 * sun);
  }`;
const FRAGMENT = "in vec3 vColour; out vec4 painted; void main() { painted = vec4(vColour, 1.0); }";
const CLOTHED = (looks) => `
  uniform vec3 looks[${looks * PARTS}];
  in float part, look; in vec3 colour; out vec3 vColour;
  vec3 worn() {
    int own = int(look) * ${PARTS}, at = own + int(part);
    bool top = part < 0.5 || (int(part) == ${FOREARM} && looks[at] == looks[own]);
    return top ? colour : looks[at];
  }`;
// From afar a corner goes with one joint.
const FIGURE_VERTEX = (fine, looks) => `
  uniform sampler2D bones;
  in vec2 joints; in float weight, row;
  vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  ${SHADE} ${CLOTHED(looks)}
  void main() {
    int own = int(row), a = 2 * int(joints.x);
    vec4 q = texelFetch(bones, ivec2(a, own), 0), p = texelFetch(bones, ivec2(a + 1, own), 0);
    vec3 place = turn(q, position) * p.w + p.xyz, facing = turn(q, normal);
    if (${fine} && weight < 0.999) {
      int b = 2 * int(joints.y);
      q = texelFetch(bones, ivec2(b, own), 0); p = texelFetch(bones, ivec2(b + 1, own), 0);
      place = mix(turn(q, position) * p.w + p.xyz, place, weight);
    }
    vColour = shaded(worn(), facing);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }`;
const STAND = `
  in vec4 stand; in float rise;
  mat3 facing() {
    float c = cos(stand.z), s = sin(stand.z);
    return mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
  }`;
const RIGID_VERTEX = (looks) => `
  ${STAND} ${SHADE} ${CLOTHED(looks)}
  void main() {
    mat3 turned = facing();
    vColour = shaded(worn(), turned * normal);
    gl_Position = projectionMatrix * viewMatrix * vec4(turned * position * stand.w + vec3(stand.xy, rise), 1.0);
  }`;
// Shadows are soft discs on the floor, a little away from the sun.
const SHADOW_VERTEX = `
  ${STAND} in float dark; out float vDark;
  void main() {
    vDark = dark;
    vec3 place = facing() * position * stand.w + vec3(stand.xy + vec2(-0.06, 0.07), rise);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }`;
const DARK_FRAGMENT = "in float vDark; out vec4 painted; void main() { painted = vec4(0.05, 0.06, 0.08, vDark); }";
const WALL_VERTEX = `
  uniform vec3 colour; out vec3 vColour;
  void main() {
    vColour = colour * (0.78 + 0.2 * abs(normal.y) + 0.2 * normal.z);
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

const WALL_FRAGMENT = "uniform float opacity; in vec3 vColour; out vec4 painted; void main() { painted = vec4(vColour, opacity); }";
const FLAT_VERTEX = "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
const FLAT_FRAGMENT = "uniform vec4 painting; out vec4 painted; void main() { painted = painting; }";
const CONTACT_VERTEX = `
  in float dark; out float vDark;
  void main() {
    vDark = dark;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

function shadowDisc() {
  const round = 12, vertices = [0, 0, 0], darks = [SHADOW_DARK], triangles = [], rings = [[0.45, 0.62], [1, 0]];
  for (const [size, share] of rings) {
    for (let k = 0; k < round; k += 1) {
      const angle = (2 * Math.PI * k) / round;
      vertices.push(0.8 * size * SHADOW_WIDE * Math.cos(angle), size * SHADOW_WIDE * Math.sin(angle), 0);
      darks.push(SHADOW_DARK * share);
    }
  }
  for (let k = 0; k < round; k += 1) {
    const a = 1 + k, b = 1 + ((k + 1) % round);
    triangles.push(0, a, b, a, a + round, b + round, a, b + round, b);
  }
  return { vertices: new Float32Array(vertices), darks: new Float32Array(darks), triangles: new Uint16Array(triangles) };
}

// Copies of one mesh, drawn at once: bent by their rows of bones, or rigid where it has no joints.
class Troop {
  // What is not the same for all copies: the length of each, and the material that draws them.
  constructor(mesh, sizes, material, scene) {
    this.geometry = new THREE.InstancedBufferGeometry();
    const set = (name, values, size) => values && this.geometry.setAttribute(name, new THREE.BufferAttribute(values, size));
    set("position", mesh.vertices, 3);
    set("normal", mesh.normals, 3);
    set("joints", mesh.joints, 2);
    set("weight", mesh.weights, 1);
    set("part", mesh.parts, 1);
    set("dark", mesh.darks, 1);
    this.geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
    this.sizes = sizes;
    this.room = 0;
    this.count = 0;
    scene.add(this.mesh);
  }

  // For each copy its colour and look, and its row of bones or its place (x, y, heading, size) and elevation.
  add(values) {
    if (this.count === this.room) this.enlarge(Math.max(64, 2 * this.room));
    for (const name of Object.keys(this.sizes)) {
      const { array } = this.geometry.attributes[name], from = this.count * this.sizes[name];
      if (this.sizes[name] === 1) array[from] = values[name];
      else array.set(values[name], from);
    }
    this.count += 1;
  }

  enlarge(room) {
    this.room = room;
    this.geometry.dispose(); // three.js keeps how many copies there were room for
    for (const [name, size] of Object.entries(this.sizes)) {
      const before = this.geometry.attributes[name], values = new Float32Array(room * size);
      if (before) values.set(before.array);
      const made = new THREE.InstancedBufferAttribute(values, size);
      made.setUsage(THREE.DynamicDrawUsage);
      this.geometry.setAttribute(name, made);
    }
  }

  finish() {
    this.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const [name, size] of Object.entries(this.sizes)) {
      const each = this.geometry.attributes[name];
      if (!each) continue;
      each.clearUpdateRanges();
      each.addUpdateRange(0, this.count * size);
      each.needsUpdate = true;
    }
  }
}

// Troops by the names of their meshes: see animation/figures/levels.py.
class Troops {
  // looks: colours of each look, in the order of PARTS.
  constructor(meshes, looks, bones, scene) {
    const worn = { value: looks.flat().map(channels).map((each) => new THREE.Vector3(...each)) };
    const material = (vertexShader, uniforms, more = {}) => new THREE.ShaderMaterial({ vertexShader, uniforms,
      fragmentShader: FRAGMENT, glslVersion: THREE.GLSL3, ...more });
    this.all = Object.entries(meshes).map(([name, mesh]) => {
      const own = mesh.joints ? { row: 1 } : { stand: 4, rise: 1 };
      const vertex = mesh.joints ? FIGURE_VERTEX(name.endsWith("_near"), looks.length) : RIGID_VERTEX(looks.length);
      const uniforms = mesh.joints ? { bones, looks: worn } : { looks: worn };
      return [name, new Troop(mesh, { colour: 3, look: 1, ...own }, material(vertex, uniforms), scene)];
    });
    this.named = Object.fromEntries(this.all);
    this.shadows = new Troop(shadowDisc(), { stand: 4, rise: 1 }, material(SHADOW_VERTEX, {}, { fragmentShader: DARK_FRAGMENT,
      transparent: true, depthWrite: false }), scene);
  }

  begin() {
    this.shadows.count = 0;
    for (const [, troop] of this.all) troop.count = 0;
  }

  add(name, values) { this.named[name].add(values); }

  finish() {
    this.shadows.finish();
    for (const [, troop] of this.all) troop.finish();
  }

  // How many of each are drawn.
  counts() { return Object.fromEntries(this.all.filter(([, { count }]) => count).map(([name, { count }]) => [name, count])); }
}
