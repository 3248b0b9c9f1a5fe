// Which part of the floor is on the canvas, at what scale: a part of the crowd's view.

const PLANE = {
  created() {
    this.view = { scale: 20, x: 0, y: 0 };
    this.dirty = this.whole = true;
  },
  methods: {
    place(x, y) {
      const canvas = this.$refs.canvas, v = this.view;
      return [canvas.width / 2 + (x - v.x) * v.scale, canvas.height / 2 - (y - v.y) * v.scale];
    },
    onPage(x, y) {
      const box = this.$refs.canvas.getBoundingClientRect(), [px, py] = this.place(x, y);
      return [box.left + px / this.ratio, box.top + py / this.ratio];
    },
    metres({ clientX, clientY }) {
      const canvas = this.$refs.canvas, box = canvas.getBoundingClientRect(), v = this.view;
      const px = (clientX - box.left) * this.ratio, py = (clientY - box.top) * this.ratio;
      return [v.x + (px - canvas.width / 2) / v.scale, v.y - (py - canvas.height / 2) / v.scale];
    },
    resize() {
      const canvas = this.$refs.canvas, box = this.$refs.box, before = this.ratio;
      if (!box.clientWidth || !box.clientHeight) return; // another tab is shown
      const ratio = this.ratio = pixelRatio();
      if (before) this.view = { ...this.view, scale: (this.view.scale * ratio) / before };
      const width = Math.round(box.clientWidth * ratio), height = Math.round(box.clientHeight * ratio);
      if (!resizeTo([canvas], width, height)) return;
      this.dirty = true;
      if (this.whole) this.fit();
    },
    fit() {
      const canvas = this.$refs.canvas;
      this.dirty = this.whole = true;
      if (!canvas || !this.shownBounds) return;
      const [x0, y0, x1, y1] = this.shownBounds;
      const room = 44 * this.ratio; // for the texts above and below
      this.view = { x: (x0 + x1) / 2, y: (y0 + y1) / 2,
        scale: Math.min((0.97 * canvas.width) / (x1 - x0),
          Math.max(canvas.height - 2 * room, 1) / (y1 - y0)) };
    },
    zoom(factor) {
      const box = this.$refs.canvas.getBoundingClientRect();
      this.zoomAt(box.left + box.width / 2, box.top + box.height / 2, factor);
    },
    zoomAt(clientX, clientY, factor) {
      const [x, y] = this.metres({ clientX, clientY }), v = this.view;
      const scale = Math.min(Math.max(v.scale * factor, 0.5), 2000);
      // What is under the pointer stays there.
      this.show({ scale, x: x + ((v.x - x) * v.scale) / scale, y: y + ((v.y - y) * v.scale) / scale });
    },
    pan(dx, dy) {
      const metre = this.ratio / this.view.scale;
      this.show({ ...this.view, x: this.view.x - dx * metre, y: this.view.y + dy * metre });
    },
    show(view) {
      if (this.shownBounds) {
        // The floor cannot be lost: its bounds hold the middle of the canvas.
        const [x0, y0, x1, y1] = this.shownBounds;
        view.x = Math.min(Math.max(view.x, x0), x1);
        view.y = Math.min(Math.max(view.y, y0), y1);
      }
      this.view = view;
      this.whole = false;
      this.dirty = true;
    },
  },
};
