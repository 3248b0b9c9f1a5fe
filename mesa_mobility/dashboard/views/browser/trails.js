// Where people came from, fading: a part of the crowd's view.

const TRAIL_SECONDS = 5, TRAIL_PICTURES = 150;

const TRAILS = {
  data() {
    return { trails: false };
  },
  created() {
    this.history = [];
    this.wake = document.createElement("canvas");
  },
  methods: {
    setTrails(on) {
      this.trails = on;
      this.history = [];
      this.clearWake();
      this.fresh = true;
    },
    clearWake() {
      const canvas = this.$refs.canvas;
      if (!canvas) return;
      this.wake.width = canvas.width;
      this.wake.height = canvas.height;
    },
    trace() {
      // Keeps where people were and draws one step of the way; what was drawn before fades.
      if (!this.trails) return;
      this.history.push(this.to);
      while (this.history.length > TRAIL_PICTURES ||
        this.history[0].elapsed < this.to.elapsed - TRAIL_SECONDS) this.history.shift();
      if (this.history.length > 1) this.stroke(...this.history.slice(-2));
    },
    retrace() {
      this.clearWake();
      for (let k = 1; k < this.history.length; k += 1) this.stroke(this.history[k - 1], this.history[k]);
    },
    stroke(before, after) {
      const ctx = this.wake.getContext("2d");
      ctx.globalCompositeOperation = "destination-out";
      ctx.fillStyle = `rgba(0, 0, 0, ${Math.min(1, (2.5 * (after.elapsed - before.elapsed)) / TRAIL_SECONDS)})`;
      ctx.fillRect(0, 0, this.wake.width, this.wake.height);
      ctx.globalCompositeOperation = "source-over";
      ctx.strokeStyle = "rgba(230, 90, 0, 0.8)";
      ctx.lineWidth = 1.2 * this.ratio;
      this.number(before.people);
      const a = before.people, b = after.people;
      ctx.beginPath();
      for (let k = 0; k < b.length; k += FIELDS) {
        const j = b[k] < this.index.length ? this.index[b[k]] : -1;
        if (j < 0) continue;
        ctx.moveTo(...this.place(a[j + 1], a[j + 2]));
        ctx.lineTo(...this.place(b[k + 1], b[k + 2]));
      }
      ctx.stroke();
    },
  },
};
