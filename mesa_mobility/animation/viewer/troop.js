// People of one level of detail, drawn at once by the graphics card or what stands in for it.
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
  uniform sampler2D bones; uniform int first;
  in vec2 joints; in float weight; in vec3 colour; out vec3 vColour;
  vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  ${SHADE}
  void main() {
    int row = first + gl_InstanceID, a = 2 * int(joints.x);
    vec4 q = texelFetch(bones, ivec2(a, row), 0), p = texelFetch(bones, ivec2(a + 1, row), 0);
    vec3 place = turn(q, position) * p.w + p.xyz, facing = turn(q, normal);
    if (${fine} && weight < 0.999) {
      int b = 2 * int(joints.y);
      q = texelFetch(bones, ivec2(b, row), 0); p = texelFetch(bones, ivec2(b + 1, row), 0);
      place = mix(turn(q, position) * p.w + p.xyz, place, weight);
    }
    vColour = shaded(colour, facing);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }`;
const PAWN_VERTEX = `
  in vec4 stand; in vec3 colour; out vec3 vColour; ${SHADE}
  void main() {
    float c = cos(stand.z), s = sin(stand.z);
    mat3 turned = mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    vColour = shaded(colour, turned * normal);
    gl_Position = projectionMatrix * viewMatrix * vec4(turned * position * stand.w + vec3(stand.xy, 0.0), 1.0);
  }`;
const WALL_VERTEX = `
  uniform vec3 colour; out vec3 vColour;
  void main() {
    vColour = colour * (0.72 + 0.28 * abs(normal.y) + 0.12 * normal.z);
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

// People of one level of detail, drawn at once.
class Troop {
  constructor(mesh, vertex, uniforms, scene, extra) {
    this.geometry = new THREE.InstancedBufferGeometry();
    const set = (name, values, size) => this.geometry.setAttribute(name, new THREE.BufferAttribute(values, size));
    set("position", mesh.vertices, 3);
    set("normal", mesh.normals, 3);
    if (mesh.joints) {
      set("joints", mesh.joints, 2);
      set("weight", mesh.weights, 1);
    }
    this.geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    const material = new THREE.ShaderMaterial({ vertexShader: vertex, fragmentShader: FRAGMENT, uniforms,
      glslVersion: THREE.GLSL3 });
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
    this.uniforms = uniforms;
    this.sizes = { colour: 3, ...extra };
    this.room = 0;
    this.count = 0;
    scene.add(this.mesh);
  }

  reserve(count) {
    this.count = 0;
    if (count <= this.room) return;
    this.room = 2 * count;
    for (const [name, size] of Object.entries(this.sizes)) {
      const values = new THREE.InstancedBufferAttribute(new Float32Array(this.room * size), size);
      values.setUsage(THREE.DynamicDrawUsage);
      this.geometry.setAttribute(name, values);
    }
  }

  add(values) {
    for (const [name, each] of Object.entries(values)) {
      this.geometry.attributes[name].array.set(each, this.count * this.sizes[name]);
    }
    this.count += 1;
  }

  finish(first = 0) {
    this.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    if (this.uniforms.first) this.uniforms.first.value = first;
    for (const [name, size] of Object.entries(this.sizes)) {
      const each = this.geometry.attributes[name];
      if (!each) continue;
      each.clearUpdateRanges();
      each.addUpdateRange(0, this.count * size);
      each.needsUpdate = true;
    }
  }
}
