// People on the canvas, time, scale and legend: a part of the crowd's view.

const FIELDS = 6; // row, x, y, heading, value, metres that a lift has carried
const SHADES = 32, TURNS = 64;
// Told apart with every kind of colour vision as far as twelve can be; those of the pictures.
const TYPES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#999999", "#5b3a93",
  "#8c510a", "#b5a300", "#00a6a6", "#b2182b"];

function shade(share) {
  return blend(HEAT, share);
}

// The number of the colour of a value, and the colour. The brightest is that of `high`, which may be the lesser end.
function shadeOf(value, { low, high, names }) {
  const steps = names.length ? 1 : SHADES / (high - low);
  return Math.max(0, Math.min(SHADES - 1, Math.floor(steps * (value - low))));
}

function colourOf(value, legend) {
  const number = shadeOf(value, legend);
  return legend.names.length ? TYPES[number % TYPES.length] : shade(number / (SHADES - 1));
}

// The same as red, green and blue from 0 to 1.
const CHANNELS = new Map();

function channelsOf(value, legend) {
  const number = shadeOf(value, legend), key = legend.names.length ? -1 - (number % TYPES.length) : number;
  if (!CHANNELS.has(key)) CHANNELS.set(key, channels(colourOf(value, legend)));
  return CHANNELS.get(key);
}

const PEOPLE = {
  created() {
    this.sprites = new Map();
  },
  methods: {
    paintPeople(ctx, now) {
      const people = now.people, { scale } = this.view;
      const canvas = this.$refs.canvas;
      // Shoulders are 0.46 m wide and bodies 0.26 m deep; never smaller than can be seen.
      const size = Math.max(0.23 * scale, 1.5 * this.ratio);
      const half = Math.ceil(1.5 * size) + 1;
      if (this.spriteSize !== size) {
        this.sprites.clear();
        this.spriteSize = size;
      }
      const [px, py] = [canvas.width / 2, canvas.height / 2], { x: vx, y: vy } = this.view;
      const width = canvas.width + half, height = canvas.height + half;
      // On whole pixels pictures are copied, which is twice as fast; only large ones would jerk.
      const small = size < 4 * this.ratio;
      let ring = null;
      for (let k = 0; k < people.length; k += FIELDS) {
        const x = px + (people[k + 1] - vx) * scale, y = py - (people[k + 2] - vy) * scale;
        if (x < -half || y < -half || x > width || y > height) continue;
        const colour = shadeOf(people[k + 4], now.legend);
        const turn = ((Math.round((people[k + 3] / (2 * Math.PI)) * TURNS) % TURNS) + TURNS) % TURNS;
        const key = colour * TURNS + turn;
        let sprite = this.sprites.get(key);
        if (!sprite) {
          sprite = this.sprite(colourOf(people[k + 4], now.legend), (turn * 2 * Math.PI) / TURNS, size, half);
          this.sprites.set(key, sprite);
        }
        if (small) ctx.drawImage(sprite, Math.round(x - half), Math.round(y - half));
        else ctx.drawImage(sprite, x - half, y - half);
        if (people[k] === this.selected) ring = [x, y];
      }
      if (ring) {
        ctx.strokeStyle = "#e6007e";
        ctx.lineWidth = 2.5 * this.ratio;
        ctx.beginPath();
        ctx.arc(...ring, 1.5 * size + 3 * this.ratio, 0, 2 * Math.PI);
        ctx.stroke();
      }
    },
    sprite(fill, heading, size, half) {
      const canvas = new OffscreenCanvas(2 * half, 2 * half), ctx = drawnByProcessor(canvas);
      ctx.translate(half, half);
      ctx.rotate(-heading);
      ctx.fillStyle = fill;
      ctx.strokeStyle = this.colours.outline;
      ctx.lineWidth = Math.max(0.5, size / 10);
      ctx.beginPath();
      ctx.ellipse(0, 0, 0.57 * size, size, 0, 0, 2 * Math.PI);
      ctx.fill();
      ctx.stroke();
      // The head, and the nose that says where it faces.
      ctx.fillStyle = brightness(fill) > 0.4 ? "rgba(0, 0, 0, 0.75)" : "rgba(255, 255, 255, 0.9)";
      ctx.beginPath();
      ctx.arc(0, 0, 0.36 * size, 0, 2 * Math.PI);
      ctx.moveTo(0.25 * size, -0.3 * size);
      ctx.lineTo(0.95 * size, 0);
      ctx.lineTo(0.25 * size, 0.3 * size);
      ctx.fill();
      return canvas.transferToImageBitmap();
    },
    paintText(ctx, now) {
      const r = this.ratio, canvas = this.$refs.canvas;
      ctx.font = `${14 * r}px sans-serif`;
      ctx.fillStyle = this.colours.text;
      ctx.textAlign = "left";
      ctx.textBaseline = "alphabetic";
      ctx.fillText(`${now.elapsed.toFixed(1)} s    ${now.inside} inside`, 12 * r, 22 * r);
      // Scale bar: 1, 2 or 5 of something, about a hundred pixels long.
      const rough = (110 * r) / this.view.scale, ten = 10 ** Math.floor(Math.log10(rough));
      const metres = ten * (rough / ten >= 5 ? 5 : rough / ten >= 2 ? 2 : 1);
      const long = metres * this.view.scale, x = 12 * r, y = canvas.height - 12 * r;
      ctx.fillRect(x, y - 3 * r, long, 3 * r);
      ctx.font = `${12 * r}px sans-serif`;
      ctx.fillText(`${+metres.toPrecision(1)} m`, x, y - 7 * r);
      this.paintLegend(ctx, now.legend, canvas.width - 12 * r, canvas.height - 12 * r, r);
    },
    paintLegend(ctx, legend, right, bottom, r) {
      if (legend.names.length) {
        // One line each: the names of many types are wider than the canvas.
        const line = 16 * r, tall = legend.names.length * line;
        const wide = Math.max(...legend.names.map((name) => ctx.measureText(name).width)) + 16 * r;
        ctx.textAlign = "left";
        ctx.fillStyle = this.colours.plate;
        ctx.fillRect(right - wide - 5 * r, bottom - tall - 2 * r, wide + 10 * r, tall + 7 * r);
        legend.names.forEach((name, k) => {
          const y = bottom - tall + (k + 1) * line - 3 * r;
          ctx.fillStyle = TYPES[k % TYPES.length];
          ctx.fillRect(right - wide, y - 9 * r, 10 * r, 10 * r);
          ctx.fillStyle = this.colours.text;
          ctx.fillText(name, right - wide + 16 * r, y);
        });
        return;
      }
      const long = 160 * r;
      ctx.textAlign = "right";
      ctx.fillStyle = this.colours.plate;
      const wide = Math.max(long, ctx.measureText(legend.label).width) + 10 * r;
      ctx.fillRect(right - wide, bottom - 42 * r, wide + 5 * r, 47 * r);
      for (let k = 0; k < SHADES; k += 1) {
        ctx.fillStyle = shade(k / (SHADES - 1));
        ctx.fillRect(right - long + (k * long) / SHADES, bottom - 22 * r, long / SHADES + 1, 8 * r);
      }
      ctx.fillStyle = this.colours.text;
      ctx.fillText(legend.label, right, bottom - 28 * r);
      const end = (value, other) => (value > other ? `${value} or more` : `${value}`);
      ctx.fillText(end(legend.high, legend.low), right, bottom);
      ctx.textAlign = "left";
      ctx.fillText(end(legend.low, legend.high), right - long, bottom);
    },
  },
};
