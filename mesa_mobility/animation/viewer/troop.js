// People, and what they hold or sit in, of one level of detail, and their shadows.
"use strict";

const BONES = 22, PARTS = 7, TOP = 0, FOREARM = 1; // of a figure: see animation/figures/clothes.py
const NOT_OWN = [-1, -1, -1];
const SHADOW_DARK = 0.34, SHADOW_WIDE = 0.48, OVER_MARKINGS = 0.012; // opacity; metres; metres above the floor

// Light is worked out for each corner, as there are fewer of them than pixels.
const SHADE = `
  vec3 shaded(vec3 colour, vec3 normal) {
    float sun = max(dot(normal, vec3(0.35, -0.42, 0.84)), 0.0);
    return colour * (0.56 + 0.13 * normal.z + 0.42 * sun);
  }`;
const FRAGMENT = "in vec3 vColour; out vec4 painted; void main() { painted = vec4(vColour, 1.0); }";
// The colour of the top is a copy's own.
const CLOTHED = (looks) => `
  uniform vec3 looks[${looks * PARTS}];
  in float part; out vec3 vColour;
  vec3 worn() {
    vec3 own = looks[int(look) * ${PARTS} + int(part)];
    return own.x < 0.0 ? colour : own;
  }`;
// A person has 2 texels for each bone, beside other people. From afar a corner goes with one joint.
const FIGURE_VERTEX = (fine, looks) => `
  uniform sampler2D bones;
  in vec2 joints; in float weight;
  vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  ${SHADE} ${CLOTHED(looks)}
  void main() {
    if (!copy()) return;
    int own = int(row), a = 2 * int(joints.x), x = ${2 * BONES} * (own % ${ABREAST}), y = own / ${ABREAST};
    vec4 q = texelFetch(bones, ivec2(x + a, y), 0), p = texelFetch(bones, ivec2(x + a + 1, y), 0);
    vec3 place = turn(q, position) * p.w + p.xyz, facing = turn(q, normal);
    if (${fine} && weight < 0.999) {
      int b = 2 * int(joints.y);
      q = texelFetch(bones, ivec2(x + b, y), 0); p = texelFetch(bones, ivec2(x + b + 1, y), 0);
      place = mix(turn(q, position) * p.w + p.xyz, place, weight);
    }
    vColour = shaded(worn(), facing);
    gl_Position = projectionMatrix * (viewMatrix * vec4(place, 1.0));
  }`;
const FACING = `
  mat3 facing() {
    float c = cos(stand.z), s = sin(stand.z);
    return mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
  }`;
const RIGID_VERTEX = (looks) => `
  ${FACING} ${SHADE} ${CLOTHED(looks)}
  void main() {
    if (!copy()) return;
    mat3 turned = facing();
    vColour = shaded(worn(), turned * normal);
    vec3 place = turned * position * stand.w + vec3(stand.xy, rise);
    gl_Position = projectionMatrix * (viewMatrix * vec4(place, 1.0));
  }`;
// Shadows are soft discs on the floor, a little away from the sun. Without a graphics card a corner costs more than a pixel.
const SHADOW_VERTEX = `
  ${FACING} out vec2 spot;
  void main() {
    if (!copy()) return;
    spot = position.xy;
    vec2 away = ${SHADOW_WIDE} * vec2(0.8, 1.0) * position.xy;
    vec3 place = facing() * vec3(away, 0.0) * stand.w + vec3(stand.xy + vec2(-0.06, 0.07), rise);
    gl_Position = projectionMatrix * (viewMatrix * vec4(place, 1.0));
  }`;
const SHADOW_FRAGMENT = `
  in vec2 spot; out vec4 painted;
  void main() {
    float r = length(spot);
    painted = vec4(0.05, 0.06, 0.08, ${SHADOW_DARK} * clamp(min(1.0 - 0.85 * r, 1.13 - 1.13 * r), 0.0, 1.0));
  }`;
const DARK_FRAGMENT = "in float vDark; out vec4 painted; void main() { painted = vec4(0.05, 0.06, 0.08, vDark); }";
const WALL_VERTEX = `
  uniform vec3 colour; out vec3 vColour;
  void main() {
    vColour = colour * (0.78 + 0.2 * abs(normal.y) + 0.2 * normal.z);
    gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0));
  }`;

const WALL_FRAGMENT = "uniform float opacity; in vec3 vColour; out vec4 painted; void main() { painted = vec4(vColour, opacity); }";
const FLAT_VERTEX = "void main() { gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0)); }";
const FLAT_FRAGMENT = "uniform vec4 painting; out vec4 painted; void main() { painted = painting; }";
const CONTACT_VERTEX = `
  in float dark; out float vDark;
  void main() {
    vDark = dark;
    gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0));
  }`;

const SQUARE = { attributes: [["position", new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3]],
  triangles: new Uint16Array([0, 1, 2, 0, 2, 3]) };

// What of a figure is the same for all its copies: see animation/bundle.py.
function meshOf({ vertices, triangles, ...more }) {
  const sizes = { normals: ["normal", 3], joints: ["joints", 2], weights: ["weight", 1], parts: ["part", 1] };
  const own = Object.entries(sizes).filter(([key]) => more[key]).map(([key, [name, size]]) => [name, more[key], size]);
  return { attributes: [["position", vertices, 3], ...own], triangles };
}

// Of a look the colours of its parts, and NOT_OWN for top and sleeves.
function wornParts(look) {
  return look.map((colour, part) => new THREE.Vector3(...(
    part === TOP || (part === FOREARM && colour === look[TOP]) ? NOT_OWN : channels(colour))));
}

// Troops by the names of their meshes: see animation/figures/levels.py.
class Troops {
  // looks: colours of each look, in the order of PARTS.
  constructor(meshes, looks, bones, scene) {
    const worn = { value: looks.flatMap(wornParts) };
    this.all = Object.entries(meshes).map(([name, mesh]) => {
      const own = mesh.joints ? { row: 1 } : { stand: 4, rise: 1 };
      const vertexShader = mesh.joints ? FIGURE_VERTEX(name.endsWith("_near"), looks.length) : RIGID_VERTEX(looks.length);
      const material = { vertexShader, fragmentShader: FRAGMENT, uniforms: mesh.joints ? { bones, looks: worn } : { looks: worn } };
      return [name, new Copies(meshOf(mesh), { colour: 3, look: 1, ...own }, material, scene)];
    });
    this.named = Object.fromEntries(this.all);
    this.shadows = new Copies(SQUARE, { stand: 4, rise: 1 }, { vertexShader: SHADOW_VERTEX, fragmentShader: SHADOW_FRAGMENT,
      transparent: true, depthWrite: false }, scene);
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
