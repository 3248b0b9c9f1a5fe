// A map of the floor under the people: a part of the crowd's view; see plan/layer.js.

const MAP_EVERY = 0.5; // simulated seconds between two maps

const MAPPED = {
  data() {
    return { mapKind: "" };
  },
  created() {
    this.grid = this.map = this.usage = null;
  },
  methods: {
    chooseMap(kind) {
      this.mapKind = kind;
      this.map = null;
      this.dirty = true;
    },
    // Whether another map is due at a time; it is drawn with the floor.
    mapDue(now) {
      if (!this.mapKind) return false;
      const key = [this.mapKind, now.run, Math.floor(now.elapsed / MAP_EVERY)].join(" ");
      if (this.map && this.map.key === key) return false;
      const grid = this.gridNow(), usage = this.mapKind === "usage", values = usage ? this.usageAt(now) : grid.densities(this.placesOf(now));
      const most = usage ? Math.max(1, values.reduce((a, b) => Math.max(a, b))) : DENSEST;
      this.map = { key, grid, most, pixels: paintedCells(this.mapKind, values, this.service, most) };
      return true;
    },
    gridNow() {
      const key = JSON.stringify(this.floor.free);
      if (this.gridKey !== key) this.grid = new FloorGrid(this.floor.free);
      this.gridKey = key;
      return this.grid;
    },
    placesOf({ people }) {
      const found = new Float32Array((2 * people.length) / FIELDS);
      for (let k = 0, i = 0; k < people.length; k += FIELDS, i += 2) found.set([people[k + 1], people[k + 2]], i);
      return found;
    },
    // How many people have been in each cell, from what has been shown.
    usageAt({ elapsed }) {
      const { past, grid } = this, size = grid.cells.length;
      if (!this.usage || this.usage.past !== past || this.usage.grid !== grid || this.usage.until > elapsed) {
        this.usage = { past, grid, until: -1, seen: new Set(), people: new Float32Array(size) };
      }
      const { usage } = this, last = past.until(elapsed);
      for (let n = usage.until < 0 ? 0 : past.until(usage.until) + 1; n <= last; n += 1) {
        const { people } = past.pictures[n];
        for (let k = 0; k < people.length; k += FIELDS) {
          const cell = grid.cellAt(people[k + 1], people[k + 2]), key = people[k] * size + cell;
          if (cell < 0 || usage.seen.has(key)) continue;
          usage.seen.add(key);
          usage.people[cell] += 1;
        }
      }
      usage.until = past.pictures.length ? past.pictures[last].elapsed : -1;
      return usage.people;
    },
    paintMap(ctx) { paintCells(ctx, this.map, (x, y) => this.place(x, y), this.view.scale); },
    paintMapLegend(ctx, right, bottom, r) {
      if (!this.map) return;
      const legend = LAYERS[this.mapKind].legend(this.service, this.map.most);
      if (!legend.steps) {
        this.paintLegend(ctx, legend, right, bottom, r);
        return;
      }
      const wide = 46 * r, left = right - 6 * wide;
      plate(ctx, left - 5 * r, bottom - 42 * r, 6 * wide + 10 * r, 47 * r, this.colours);
      ctx.textAlign = "left";
      ctx.fillText(legend.label, left, bottom - 28 * r);
      legend.steps.forEach(({ name, colour, text }, k) => {
        ctx.fillStyle = colour;
        ctx.fillRect(left + k * wide, bottom - 22 * r, wide, 8 * r);
        ctx.fillStyle = this.colours.text;
        ctx.fillText(`${name} ${text}`, left + k * wide, bottom);
      });
    },
  },
};
