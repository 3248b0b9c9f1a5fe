// The keys that steer the selected person, while they are held.

// By where keys are, whatever letters they have: to the right, and away from who looks.
const WAYS = { ArrowUp: [0, 1], KeyW: [0, 1], ArrowDown: [0, -1], KeyS: [0, -1], ArrowLeft: [-1, 0],
  KeyA: [-1, 0], ArrowRight: [1, 0], KeyD: [1, 0] };
const TURN = 0.1, SEND_EVERY = 100; // radians of a view that turns, milliseconds

class Steering {
  // `view` has `selected`, hears(event), toTheRight() in metres on the floor, and send(row, direction).
  constructor(view) {
    this.view = view;
    this.held = new Set();
    this.row = -1;
    this.direction = null; // as it was sent, null while nobody is steered
    this.sent = 0;
    this.listeners = [[window, "keydown", (event) => this.press(event)], [window, "keyup", (event) => this.lift(event)],
      [window, "blur", () => this.letGo()], [document, "visibilitychange", () => this.letGo()]];
    for (const [where, name, act] of this.listeners) where.addEventListener(name, act);
  }

  dispose() {
    this.letGo();
    for (const [where, name, act] of this.listeners) where.removeEventListener(name, act);
  }

  press(event) {
    const { view, held } = this;
    if (!WAYS[event.code] || event.ctrlKey || event.metaKey || event.altKey) return;
    if (view.selected < 0 || !view.hears(event)) return;
    event.preventDefault();
    if (held.has(event.code)) return;
    held.add(event.code);
    this.row = view.selected;
    this.send();
  }

  lift(event) {
    if (this.held.delete(event.code)) this.send();
  }

  letGo() {
    if (!this.held.size) return;
    this.held.clear();
    this.send();
  }

  // The view has been drawn: it may have turned, or another person may have been selected.
  drawn(time) {
    if (!this.held.size) return;
    if (this.view.selected !== this.row) this.letGo();
    else if (time - this.sent > SEND_EVERY && this.turned() > TURN) this.send();
  }

  wanted() {
    if (!this.held.size) return null;
    let right = 0, on = 0;
    for (const code of this.held) {
      right += Math.sign(WAYS[code][0]);
      on += Math.sign(WAYS[code][1]);
    }
    const [rx, ry] = this.view.toTheRight();
    const x = right * rx - on * ry, y = right * ry + on * rx, far = Math.hypot(x, y);
    return far ? [x / far, y / far] : [0, 0]; // of keys against each other somebody stands still
  }

  turned() {
    const now = this.wanted(), before = this.direction;
    if (!now || !before) return 0;
    return Math.abs(Math.atan2(before[0] * now[1] - before[1] * now[0], before[0] * now[0] + before[1] * now[1]));
  }

  send() {
    this.direction = this.wanted();
    this.sent = performance.now();
    this.view.send(this.row, this.direction);
  }
}

const STEERED = {
  data() {
    return { steers: false };
  },
  computed: {
    KEYS_OF_PEOPLE() { return "N and P select the next and the previous person, Esc nobody; Space plays and pauses."; },
    hint() {
      if (this.selected < 0) return "";
      const who = `person ${this.selected}`;
      return this.steers ? `${who} is steered; let the keys go to hand it back` : `W A S D or arrow keys steer ${who}`;
    },
  },
  methods: {
    keysOfPeople() {
      const beside = (by) => this.pick({ by, run: this.to ? this.to.run : 0 });
      return { n: () => beside(1), N: () => beside(1), p: () => beside(-1), P: () => beside(-1), Escape: () => this.choose(-1) };
    },
    send(row, direction) {
      this.steers = Boolean(direction);
      this.fresh = true;
      this.steer({ row, direction, run: this.to ? this.to.run : 0 });
    },
  },
};
