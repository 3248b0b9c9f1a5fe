// Floors, walls, openings, stairs and lifts of a plan or of a building, as meshes.
"use strict";

const WALL_HEIGHT = 1.2, STRIPE = 0.12, OVER_FLOOR = 0.01; // metres; half the width of an opening's stripe
const CUT_ROUNDED = 0.005; // metres: people's elevations are rounded
const SEE_THROUGH = 0.4, GLASS = 0.25; // opacity of floors with others below them
const MARKING = 0.005; // metres: height of refuges above the floor
const CONTACT = 0.35, CONTACT_DARK = 0.16; // metres and opacity of the shade along walls
const SOLIDS = { wall: ["#c3c4c2", "#5d6066"], seat: ["#7d5a55", "#8d6a64"] }; // sides and tops
const UNDER_PEOPLE = 0.008; // metres: height of a map above the floor
const LAYER_VERTEX = `
  uniform vec4 place; out vec2 spot;
  void main() {
    spot = (position.xy - place.xy) / place.zw;
    gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0));
  }`;
const LAYER_FRAGMENT = "uniform sampler2D cells; in vec2 spot; out vec4 painted; void main() { painted = texture(cells, spot); }";
const REFUGE = "#7fc9a0", OPENINGS = { exit: "#00795a", door: "#0072b2", closed: "#b23c00" };
const channels = (colour) => (colour[0] === "#" ? [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))
  : colour.match(/\d+/g).map(Number)).map((each) => each / 255);

class Scenery {
  constructor(scene) {
    this.scene = scene;
    this.fixed = [];
    this.walls = [];
    this.below = Infinity;
    this.top = 0;
    this.glassy = false;
    this.layer = null;
    this.contact = new THREE.ShaderMaterial({ vertexShader: CONTACT_VERTEX, fragmentShader: DARK_FRAGMENT, glslVersion: THREE.GLSL3,
      transparent: true, depthWrite: false, side: THREE.DoubleSide });
  }

  clear() {
    for (const { mesh } of this.fixed) {
      this.scene.remove(mesh);
      mesh.geometry.dispose();
      if (mesh.material !== this.contact) mesh.material.dispose();
    }
    this.fixed = [];
  }

  // floor: what `floor.py` or `storeys.py` makes; colours: {ground, free, wall} as "#rrggbb".
  set(floor, colours) {
    this.clear();
    const storeys = floor.storeys || [{ ...floor, elevation: 0 }];
    this.top = Math.max(...storeys.map(({ elevation }) => elevation));
    // Each wall with the elevation of its lower edge.
    this.walls = storeys.flatMap(({ walls, elevation }) => walls.map((wall) => [...wall, elevation]));
    storeys.forEach((storey, k) => this.storey(storey, colours, k > 0));
    for (const { bottom, colour, opacity, vertices, normals, triangles: index } of floor.fittings || []) {
      this.put(triangles(vertices, index, { normal: [normals, 3] }), shaded(colour, { opacity }), bottom);
    }
    this.cut(this.below);
  }

  storey({ free, walls, solids, openings, refuges, elevation }, colours, through) {
    this.put(new THREE.ShapeGeometry(free.map(shape)).translate(0, 0, elevation), flat(colours.free, through ? SEE_THROUGH : 1),
      elevation);
    for (const refuge of refuges || []) {
      this.put(new THREE.ShapeGeometry(shape(refuge.rings)).translate(0, 0, elevation + MARKING), flat(REFUGE), elevation);
    }
    for (const { a, b, kind, open } of openings || []) {
      const long = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const across = [(-STRIPE * (b[1] - a[1])) / long, (STRIPE * (b[0] - a[0])) / long];
      const corners = [[a, 1], [b, 1], [b, -1], [a, -1]].flatMap(([p, s]) => [p[0] + s * across[0], p[1] + s * across[1],
        elevation + OVER_FLOOR]);
      this.put(triangles(corners, [0, 1, 2, 0, 2, 3]), flat(open === false ? OPENINGS.closed : OPENINGS[kind] || OPENINGS.door),
        elevation);
    }
    this.put(contactGeometry(walls, elevation + OVER_FLOOR / 2), this.contact, elevation);
    for (const [kind, [side, top]] of Object.entries(SOLIDS)) {
      const own = solids.filter((each) => each.kind === kind);
      if (!own.length) continue;
      this.put(sideGeometry(own, elevation), this.see(shaded(side, { through: kind === "wall" }), kind), elevation);
      for (const height of new Set(own.map((each) => each.top))) {
        const level = own.filter((each) => each.top === height).map(({ rings }) => shape(rings));
        this.put(new THREE.ShapeGeometry(level).translate(0, 0, elevation + height), flat(top), elevation);
      }
    }
  }

  // A map on the floor of a storey, or none: {pixels, grid}, see plan/layer.js.
  setLayer(layer, { free, elevation = 0 } = {}) {
    if (this.layer && layer && this.layer.userData.grid === layer.grid) {
      const { value } = this.layer.material.uniforms.cells;
      value.image.data.set(layer.pixels);
      value.needsUpdate = true;
      return;
    }
    if (this.layer) {
      this.scene.remove(this.layer);
      this.layer.geometry.dispose();
      this.layer.material.uniforms.cells.value.dispose();
      this.layer.material.dispose();
    }
    this.layer = null;
    if (!layer) return;
    const { grid: { columns, rows, x0, y0 }, pixels } = layer, cells = new THREE.DataTexture(pixels.slice(), columns, rows);
    cells.needsUpdate = true;
    const material = new THREE.ShaderMaterial({ vertexShader: LAYER_VERTEX, fragmentShader: LAYER_FRAGMENT, glslVersion: THREE.GLSL3,
      transparent: true, depthWrite: false, uniforms: { cells: { value: cells },
        place: { value: [x0, y0, columns * CELL, rows * CELL] } } });
    this.layer = new THREE.Mesh(new THREE.ShapeGeometry(free.map(shape)).translate(0, 0, elevation + UNDER_PEOPLE), material);
    this.layer.userData.grid = layer.grid;
    this.scene.add(this.layer);
    this.layer.updateMatrixWorld();
  }

  // Walls may be seen through.
  see(material, kind) {
    if (kind === "wall") {
      material.uniforms.opacity.value = this.glassy ? GLASS : 1;
      material.transparent = this.glassy;
      material.depthWrite = !this.glassy;
    }
    material.userData.kind = kind;
    return material;
  }

  setGlassy(on) {
    this.glassy = on;
    for (const { mesh } of this.fixed) if (mesh.material.userData.kind) this.see(mesh.material, mesh.material.userData.kind);
  }

  put(geometry, material, base) {
    const mesh = new THREE.Mesh(geometry, material);
    this.fixed.push({ mesh, base });
    this.scene.add(mesh);
    mesh.updateMatrixWorld();
  }

  // Only what stands below an elevation is shown.
  cut(below) {
    this.below = below;
    for (const { mesh, base } of this.fixed) mesh.visible = base < below;
  }

  // The walls of the storey on which somebody at this elevation is.
  wallsAt(z) {
    const own = Math.max(...this.walls.map((wall) => wall[4]).filter((base) => base <= z + OVER_FLOOR));
    return this.walls.filter((wall) => wall[4] === own);
  }
}

// Each storey but the topmost, from above, and the elevation of the next one, which cuts it off.
function storeyCuts(storeys) {
  return storeys.map(({ name, elevation }) => ({ name, next: storeys.find((each) => each.elevation > elevation) }))
    .filter(({ next }) => next).map(({ name, next }) => ({ name, below: next.elevation })).reverse();
}

function points(ring, path) { return path.setFromPoints(ring.map(([x, y]) => new THREE.Vector3(x, y, 0))); }

// Of rings, the outer one first.
function shape([outer, ...holes]) {
  const found = points(outer, new THREE.Shape());
  found.holes = holes.map((each) => points(each, new THREE.Path()));
  return found;
}

// One colour from all sides: see SHADE in troop.js on the price of a pixel.
function flat(colour, opacity = 1) {
  return new THREE.ShaderMaterial({ vertexShader: FLAT_VERTEX, fragmentShader: FLAT_FRAGMENT, glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide, transparent: opacity < 1, depthWrite: opacity === 1,
    uniforms: { painting: { value: [...channels(colour), opacity] } } });
}

// Seats are seen from outside only.
function shaded(colour, { through = true, opacity = 1 } = {}) {
  return new THREE.ShaderMaterial({ vertexShader: WALL_VERTEX, fragmentShader: WALL_FRAGMENT, glslVersion: THREE.GLSL3,
    ...(through && { side: THREE.DoubleSide }), transparent: opacity < 1, depthWrite: opacity === 1,
    uniforms: { colour: { value: channels(colour) }, opacity: { value: opacity } } });
}

function triangles(corners, index, more = {}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
  for (const [name, [values, size]] of Object.entries(more)) {
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(values), size));
  }
  geometry.setIndex(index);
  return geometry;
}

// The sides of solids: {rings, top}, metres above the floor.
function sideGeometry(solids, base) {
  const corners = [], normals = [], index = [];
  for (const { rings, top } of solids) {
    for (const ring of rings) {
      for (let k = 1; k < ring.length; k += 1) {
        const [x0, y0] = ring[k - 1], [x1, y1] = ring[k], long = Math.hypot(x1 - x0, y1 - y0) || 1, from = corners.length / 3;
        corners.push(x0, y0, base, x1, y1, base, x1, y1, base + top, x0, y0, base + top);
        for (let i = 0; i < 4; i += 1) normals.push((y1 - y0) / long, (x0 - x1) / long, 0);
        index.push(from, from + 1, from + 2, from, from + 2, from + 3);
      }
    }
  }
  return triangles(corners, index, { normal: [normals, 3] });
}

// Floors are darker along walls: strips on both sides, which fade.
function contactGeometry(walls, height) {
  const corners = [], darks = [], index = [];
  for (const [x0, y0, x1, y1] of walls) {
    const long = Math.hypot(x1 - x0, y1 - y0) || 1;
    for (const side of [CONTACT, -CONTACT]) {
      const dx = (side * (y0 - y1)) / long, dy = (side * (x1 - x0)) / long, from = corners.length / 3;
      corners.push(x0, y0, height, x1, y1, height, x1 + dx, y1 + dy, height, x0 + dx, y0 + dy, height);
      darks.push(CONTACT_DARK, CONTACT_DARK, 0, 0);
      index.push(from, from + 1, from + 2, from, from + 2, from + 3);
    }
  }
  return triangles(corners, index, { dark: [darks, 1] });
}
