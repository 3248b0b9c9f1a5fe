// The floor from above on a canvas, with people and a map of the floor.

class PlanView {
  // actions: click([x, y] in metres, reach in metres).
  constructor(holder, actions) {
    const canvas = document.createElement("canvas");
    canvas.style.cssText = "display: block; width: 100%; height: 100%; touch-action: none; cursor: crosshair";
    holder.appendChild(canvas);
    this.$refs = { canvas, box: holder };
    this.actions = actions;
    this.fixed = true;
    this.colours = LIGHT;
    this.selected = -1;
    this.background = document.createElement("canvas");
    for (const each of [canvas, this.background]) drawnByProcessor(each);
    this.floor = null;
    this.layer = null; // {pixels, grid}
    this.drawn = 0;
    Object.assign(this, PLANE.methods, PEOPLE.methods);
    PLANE.created.call(this);
    PEOPLE.created.call(this);
    new Gestures(canvas, this);
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
  }

  get shownBounds() { return this.floor && this.floor.bounds; }

  // floor: what `floor.py` makes, or a storey of what `storeys.py` makes, with the flights that end on it.
  setFloor(floor, flights = []) {
    const same = this.floor && String(this.floor.bounds) === String(floor.bounds);
    this.floor = { outline: [], zones: [], obstacles: [], refuges: [], ...floor };
    this.flights = flights;
    this.dirty = true;
    if (!same) this.fit();
  }

  click(event) { this.actions.click(this.metres(event), Math.max(0.3, (10 * this.ratio) / this.view.scale)); }

  // now: {people: FIELDS of each, legend}; layer: {pixels, grid} or null.
  draw(now, layer) {
    if (!this.ratio || !this.floor) return;
    if (layer !== this.layer) this.dirty = true;
    this.layer = layer;
    if (this.dirty) this.paintBackground();
    this.dirty = false;
    const ctx = this.$refs.canvas.getContext("2d");
    ctx.drawImage(this.background, 0, 0);
    this.paintPeople(ctx, now);
    paintPlates(ctx, this.plates, this.ratio, this.colours);
    this.drawn += 1;
  }

  paintBackground() {
    const { canvas } = this.$refs, ctx = this.background.getContext("2d"), place = (x, y) => this.place(x, y);
    resizeTo([this.background], canvas.width, canvas.height);
    ctx.fillStyle = this.colours.ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    paintFloor(ctx, this.floor, place, this.ratio, this.colours, this.layer && (() => paintCells(ctx, this.layer, place, this.view.scale)));
    for (const flight of this.flights) this.paintFlight(ctx, flight);
    this.plates = openingPlates(ctx, this.floor, place, this.ratio);
  }

  paintFlight(ctx, { head, down, width, going, risers, tread }) {
    const [dx, dy] = down, half = width / 2;
    const at = (along, aside) => this.place(head[0] + along * dx - aside * dy, head[1] + along * dy + aside * dx);
    ctx.fillStyle = "rgba(201, 183, 156, 0.55)";
    ctx.strokeStyle = this.colours.away;
    ctx.lineWidth = this.ratio;
    ctx.beginPath();
    [[0, -half], [going, -half], [going, half], [0, half]].forEach((each, k) => ctx[k ? "lineTo" : "moveTo"](...at(...each)));
    ctx.closePath();
    ctx.fill();
    ctx.stroke();
    ctx.beginPath();
    for (let step = 1; step < risers - 1; step += 1) {
      ctx.moveTo(...at(step * tread, -half));
      ctx.lineTo(...at(step * tread, half));
    }
    ctx.stroke();
  }

  // Metres of a scale bar and its length in pixels of the page: 1, 2 or 5 of something, about a hundred pixels.
  scaleBar() {
    const rough = (110 * this.ratio) / this.view.scale, ten = 10 ** Math.floor(Math.log10(rough));
    const metres = ten * (rough / ten >= 5 ? 5 : rough / ten >= 2 ? 2 : 1);
    return [+metres.toPrecision(1), (metres * this.view.scale) / this.ratio];
  }
}
