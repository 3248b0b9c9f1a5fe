// Copies of one mesh in one drawing. SwiftShader, which stands in for a graphics card in Chromium, draws instances one by
// one: each instance is of many copies.
"use strict";

const TOGETHER = 4096; // triangles of an instance
const ABREAST = 32; // copies beside each other in a texture

// What is not the same for all copies, by name: its length. All of a copy lies in texels one after another.
class Fields {
  constructor(sizes) {
    this.sizes = sizes;
    this.places = {};
    this.length = 0;
    for (const [name, size] of Object.entries(sizes)) {
      this.places[name] = this.length;
      this.length += size;
    }
    this.texels = Math.ceil(this.length / 4);
  }

  // GLSL: copy() reads what is a copy's own, and is false where an instance has no more copies.
  reading(vertices, together) {
    const kinds = { 1: "float", 3: "vec3", 4: "vec4" }, names = Object.keys(this.sizes);
    const parts = (name) => Array.from({ length: this.sizes[name] }, (_, k) => this.places[name] + k)
      .map((k) => `t${k >> 2}.${"xyzw"[k & 3]}`).join(", ");
    const texel = (_, k) => `vec4 t${k} = texelFetch(copies, ivec2(x + ${k}, y), 0);`;
    return `
      uniform sampler2D copies; uniform int count;
      ${names.map((name) => `${kinds[this.sizes[name]]} ${name};`).join(" ")}
      bool copy() {
        int own = gl_InstanceID * ${together} + gl_VertexID / ${vertices};
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        if (own >= count) return false;
        int x = ${this.texels} * (own % ${ABREAST}), y = own / ${ABREAST};
        ${Array.from({ length: this.texels }, texel).join(" ")}
        ${names.map((name) => `${name} = ${kinds[this.sizes[name]]}(${parts(name)});`).join(" ")}
        return true;
      }`;
  }
}

class Copies {
  // attributes: [name, values of all corners, values of a corner]; the first are positions.
  constructor(mesh, sizes, material, scene) {
    Object.assign(this, { source: mesh, fields: new Fields(sizes), material, scene, mesh: null, room: 0, count: 0 });
    this.own = { copies: { value: null }, count: { value: 0 } };
  }

  // What is a copy's own, by name.
  add(values) {
    if (!this.mesh) this.open();
    if (this.count === this.room) {
      this.room = 2 * this.room || ABREAST;
      this.own.copies.value = sheet(this.fields.texels, this.room, this.own.copies.value);
    }
    const { sizes, places, texels } = this.fields, { data } = this.own.copies.value.image, from = 4 * texels * this.count;
    for (const name of Object.keys(sizes)) {
      if (sizes[name] === 1) data[from + places[name]] = values[name];
      else data.set(values[name], from + places[name]);
    }
    this.count += 1;
  }

  // Meshes that nobody needs take no time.
  open() {
    const { attributes, triangles } = this.source, { vertexShader, uniforms, ...more } = this.material;
    const vertices = attributes[0][1].length / attributes[0][2], corners = triangles.length;
    this.together = Math.max(1, Math.min(Math.ceil((3 * TOGETHER) / corners), Math.floor(65536 / vertices)));
    this.geometry = new THREE.InstancedBufferGeometry();
    for (const [name, values, size] of attributes) {
      const all = new values.constructor(values.length * this.together);
      for (let k = 0; k < this.together; k += 1) all.set(values, k * values.length);
      this.geometry.setAttribute(name, new THREE.BufferAttribute(all, size));
    }
    const index = new Uint16Array(corners * this.together);
    for (let k = 0; k < index.length; k += 1) index[k] = triangles[k % corners] + vertices * Math.floor(k / corners);
    this.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.mesh = new THREE.Mesh(this.geometry, new THREE.ShaderMaterial({ ...more, glslVersion: THREE.GLSL3,
      vertexShader: this.fields.reading(vertices, this.together) + vertexShader, uniforms: { ...uniforms, ...this.own } }));
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  finish() {
    if (!this.mesh) return;
    this.mesh.visible = this.count > 0;
    if (!this.count) return;
    this.geometry.instanceCount = Math.ceil(this.count / this.together);
    this.own.count.value = this.count;
    this.own.copies.value.needsUpdate = true;
  }
}

// A texture of so many texels for each of at least so many copies, with what was in another one.
function sheet(texels, count, before = null) {
  const rows = Math.ceil(count / ABREAST), data = new Float32Array(4 * texels * ABREAST * rows);
  if (before) {
    data.set(before.image.data);
    before.dispose();
  }
  return new THREE.DataTexture(data, texels * ABREAST, rows, THREE.RGBAFormat, THREE.FloatType);
}
