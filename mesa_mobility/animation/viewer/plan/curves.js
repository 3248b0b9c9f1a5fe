// How many people have passed each door until each time, with a cursor at the time that is shown.

const CURVE_ROOM = 8, CURVES_MOST = 8; // pixels beside the curves, as beside a slider; doors drawn at most
const CURVE_COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#5b3a93", "#8c510a"];

class Curves {
  // doors: [{name, times: rising seconds}]; first, last: seconds.
  constructor(canvas, doors, first, last) {
    Object.assign(this, { canvas, first, last });
    this.doors = doors.filter(({ times }) => times.length).sort((a, b) => b.times.length - a.times.length).slice(0, CURVES_MOST);
    this.most = Math.max(1, ...this.doors.map(({ times }) => times.length));
    this.still = document.createElement("canvas");
    for (const each of [canvas, this.still]) drawnByProcessor(each);
  }

  passed(door, seconds) {
    let low = 0, high = door.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (door.times[middle] <= seconds + 1e-6) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  x(seconds, r) {
    const wide = this.canvas.width - 2 * CURVE_ROOM * r;
    return CURVE_ROOM * r + (wide * (seconds - this.first)) / Math.max(this.last - this.first, 1e-9);
  }

  y(people, r) { return this.canvas.height - 3 * r - ((this.canvas.height - 16 * r) * people) / this.most; }

  // Seconds at a place on the page.
  at(clientX) {
    const box = this.canvas.getBoundingClientRect(), wide = box.width - 2 * CURVE_ROOM;
    const share = Math.min(Math.max((clientX - box.left - CURVE_ROOM) / wide, 0), 1);
    return this.first + share * (this.last - this.first);
  }

  draw(seconds) {
    const { canvas, still } = this, r = pixelRatio();
    if (!canvas.clientWidth || !canvas.clientHeight) return;
    const other = resizeTo([canvas], Math.round(canvas.clientWidth * r), Math.round(canvas.clientHeight * r));
    if (other || !this.known) this.paint(still, r);
    this.known = true;
    const ctx = canvas.getContext("2d");
    ctx.clearRect(0, 0, canvas.width, canvas.height);
    ctx.drawImage(still, 0, 0);
    const x = this.x(seconds, r);
    ctx.strokeStyle = "#d50000";
    ctx.lineWidth = r;
    ctx.beginPath();
    ctx.moveTo(x, 0);
    ctx.lineTo(x, canvas.height);
    ctx.stroke();
    this.doors.forEach((door, k) => {
      ctx.fillStyle = CURVE_COLOURS[k];
      ctx.beginPath();
      ctx.arc(x, this.y(this.passed(door, seconds), r), 3 * r, 0, 2 * Math.PI);
      ctx.fill();
    });
  }

  paint(still, r) {
    resizeTo([still], this.canvas.width, this.canvas.height);
    const ctx = still.getContext("2d");
    ctx.clearRect(0, 0, still.width, still.height);
    ctx.font = `${11 * r}px sans-serif`;
    ctx.strokeStyle = "#d5d5d2";
    ctx.fillStyle = "#555";
    ctx.lineWidth = r;
    ctx.textBaseline = "top";
    const whole = 10 ** Math.floor(Math.log10(Math.max((this.last - this.first) / 4, 1e-9)));
    const every = [1, 2, 5, 10].map((k) => k * whole).find((each) => (this.last - this.first) / each <= 10);
    for (let t = Math.ceil(this.first / every) * every; t <= this.last; t += every) {
      const x = this.x(t, r);
      ctx.beginPath();
      ctx.moveTo(x, 0);
      ctx.lineTo(x, still.height);
      ctx.stroke();
      const label = `${+t.toFixed(2)} s`;
      ctx.fillText(label, Math.min(x + 3 * r, still.width - ctx.measureText(label).width), 0);
    }
    ctx.lineWidth = 1.8 * r;
    this.doors.forEach((door, k) => {
      ctx.strokeStyle = CURVE_COLOURS[k];
      ctx.beginPath();
      ctx.moveTo(this.x(this.first, r), this.y(0, r));
      door.times.forEach((time, n) => {
        ctx.lineTo(this.x(time, r), this.y(n, r));
        ctx.lineTo(this.x(time, r), this.y(n + 1, r));
      });
      ctx.lineTo(this.x(this.last, r), this.y(door.times.length, r));
      ctx.stroke();
    });
  }

  // What the curves are, with the numbers at a time.
  told(seconds) {
    return this.doors.map((door, k) => ({ name: door.name, colour: CURVE_COLOURS[k], passed: this.passed(door, seconds) }));
  }
}
