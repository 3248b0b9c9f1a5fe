// What a run has shown so far, and the time that is looked at: a part of the crowd's views.

const PAST_EVERY = 0.1, PAST_GAP = 5, PAST_MOST = 96e6; // simulated seconds between two pictures; bytes of all of them
const PAST_BODIES = 120, TOLD_EVERY = 250; // seconds for which bodies are kept; milliseconds between two of the slider

// Pictures of one run in the order of time: both views of a page share them.
class Past {
  constructor(run) {
    this.run = run;
    this.pictures = [];
    this.bytes = 0;
    this.persons = new Map(); // bodies
    this.doors = new Map(); // name -> seconds of passages
  }

  // picture: {elapsed, people, legend, inside}, see frames.js; passed: [name, people] of each door.
  add(picture, passed = []) {
    const { pictures } = this, last = pictures[pictures.length - 1];
    if (last && picture.elapsed < last.elapsed + PAST_EVERY - 1e-6) return;
    pictures.push(picture);
    this.bytes += picture.people.byteLength;
    for (const [name, people] of passed) this.count(name, people, picture.elapsed);
    if (this.bytes < PAST_MOST) return;
    const gone = Math.ceil(pictures.length / 16); // at once: to shift a long list takes time
    for (const { people } of pictures.splice(0, gone)) this.bytes -= people.byteLength;
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
  until(elapsed) {
    let low = 0, high = this.pictures.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.pictures[middle].elapsed <= elapsed + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  // Everybody at a time, between the picture before and the one after.
  at(elapsed) {
    const k = this.until(elapsed), a = this.pictures[k], b = this.pictures[k + 1];
    if (!b || elapsed <= a.elapsed || b.elapsed - a.elapsed > PAST_GAP) return a;
    const share = (elapsed - a.elapsed) / (b.elapsed - a.elapsed);
    return { ...a, elapsed, people: mixed(a.people, b.people, share) };
  }
}

// People of one picture on their way to their places in the next.
function mixed(from, to, share) {
  const next = new Map(), people = new Float32Array(from);
  for (let k = 0; k < to.length; k += FIELDS) next.set(to[k], k);
  for (let k = 0; k < from.length; k += FIELDS) {
    const j = next.get(from[k]);
    if (j === undefined) continue; // leaves
    for (const i of [1, 2, 5]) people[k + i] += share * (to[j + i] - from[k + i]);
    let turn = to[j + 3] - from[k + 3];
    turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
    people[k + 3] += share * turn;
  }
  return people;
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
    keepPast(picture, passed) {
      const known = globalThis.mesaMobilityPast;
      if (!known || known.run !== picture.run || picture.elapsed < known.last - 1e-6) {
        globalThis.mesaMobilityPast = new Past(picture.run);
        this.cursor = null;
      }
      this.past = globalThis.mesaMobilityPast;
      this.past.add(picture, passed);
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
