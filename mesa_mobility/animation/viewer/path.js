// A path of the camera: views, each from a time on, between which it moves evenly.
"use strict";

class CameraPath {
  constructor() {
    this.views = []; // {frame, eye: [x, y, z], target: [x, y, z]}, by rising frames
  }

  add(frame, eye, target) {
    this.views = [...this.views.filter((each) => Math.abs(each.frame - frame) > 0.5), { frame, eye, target }]
      .sort((a, b) => a.frame - b.frame);
  }

  clear() { this.views = []; }

  // Eye and target at a time: on a curve through all views (Catmull and Rom 1974).
  at(frame) {
    const { views } = this, last = views.length - 1;
    let k = 0;
    while (k < last && views[k + 1].frame <= frame) k += 1;
    if (frame <= views[0].frame || k === last) return views[frame <= views[0].frame ? 0 : k];
    const [a, b, c, d] = [k - 1, k, k + 1, k + 2].map((each) => views[Math.min(Math.max(each, 0), last)]);
    const u = (frame - b.frame) / (c.frame - b.frame);
    const slope = (from, to, key, i) => ((to[key][i] - from[key][i]) * (c.frame - b.frame)) / Math.max(to.frame - from.frame, 1e-9);
    const along = (key) => [0, 1, 2].map((i) => {
      const p = b[key][i], q = c[key][i], m = slope(a, c, key, i), n = slope(b, d, key, i);
      return (2 * u ** 3 - 3 * u ** 2 + 1) * p + (u ** 3 - 2 * u ** 2 + u) * m + (3 * u ** 2 - 2 * u ** 3) * q + (u ** 3 - u ** 2) * n;
    });
    return { frame, eye: along("eye"), target: along("target") };
  }

  // Seconds and metres, as a film takes them.
  text() {
    const round = (values) => values.map((each) => Math.round(each * 1000) / 1000);
    return JSON.stringify({ views: this.views.map(({ frame, eye, target }) => ({ time: round([frame / RATE])[0], eye: round(eye),
      target: round(target) })) }, null, 1);
  }

  // Throws where the text is no path.
  read(text) {
    const numbers = (values, count) => Array.isArray(values) && values.length === count && values.every(Number.isFinite);
    const { views } = JSON.parse(text);
    if (!Array.isArray(views) || !views.every(({ time, eye, target }) => numbers([time], 1) && numbers(eye, 3) && numbers(target, 3))) {
      throw new Error("expected views with time, eye and target");
    }
    this.clear();
    for (const { time, eye, target } of views) this.add(time * RATE, eye, target);
  }
}
