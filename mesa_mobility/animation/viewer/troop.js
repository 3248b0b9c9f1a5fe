// People, and what they hold or sit in, of one level of detail, drawn at once by the graphics card or
// what stands in for it.
"use strict";

// Light is worked out for each corner: without a graphics card each pixel is dear.
const SHADE = `
  vec3 shaded(vec3 colour, vec3 normal) {
    float sun = max(dot(normal, vec3(0.35, -0.42, 0.84)), 0.0);
    return colour * (0.62 + 0.12 * normal.z + 0.34 * sun);
  }`;
const FRAGMENT = "in vec3 vColour; out vec4 painted; void main() { painted = vec4(vColour, 1.0); }";
// From afar a corner goes with one joint.
const FIGURE_VERTEX = (fine) => `
  uniform sampler2D bones;
  in vec2 joints; in float weight, row; in vec3 colour; out vec3 vColour;
  vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  ${SHADE}
  void main() {
    int own = int(row), a = 2 * int(joints.x);
    vec4 q = texelFetch(bones, ivec2(a, own), 0), p = texelFetch(bones, ivec2(a + 1, own), 0);
    vec3 place = turn(q, position) * p.w + p.xyz, facing = turn(q, normal);
    if (${fine} && weight < 0.999) {
      int b = 2 * int(joints.y);
      q = texelFetch(bones, ivec2(b, own), 0); p = texelFetch(bones, ivec2(b + 1, own), 0);
      place = mix(turn(q, position) * p.w + p.xyz, place, weight);
    }
    vColour = shaded(colour, facing);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }`;
const RIGID_VERTEX = `
  in vec4 stand; in float rise; in vec3 colour; out vec3 vColour; ${SHADE}
  void main() {
    float c = cos(stand.z), s = sin(stand.z);
    mat3 turned = mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    vColour = shaded(colour, turned * normal);
    gl_Position = projectionMatrix * viewMatrix * vec4(turned * position * stand.w + vec3(stand.xy, rise), 1.0);
  }`;
const WALL_VERTEX = `
  uniform vec3 colour; out vec3 vColour;
  void main() {
    vColour = colour * (0.72 + 0.28 * abs(normal.y) + 0.12 * normal.z);
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

// Copies of one mesh, drawn at once: bent by their rows of bones, or rigid where it has no joints.
class Troop {
  constructor(mesh, fine, bones, scene) {
    this.geometry = new THREE.InstancedBufferGeometry();
    const set = (name, values, size) => this.geometry.setAttribute(name, new THREE.BufferAttribute(values, size));
    set("position", mesh.vertices, 3);
    set("normal", mesh.normals, 3);
    if (mesh.joints) {
      set("joints", mesh.joints, 2);
      set("weight", mesh.weights, 1);
    }
    this.geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    const material = new THREE.ShaderMaterial({ vertexShader: mesh.joints ? FIGURE_VERTEX(fine) : RIGID_VERTEX,
      fragmentShader: FRAGMENT, uniforms: mesh.joints ? { bones } : {}, glslVersion: THREE.GLSL3 });
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
    this.sizes = mesh.joints ? { colour: 3, row: 1 } : { colour: 3, stand: 4, rise: 1 };
    this.room = 0;
    this.count = 0;
    scene.add(this.mesh);
  }

  // For each copy its colour, and its row of bones or its place (x, y, heading, size) and elevation.
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

// Troops by the names of their meshes: see animation/levels.py.
class Troops {
  constructor(meshes, bones, scene) {
    this.all = Object.entries(meshes).map(([name, mesh]) => [name, new Troop(mesh, name.endsWith("_near"), bones, scene)]);
    this.named = Object.fromEntries(this.all);
  }

  begin() { for (const [, troop] of this.all) troop.count = 0; }

  add(name, values) { this.named[name].add(values); }

  finish() { for (const [, troop] of this.all) troop.finish(); }

  // How many of each are drawn.
  counts() { return Object.fromEntries(this.all.filter(([, { count }]) => count).map(([name, { count }]) => [name, count])); }
}
