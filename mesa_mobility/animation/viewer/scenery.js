// Floors, walls, openings and stairs of a plan or of a building, as meshes.
"use strict";

const WALL_HEIGHT = 1.2, STRIPE = 0.12, OVER_FLOOR = 0.01; // metres; half the width of an opening's stripe
const CUT_ROUNDED = 0.005; // metres: people's elevations are rounded
const SEE_THROUGH = 0.4; // opacity of floors with others below them
const MARKING = 0.005; // metres: height of refuges above the floor
const STEPS = "#c9b79c", REFUGE = "#7fc9a0", OPENINGS = { exit: "#00795a", door: "#0072b2", closed: "#b23c00" };
const channels = (colour) => (colour[0] === "#" ? [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))
  : colour.match(/\d+/g).map(Number)).map((each) => each / 255);

class Scenery {
  constructor(scene) {
    this.scene = scene;
    this.fixed = [];
    this.walls = [];
    this.below = Infinity;
    this.top = 0;
  }

  clear() {
    for (const { mesh } of this.fixed) {
      this.scene.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.dispose();
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
    for (const { bottom, vertices, normals, triangles: index } of floor.stairs || []) {
      this.put(triangles(vertices, index, normals), shaded(STEPS), bottom);
    }
    this.cut(this.below);
  }

  storey({ free, walls, openings, refuges, elevation }, colours, through) {
    const points = (ring, path) => path.setFromPoints(ring.map(([x, y]) => new THREE.Vector3(x, y, 0)));
    const shape = ([outer, ...holes]) => {
      const found = points(outer, new THREE.Shape());
      found.holes = holes.map((each) => points(each, new THREE.Path()));
      return found;
    };
    const look = through ? { transparent: true, opacity: SEE_THROUGH, depthWrite: false, side: THREE.DoubleSide } : {};
    this.put(new THREE.ShapeGeometry(free.map(shape)).translate(0, 0, elevation),
      new THREE.MeshBasicMaterial({ color: colours.free, ...look }), elevation);
    for (const refuge of refuges || []) {
      this.put(new THREE.ShapeGeometry(shape(refuge.rings)).translate(0, 0, elevation + MARKING),
        new THREE.MeshBasicMaterial({ color: REFUGE, side: THREE.DoubleSide }), elevation);
    }
    for (const { a, b, kind, open } of openings || []) {
      const long = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const across = [(-STRIPE * (b[1] - a[1])) / long, (STRIPE * (b[0] - a[0])) / long];
      const corners = [[a, 1], [b, 1], [b, -1], [a, -1]].flatMap(([p, s]) => [p[0] + s * across[0], p[1] + s * across[1],
        elevation + OVER_FLOOR]);
      this.put(triangles(corners, [0, 1, 2, 0, 2, 3]), new THREE.MeshBasicMaterial({
        color: open === false ? OPENINGS.closed : OPENINGS[kind] || OPENINGS.door, side: THREE.DoubleSide }), elevation);
    }
    this.put(wallGeometry(walls, elevation), shaded(colours.wall), elevation);
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

function shaded(colour) {
  return new THREE.ShaderMaterial({ vertexShader: WALL_VERTEX, fragmentShader: FRAGMENT, glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide, uniforms: { colour: { value: channels(colour) } } });
}

function triangles(corners, index, normals) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
  if (normals) geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(normals), 3));
  geometry.setIndex(index);
  return geometry;
}

// Walls are lines on the plan, which stand up here.
function wallGeometry(walls, base) {
  const corners = [], normals = [], index = [], top = base + WALL_HEIGHT;
  walls.forEach(([x0, y0, x1, y1], k) => {
    const long = Math.hypot(x1 - x0, y1 - y0) || 1, normal = [(y0 - y1) / long, (x1 - x0) / long, 0];
    corners.push(x0, y0, base, x1, y1, base, x1, y1, top, x0, y0, top);
    for (let i = 0; i < 4; i += 1) normals.push(...normal);
    index.push(...[0, 1, 2, 0, 2, 3].map((i) => 4 * k + i));
  });
  return triangles(corners, index, normals);
}
