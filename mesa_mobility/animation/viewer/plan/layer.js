// Maps of a floor: the density of people and how many have passed, as mesa_mobility/results/engineering/maps.py
// defines them.

const CELL = 0.5, MOST_SUBCELLS = 80000; // metres: side of a cell of the maps; parts into which all cells are divided
const DENSEST = 5, SEEN_FROM = 1.2; // persons/m2: of the brightest colour, and from where on a layer hides the floor
const SERVICE_SHADES = [[0, 0.1], [0.2, 0.4], [0.4, 0.6], [0.6, 0.75], [0.78, 0.85], [1, 0.9]]; // colour and opacity of A to F

// Cells of a floor and the finer ones that stand for places on it.
class FloorGrid {
  // free: for each polygon of the floor its rings, metres.
  constructor(free) {
    const xs = free.flat(2).map(([x]) => x), ys = free.flat(2).map(([, y]) => y);
    const least = (values) => values.reduce((a, b) => Math.min(a, b)), most = (values) => values.reduce((a, b) => Math.max(a, b));
    Object.assign(this, { x0: least(xs), y0: least(ys) });
    this.columns = Math.max(1, Math.ceil((most(xs) - this.x0) / CELL - 1e-9));
    this.rows = Math.max(1, Math.ceil((most(ys) - this.y0) / CELL - 1e-9));
    this.parts = 5;
    while (this.parts > 1 && this.columns * this.rows * this.parts ** 2 > MOST_SUBCELLS) this.parts -= 1;
    this.step = CELL / this.parts;
    this.wide = this.columns * this.parts;
    this.high = this.rows * this.parts;
    this.floor = this.onFloor(free);
    this.owners = new Int32Array(this.wide * this.high);
    this.cells = new Float32Array(this.columns * this.rows);
    this.shares = this.floorOfCells();
  }

  onFloor(free) {
    const canvas = new OffscreenCanvas(this.wide, this.high), ctx = canvas.getContext("2d", { willReadFrequently: true });
    for (const rings of free) {
      ctx.beginPath();
      for (const ring of rings) {
        ring.forEach(([x, y], k) => ctx[k ? "lineTo" : "moveTo"]((x - this.x0) / this.step, (y - this.y0) / this.step));
        ctx.closePath();
      }
      ctx.fill("evenodd");
    }
    const { data } = ctx.getImageData(0, 0, this.wide, this.high);
    return Uint8Array.from({ length: this.wide * this.high }, (_, k) => (data[4 * k + 3] > 127 ? 1 : 0));
  }

  cellOf(k) {
    const x = k % this.wide;
    return Math.floor((k - x) / this.wide / this.parts) * this.columns + Math.floor(x / this.parts);
  }

  floorOfCells() {
    const found = new Int32Array(this.columns * this.rows);
    this.floor.forEach((on, k) => { if (on) found[this.cellOf(k)] += 1; });
    return found;
  }

  cellAt(x, y) {
    const column = Math.floor((x - this.x0) / CELL), row = Math.floor((y - this.y0) / CELL);
    return column >= 0 && column < this.columns && row >= 0 && row < this.rows ? row * this.columns + column : -1;
  }

  // Voronoi densities of the cells, persons/m2, NaN without floor: the mean of 1 / A over a cell, with the area A of the
  // part of the floor that is nearest to each person. places: x, y, x, y, ...
  densities(places) {
    const { owners, floor, wide, high, cells, shares, step } = this, count = places.length / 2;
    const people = new Float32Array(count), seeds = [];
    owners.fill(-1);
    for (let p = 0; p < count; p += 1) {
      const i = Math.floor((places[2 * p] - this.x0) / step), j = Math.floor((places[2 * p + 1] - this.y0) / step);
      if (i < 0 || j < 0 || i >= wide || j >= high || !floor[j * wide + i]) continue;
      const k = j * wide + i;
      if (owners[k] < 0) {
        owners[k] = p;
        seeds.push(k);
      }
      people[owners[k]] += 1; // those in one part of a cell share what is theirs
    }
    this.spread(places);
    const own = this.connected(seeds), areas = new Float32Array(count);
    for (let k = 0; k < own.length; k += 1) if (own[k]) areas[owners[k]] += step * step;
    cells.fill(0);
    for (let k = 0; k < own.length; k += 1) if (own[k]) cells[this.cellOf(k)] += people[owners[k]] / areas[owners[k]];
    for (let k = 0; k < cells.length; k += 1) cells[k] /= shares[k];
    return cells;
  }

  // The nearest person of each place, by neighbours of neighbours (Danielsson 1980, Computer Graphics and Image
  // Processing 14: 227).
  spread(places) {
    const { owners, wide, high, step, x0, y0 } = this, away = new Float32Array(wide * high).fill(Infinity);
    const distance = (p, x, y) => (places[2 * p] - x) ** 2 + (places[2 * p + 1] - y) ** 2;
    for (let k = 0; k < owners.length; k += 1) if (owners[k] >= 0) away[k] = 0;
    const look = (k, other, x, y) => {
      const p = owners[other];
      if (p < 0 || p === owners[k]) return;
      const d = distance(p, x, y);
      if (d < away[k]) {
        away[k] = d;
        owners[k] = p;
      }
    };
    for (const down of [1, -1]) {
      for (let j = down > 0 ? 0 : high - 1; j >= 0 && j < high; j += down) {
        const before = j - down >= 0 && j - down < high ? -down * wide : 0, y = y0 + (j + 0.5) * step;
        for (const right of [down, -down]) {
          for (let i = right > 0 ? 0 : wide - 1; i >= 0 && i < wide; i += right) {
            const k = j * wide + i, x = x0 + (i + 0.5) * step;
            if (i - right >= 0 && i - right < wide) {
              look(k, k - right, x, y);
              if (before) look(k, k - right + before, x, y);
            }
            if (!before) continue;
            look(k, k + before, x, y);
            if (i + right >= 0 && i + right < wide) look(k, k + right + before, x, y);
          }
        }
      }
    }
  }

  // Of what is nearest to somebody, what walls do not cut off from them.
  connected(seeds) {
    const { owners, floor, wide, high } = this, found = new Uint8Array(owners.length), open = [...seeds];
    for (const k of open) found[k] = 1;
    while (open.length) {
      const k = open.pop(), i = k % wide;
      const next = [i > 0 ? k - 1 : -1, i < wide - 1 ? k + 1 : -1, k - wide, k + wide < wide * high ? k + wide : -1];
      for (const n of next) {
        if (n < 0 || found[n] || !floor[n] || owners[n] !== owners[k]) continue;
        found[n] = 1;
        open.push(n);
      }
    }
    return found;
  }
}

// How many people have been in each cell until a time.
class Usage {
  // visits: [frame, cell] of the first time that each person is in a cell, in any order.
  constructor(visits, count) {
    this.visits = visits.sort((a, b) => a[0] - b[0]);
    this.people = new Float32Array(count);
    this.at = 0;
  }

  until(frame) {
    if (this.at && this.visits[this.at - 1][0] > frame) {
      this.at = 0;
      this.people.fill(0);
    }
    while (this.at < this.visits.length && this.visits[this.at][0] <= frame) {
      this.people[this.visits[this.at][1]] += 1;
      this.at += 1;
    }
    return this.people;
  }
}

function heat(share) {
  const text = blend(HEAT, share).match(/\d+/g);
  return text.map(Number);
}

// Kinds of layers: the colour and opacity of a value, and the legend.
const LAYERS = {
  density: { label: "density, persons/m²", paint: (value) => [heat(value / DENSEST), Math.min(0.85, (0.85 * value) / SEEN_FROM)],
    legend: () => ({ label: "density, persons/m²", low: 0, high: DENSEST, names: [] }) },
  service: { label: "level of service (Fruin, walkways)",
    paint: (value, limits) => {
      const level = limits.findIndex((limit) => value <= limit), [share, opacity] = SERVICE_SHADES[level < 0 ? 5 : level];
      return [heat(share), opacity];
    },
    legend: (limits) => ({ label: "level of service, up to persons/m²", steps: SERVICE_SHADES.map(([share, opacity], k) => ({
      name: "ABCDEF"[k], colour: `rgba(${heat(share).join(",")},${Math.max(opacity, 0.25)})`,
      text: k < 5 ? limits[k].toFixed(2) : "more" })) }) },
  usage: { label: "people who have been here", paint: (value, _, most) => [heat(value / most), value ? 0.25 + 0.6 * (value / most) : 0],
    legend: (_, most) => ({ label: "people who have been here", low: 0, high: most, names: [] }) },
};

// Red, green, blue and opacity of each cell, the first row that of the least y.
function paintedCells(kind, values, limits, most) {
  const pixels = new Uint8Array(4 * values.length), { paint } = LAYERS[kind];
  for (let k = 0; k < values.length; k += 1) {
    if (!(values[k] > 0)) continue;
    const [[r, g, b], opacity] = paint(values[k], limits, most);
    pixels.set([r, g, b, Math.round(255 * opacity)], 4 * k);
  }
  return pixels;
}

// Cells on a plan; `place` turns metres into pixels, of which a metre has `scale`.
function paintCells(ctx, { pixels, grid }, place, scale) {
  const { columns, rows, x0, y0 } = grid, cells = new OffscreenCanvas(columns, rows), [x, y] = place(x0, y0);
  drawnByProcessor(cells).putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), columns, rows), 0, 0);
  ctx.save();
  ctx.translate(x, y);
  ctx.scale(1, -1); // the first row is the lowest one
  ctx.imageSmoothingEnabled = false;
  ctx.drawImage(cells, 0, 0, columns * CELL * scale, rows * CELL * scale);
  ctx.restore();
}
