// The movement options of one pedestrian on a canvas: a part of the view of a decision.

const SAMPLES = 16; // points of a path: see decision.py

const OPTIONS = {
  created() {
    this.base = document.createElement("canvas");
  },
  methods: {
    resize() {
      const side = Math.round(this.$refs.box.clientWidth * pixelRatio());
      if (side < 2) return; // nothing is shown
      this.ratio = pixelRatio();
      if (resizeTo([this.$refs.canvas, this.base], side, side)) this.paint();
    },
    place(x, y) {
      const half = this.base.width / 2, [x0, y0] = this.decision.position;
      return [half + (x - x0) * this.scale, half - (y - y0) * this.scale];
    },
    onPage(x, y) {
      const box = this.$refs.canvas.getBoundingClientRect(), [px, py] = this.place(x, y);
      return [box.left + px / this.ratio, box.top + py / this.ratio];
    },
    trace(ctx, k) {
      const paths = this.o.paths, first = 2 * SAMPLES * k;
      ctx.beginPath();
      for (let s = 0; s < this.o.knots[k]; s += 1) {
        const p = this.place(paths[first + 2 * s], paths[first + 2 * s + 1]);
        if (s) ctx.lineTo(...p); else ctx.moveTo(...p);
      }
    },
    dot(ctx, k, radius) {
      ctx.beginPath();
      ctx.arc(...this.place(this.o.ends[2 * k], this.o.ends[2 * k + 1]), radius, 0, 2 * Math.PI);
      ctx.fill();
    },
    paint() {
      const d = this.decision, side = this.base.width;
      if (!this.o || side < 2 || !this.ratio) return;
      const o = this.o, r = this.ratio, colours = this.colours, ctx = this.base.getContext("2d");
      let reach = 0.6;
      for (let k = 0; k < o.paths.length; k += 2) {
        reach = Math.max(reach, Math.hypot(o.paths[k] - d.position[0], o.paths[k + 1] - d.position[1]));
      }
      this.scale = side / (2 * reach + 0.5);
      ctx.fillStyle = this.colours.free;
      ctx.fillRect(0, 0, side, side);
      this.paintFloor(ctx, r);
      const order = Array.from({ length: d.options }, (_, k) => k)
        .sort((a, b) => o.totals[b] - o.totals[a]);
      const free = order.filter((k) => o.verdicts[k] === 0);
      // A few very dear ones would make all others look alike: a tenth share the last colour, and all infinite ones.
      const finite = free.filter((k) => Number.isFinite(o.totals[k]));
      this.dearest = finite.length ? o.totals[finite[Math.floor(finite.length / 10)]] : 1;
      this.cheapest = finite.length ? o.totals[finite[finite.length - 1]] : 0;
      if (this.rejected) {
        ctx.lineWidth = 0.7 * r;
        for (const k of order) {
          if (o.verdicts[k] === 0) continue;
          ctx.strokeStyle = ctx.fillStyle = o.verdicts[k] === 1 ? colours.hitsWall : colours.hitsPerson;
          ctx.globalAlpha = 0.3;
          this.trace(ctx, k);
          ctx.stroke();
          this.dot(ctx, k, 1.5 * r);
        }
        ctx.globalAlpha = 1;
      }
      for (const k of free) {
        ctx.strokeStyle = ctx.fillStyle = this.colour(k);
        ctx.lineWidth = r;
        ctx.globalAlpha = 0.75;
        this.trace(ctx, k);
        ctx.stroke();
        ctx.globalAlpha = 1;
        this.dot(ctx, k, 2.2 * r);
      }
      this.paintPeople(ctx, r);
      if (d.chosen >= 0) {
        ctx.strokeStyle = ctx.fillStyle = colours.chosen;
        ctx.lineWidth = 3 * r;
        this.trace(ctx, d.chosen);
        ctx.stroke();
        this.dot(ctx, d.chosen, 4.5 * r);
      }
      this.paintBlocker(ctx, r);
      if (!d.lost) this.paintTarget(ctx, r);
      this.paintKey(ctx, r, side);
      this.refresh();
    },
    colour(k) {
      return blend(this.colours.scale, (this.o.totals[k] - this.cheapest) / (this.dearest - this.cheapest || 1));
    },
    paintFloor(ctx, r) {
      const floor = this.floor;
      if (!floor || !floor.walls) return;
      ctx.strokeStyle = this.colours.wall;
      ctx.lineWidth = 2 * r;
      ctx.beginPath();
      for (const w of floor.walls) {
        ctx.moveTo(...this.place(w[0], w[1]));
        ctx.lineTo(...this.place(w[2], w[3]));
      }
      ctx.stroke();
      for (const opening of floor.openings) {
        if (!opening.open) continue;
        ctx.strokeStyle = openingColour(opening, this.colours);
        ctx.beginPath();
        ctx.moveTo(...this.place(...opening.a));
        ctx.lineTo(...this.place(...opening.b));
        ctx.stroke();
      }
    },
    paintPeople(ctx, r) {
      const d = this.decision;
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      ctx.font = `${10 * r}px sans-serif`;
      // Where they are committed to go.
      ctx.strokeStyle = "#90a4ae";
      ctx.lineWidth = r;
      ctx.setLineDash([3 * r, 3 * r]);
      for (const [, x, y, core, ex, ey] of d.neighbours) {
        const end = this.place(ex, ey);
        ctx.beginPath();
        ctx.moveTo(...this.place(x, y));
        ctx.lineTo(...end);
        ctx.stroke();
        ctx.beginPath();
        ctx.arc(...end, core * this.scale, 0, 2 * Math.PI);
        ctx.stroke();
      }
      ctx.setLineDash([]);
      for (const [j, x, y, core] of d.neighbours) {
        ctx.fillStyle = "#cfd8dc";
        ctx.strokeStyle = "#607d8b";
        ctx.lineWidth = r;
        ctx.beginPath();
        ctx.arc(...this.place(x, y), core * this.scale, 0, 2 * Math.PI);
        ctx.fill();
        ctx.stroke();
        ctx.fillStyle = "#37474f";
        ctx.fillText(j, ...this.place(x, y));
      }
      const [x, y] = this.place(...d.position), size = d.core * this.scale;
      ctx.fillStyle = ctx.strokeStyle = this.colours.self;
      ctx.lineWidth = 2 * r;
      ctx.beginPath();
      ctx.arc(x, y, size, 0, 2 * Math.PI);
      ctx.globalAlpha = 0.35;
      ctx.fill();
      ctx.globalAlpha = 1;
      ctx.stroke();
      ctx.beginPath();
      ctx.moveTo(x, y);
      ctx.lineTo(x + 1.5 * size * Math.cos(d.heading), y - 1.5 * size * Math.sin(d.heading));
      ctx.stroke();
    },
    blocker() {
      return this.decision.neighbours.find((each) => each[0] === this.decision.blocked_by);
    },
    paintBlocker(ctx, r) {
      // From edge to edge of the bodies where there is room, else from centre to centre.
      const other = this.blocker();
      if (!other) return;
      const d = this.decision, from = this.place(...d.position), to = this.place(other[1], other[2]);
      const dx = to[0] - from[0], dy = to[1] - from[1], far = Math.hypot(dx, dy) || 1;
      const [ux, uy] = [dx / far, dy / far], head = 9 * r, wide = 5 * r;
      ctx.strokeStyle = ctx.fillStyle = this.colours.hitsPerson;
      ctx.lineWidth = 3.5 * r;
      ctx.beginPath();
      ctx.moveTo(...from);
      ctx.lineTo(to[0] - head * ux, to[1] - head * uy);
      ctx.stroke();
      ctx.beginPath();
      ctx.moveTo(...to);
      ctx.lineTo(to[0] - head * ux - wide * uy, to[1] - head * uy + wide * ux);
      ctx.lineTo(to[0] - head * ux + wide * uy, to[1] - head * uy - wide * ux);
      ctx.fill();
    },
    paintTarget(ctx, r) {
      // At the edge, where the target lies farther than that.
      const half = this.base.width / 2, d = this.decision;
      const dx = (d.target[0] - d.position[0]) * this.scale, dy = -(d.target[1] - d.position[1]) * this.scale;
      const most = half - 16 * r, far = Math.max(Math.abs(dx), Math.abs(dy), 1e-9);
      const share = Math.min(1, most / far), x = half + share * dx, y = half + share * dy;
      ctx.strokeStyle = this.colours.exit;
      ctx.lineWidth = 2 * r;
      ctx.beginPath();
      ctx.arc(x, y, 7 * r, 0, 2 * Math.PI);
      ctx.moveTo(x - 11 * r, y); ctx.lineTo(x + 11 * r, y);
      ctx.moveTo(x, y - 11 * r); ctx.lineTo(x, y + 11 * r);
      ctx.stroke();
      ctx.fillStyle = this.colours.exit;
      const away = Math.hypot(d.target[0] - d.position[0], d.target[1] - d.position[1]);
      const text = `target, ${away.toFixed(1)} m`, wide = ctx.measureText(text).width;
      const left = x > half ? x - 16 * r - wide : x + 16 * r;
      ctx.textAlign = "left";
      ctx.textBaseline = "middle";
      plate(ctx, left - 3 * r, y - 8 * r, wide + 6 * r, 16 * r, this.colours);
      ctx.fillText(text, left, y);
    },
    paintKey(ctx, r, side) {
      ctx.textBaseline = "alphabetic";
      ctx.textAlign = "left";
      ctx.font = `${11 * r}px sans-serif`;
      const bottom = side - 8 * r, long = 90 * r;
      const costs = `cost ${this.cheapest.toFixed(2)} to ${this.dearest.toFixed(2)} or more`;
      plate(ctx, 4 * r, bottom - 25 * r, ctx.measureText(costs).width + 8 * r, 29 * r, this.colours);
      plate(ctx, side - 67 * r, bottom - 44 * r, 63 * r, 48 * r, this.colours);
      plate(ctx, 4 * r, 6 * r, Math.max(this.scale, 24 * r) + 8 * r, 23 * r, this.colours);
      for (let k = 0; k < 30; k += 1) {
        ctx.fillStyle = blend(this.colours.scale, k / 29);
        ctx.fillRect(8 * r + (k * long) / 30, bottom - 20 * r, long / 30 + 1, 7 * r);
      }
      ctx.fillStyle = this.colours.text;
      ctx.fillText(costs, 8 * r, bottom);
      [["wall", this.colours.hitsWall], ["person", this.colours.hitsPerson], ["chosen", this.colours.chosen]].forEach(([name, colour], k) => {
        ctx.fillStyle = colour;
        ctx.fillRect(side - 62 * r, bottom - (2 - k) * 15 * r - 7 * r, 12 * r, 4 * r);
        ctx.fillStyle = this.colours.text;
        ctx.fillText(name, side - 46 * r, bottom - (2 - k) * 15 * r);
      });
      const metre = this.scale;
      ctx.fillRect(8 * r, 10 * r, metre, 2.5 * r);
      ctx.fillText("1 m", 8 * r, 25 * r);
    },
    refresh() {
      const canvas = this.$refs.canvas;
      if (!this.o || !this.ratio || !canvas) return;
      const ctx = canvas.getContext("2d"), r = this.ratio, k = this.pointed, colours = this.colours;
      ctx.drawImage(this.base, 0, 0);
      if (k < 0) return;
      ctx.strokeStyle = this.colours.free;
      ctx.lineWidth = 5 * r;
      this.trace(ctx, k);
      ctx.stroke();
      ctx.strokeStyle = ctx.fillStyle = [colours.pointed, colours.hitsWall, colours.hitsPerson][this.o.verdicts[k]];
      ctx.lineWidth = 2.5 * r;
      this.trace(ctx, k);
      ctx.stroke();
      this.dot(ctx, k, 4 * r);
      const other = this.decision.neighbours.find((each) => each[0] === this.o.blockers[k]);
      if (this.o.verdicts[k] === 2 && other) {
        ctx.beginPath();
        ctx.arc(...this.place(other[1], other[2]), other[3] * this.scale + 3 * r, 0, 2 * Math.PI);
        ctx.stroke();
      }
    },
  },
};
