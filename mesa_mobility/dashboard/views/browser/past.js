// What a run has shown so far, and the time that is looked at: a part of the crowd's views.

const PAST_EVERY = 0.1, PAST_GAP = 5; // simulated seconds between two pictures
const PAST_MOST = 96e6, PAST_EACH = 256; // bytes of all of them, and of each beside its people
const POSES_KEPT = 120, POSES_APART = 2; // seconds for which bodies are kept, and for which they go on untold
const TOLD_EVERY = 250; // milliseconds between two of the slider

// Pictures of one run in the order of time, those that were drawn and those between: both views of a page share them.
class Past {
  constructor(run) {
    this.run = run;
    this.pictures = [];
    this.bytes = 0;
    this.came = new Map(); // row -> when and where, see between.js
    this.left = new Map();
    this.persons = new Map(); // bodies
    this.posed = []; // seconds at which these were told
    this.doors = new Map(); // name -> seconds of passages
  }

  // picture: {elapsed, people, legend, inside}; passed and between: what serialization.py tells with it. What was told
  // before does no harm.
  take(picture, { passed, between: since }) {
    for (const each of passed) this.count(...each);
    for (const each of passagesOf(since.came)) this.came.set(...each);
    for (const each of passagesOf(since.left)) this.left.set(...each);
    for (const each of picturesBetween(since, this.pictures[this.pictures.length - 1], picture)) this.add(each, 1e-6);
    this.add(picture, PAST_EVERY - 1e-6);
  }

  add(picture, later) {
    const { pictures } = this, size = ({ people }) => people.byteLength + PAST_EACH;
    if (pictures.length && picture.elapsed < this.last + later) return;
    pictures.push(picture);
    this.bytes += size(picture);
    if (this.bytes < PAST_MOST) return;
    const gone = Math.ceil(pictures.length / 16); // at once: to shift a long list takes time
    for (const each of pictures.splice(0, gone)) this.bytes -= size(each);
    for (const known of [this.came, this.left]) {
      for (const [row, { elapsed }] of known) if (elapsed < this.first) known.delete(row);
    }
  }

  count(name, people, elapsed) {
    if (!this.doors.has(name)) this.doors.set(name, []);
    const times = this.doors.get(name);
    while (times.length < people) times.push(elapsed);
    times.length = people; // somebody may have come back
  }

  get first() { return this.pictures.length ? this.pictures[0].elapsed : 0; }

  get last() { return this.pictures.length ? this.pictures[this.pictures.length - 1].elapsed : 0; }

  // The number of the last picture until a time; that of the first before it.
  until(elapsed) { return lastUntil(this.pictures, elapsed, (each) => each.elapsed); }

  // The poses of bodies were told at a time.
  pose(elapsed) {
    const { posed } = this;
    posed.push(elapsed);
    if (posed[posed.length >> 1] < elapsed - POSES_KEPT) posed.splice(0, posed.length >> 1);
  }

  // Whether the poses at a time are known.
  wasPosed(elapsed) {
    const k = lastUntil(this.posed, elapsed), { posed } = this;
    return k >= 0 && posed[k] <= elapsed + 1e-9 && (k + 1 === posed.length || posed[k + 1] - posed[k] < POSES_APART);
  }

  // The pictures before and after a time; the same one twice where it is alone.
  around(elapsed) {
    const k = this.until(elapsed), a = this.pictures[k], b = this.pictures[k + 1];
    return !b || elapsed <= a.elapsed || b.elapsed - a.elapsed > PAST_GAP ? [a, a] : [a, b];
  }

  // Everybody at a time.
  at(elapsed, storeys) {
    const [a, b] = this.around(elapsed);
    return a === b ? a : mixed(a, b, elapsed, this, storeys);
  }
}

// The number of the last of rising times until a time; 0 before the first, -1 of none.
function lastUntil(times, elapsed, of = (each) => each) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (of(times[middle]) <= elapsed + 1e-9) low = middle;
    else high = middle - 1;
  }
  return Math.min(low, high);
}

const PAST = {
  data() {
    return { cursor: null, pastFirst: 0, pastLast: 0, goesOn: false };
  },
  created() {
    this.past = new Past(-1);
    this.toldAt = 0;
    this.curves = null;
  },
  computed: {
    behind() { return this.cursor === null ? "live" : `${(this.pastLast - this.cursor).toFixed(1)} s ago`; },
  },
  methods: {
    keepPast(picture, told) {
      const known = globalThis.mesaMobilityPast;
      if (!known || known.run !== picture.run || picture.elapsed < known.last - 1e-6) {
        globalThis.mesaMobilityPast = new Past(picture.run);
        this.cursor = null;
      }
      this.past = globalThis.mesaMobilityPast;
      this.past.take(picture, told);
      const time = performance.now();
      if (time - this.toldAt < TOLD_EVERY && picture.elapsed > 0) return;
      this.tellPast(time);
    },
    // The slider and the curves; not with each picture, which the page would be slow to follow.
    tellPast(time) {
      this.toldAt = time;
      this.pastFirst = this.past.first;
      this.pastLast = this.past.last;
    },
    scrub(elapsed) {
      this.tellPast(performance.now());
      const at = Math.min(Math.max(elapsed, this.pastFirst), this.pastLast);
      this.cursor = at >= this.pastLast - 1e-6 ? null : at;
      this.fresh = true;
    },
    goLive() {
      this.cursor = null;
      this.goesOn = false;
      this.fresh = true;
    },
    // Time goes by from what is looked at, until it has caught up.
    letPastGoOn(passed) {
      if (!this.goesOn || this.cursor === null) return;
      this.scrub(this.cursor + Math.min(passed, 0.25));
    },
    paintCurves() {
      const canvas = this.$refs.curves;
      if (!canvas || !canvas.clientWidth) return;
      const doors = [...this.past.doors].map(([name, times]) => ({ name, times })), first = this.pastFirst, last = this.pastLast;
      const key = [this.past.run, first, last, doors.map(({ times }) => times.length)].join(" ");
      if (key !== this.curvesKey) this.curves = new Curves(canvas, doors, first, Math.max(last, first + 0.1));
      this.curvesKey = key;
      this.curves.draw(this.cursor === null ? last : this.cursor);
    },
    scrubCurves(event) {
      if (event.buttons & 1 && this.curves) this.scrub(this.curves.at(event.clientX));
    },
  },
};
