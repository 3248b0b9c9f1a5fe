// What comes from the server, and everybody's place between two pictures: a part of the crowd's view.

const FRAMES = {
  created() {
    // Kept from Vue, which would wrap every array and look at it at each change.
    this.from = this.to = null;
    this.index = new Int32Array(0);
    this.arrived = 0;
    this.interval = 100;
  },
  methods: {
    take() {
      const frame = this.frame;
      if (!frame || frame.people === undefined) return;
      const next = { run: frame.run, number: frame.number, elapsed: frame.elapsed,
        inside: frame.inside, legend: frame.legend, people: numbers(frame.people) };
      const time = performance.now();
      if (this.to && this.to.run === next.run && next.elapsed >= this.to.elapsed) {
        this.from = this.between(time);
        // Pictures come a little irregularly; who moves on at the mean pace never jumps.
        const gap = Math.min(Math.max(time - this.arrived, 16), 400);
        this.interval += 0.3 * (gap - this.interval);
        if (next.elapsed > this.to.elapsed) this.trace();
      } else {
        this.from = null;
        this.history = [];
        this.clearWake();
      }
      if (JSON.stringify(next.legend) !== JSON.stringify(this.to && this.to.legend)) {
        this.sprites.clear();
      }
      this.arrived = time;
      this.to = next;
      this.keepPast(next, frame);
      this.number(this.from ? this.from.people : new Float32Array(0));
      this.fresh = true;
      this.seen(next.number);
    },
    number(people) {
      let most = -1;
      for (let k = 0; k < people.length; k += FIELDS) most = Math.max(most, people[k]);
      if (most >= this.index.length) this.index = new Int32Array(2 * most + 64);
      this.index.fill(-1);
      for (let k = 0; k < people.length; k += FIELDS) this.index[people[k]] = k;
    },
    between(time) {
      // Everybody between the last picture that was drawn and the one that has come since.
      const to = this.to;
      const share = this.from ? (time - this.arrived) / this.interval : 1;
      if (share >= 1) return to;
      const a = this.from.people, b = to.people, index = this.index;
      const people = new Float32Array(b);
      for (let k = 0; k < b.length; k += FIELDS) {
        const j = b[k] < index.length ? index[b[k]] : -1;
        if (j < 0) continue; // has just come in
        people[k + 1] = a[j + 1] + share * (b[k + 1] - a[j + 1]);
        people[k + 2] = a[j + 2] + share * (b[k + 2] - a[j + 2]);
        let turn = b[k + 3] - a[j + 3];
        turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
        people[k + 3] = a[j + 3] + share * turn;
        people[k + 5] = a[j + 5] + share * (b[k + 5] - a[j + 5]);
      }
      return { ...to, people,
        elapsed: this.from.elapsed + share * (to.elapsed - this.from.elapsed) };
    },
    // What is drawn: the present, or the time that is looked at.
    pictureAt(time) { return this.cursor === null ? this.between(time) : this.past.at(this.cursor, this.floor.storeys); },
    moving(time) {
      return this.from !== null && time - this.arrived < this.interval + 40;
    },
  },
};
