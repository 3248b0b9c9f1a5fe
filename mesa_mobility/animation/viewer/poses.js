// Where people are and which recorded poses they go through: what mesa_mobility/bodies/bank.py and
// sequence.py do.
"use strict";

const RATE = 30; // frames a second
const BLEND = 6; // frames

// Quaternions (x, y, z, w) and vectors lie in arrays, from an index on.
function multiply(a, i, b, j, out, k) {
  const ax = a[i], ay = a[i + 1], az = a[i + 2], aw = a[i + 3];
  const bx = b[j], by = b[j + 1], bz = b[j + 2], bw = b[j + 3];
  out[k] = aw * bx + ax * bw + ay * bz - az * by;
  out[k + 1] = aw * by - ax * bz + ay * bw + az * bx;
  out[k + 2] = aw * bz + ax * by - ay * bx + az * bw;
  out[k + 3] = aw * bw - ax * bx - ay * by - az * bz;
}

// q turns v and is added to p.
function turned(q, i, v, j, p, m, out, k) {
  const x = q[i], y = q[i + 1], z = q[i + 2], w = q[i + 3];
  const vx = v[j], vy = v[j + 1], vz = v[j + 2];
  const tx = 2 * (y * vz - z * vy), ty = 2 * (z * vx - x * vz), tz = 2 * (x * vy - y * vx);
  out[k] = p[m] + vx + w * tx + y * tz - z * ty;
  out[k + 1] = p[m + 1] + vy + w * ty + z * tx - x * tz;
  out[k + 2] = p[m + 2] + vz + w * tz + x * ty - y * tx;
}

// Math.hypot takes ten times as long as a root.
function normalise(q, i) {
  const scale = 1 / Math.sqrt(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3]);
  for (let k = i; k < i + 4; k += 1) q[k] *= scale;
}

function exponential(x, y, z, out) {
  const angle = Math.sqrt(x * x + y * y + z * z), s = angle < 1e-9 ? 0.5 : Math.sin(angle / 2) / angle;
  out[0] = x * s;
  out[1] = y * s;
  out[2] = z * s;
  out[3] = Math.cos(angle / 2);
}

const fade = (frames) => {
  const u = frames / BLEND;
  return 1 - u * u * (3 - 2 * u);
};

const ZERO = [0, 0, 0];

class Bank {
  // Arrays of PoseBank, and the neutral skeleton: parents, offsets, turning, otherSide, legs.
  constructor(arrays, skeleton) {
    Object.assign(this, arrays);
    this.skeleton = skeleton;
    this.last = new Int32Array(this.heights.length);
    for (let c = 0; c + 1 < this.clips.length; c += 1) {
      this.last.fill(this.clips[c + 1] - 1, this.clips[c], this.clips[c + 1]);
    }
  }

  later(number, by) {
    const row = number >> 1;
    return 2 * Math.max(0, Math.min(row + by, this.last[row])) + (number & 1);
  }

  height(number) { return this.heights[number >> 1] * 1e-4; }

  // Whether ankle or toe of a side bears on the floor: bit 0 and bit 1.
  bearing(number, side) {
    return (this.contacts[number >> 1] >> (2 * ((number & 1) ^ side))) & 3;
  }

  turn(number, k, out, at) {
    const mirrored = number & 1, from = 4 * ((number >> 1) * 17 + (mirrored ? this.skeleton.otherSide[k] : k));
    const sign = mirrored ? -1 : 1, r = this.rotations;
    out[at] = sign * r[from];
    out[at + 1] = r[from + 1];
    out[at + 2] = sign * r[from + 2];
    out[at + 3] = r[from + 3];
    normalise(out, at);
  }
}

// What one person goes through: stretches of recordings, in the order of their first frames.
class Course {
  constructor(bank) {
    this.bank = bank;
    this.starts = [];
    this.numbers = [];
    this.moving = [];
    this.strides = [];
    this.joins = new Map();
    this.feet = null;
  }

  add(start, number, moving, stride) {
    this.starts.push(start);
    this.numbers.push(number);
    this.moving.push(moving);
    this.strides.push(stride);
  }

  // The stretch under way at a time in frames; the first one before.
  at(frame) {
    let low = 0, high = this.starts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.starts[middle] <= frame) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  number(index, frame) {
    return this.moving[index]
      ? this.bank.later(this.numbers[index], Math.max(0, Math.floor(frame - this.starts[index])))
      : this.numbers[index];
  }

  // What differs where a stretch begins: (17, 3) turns, the pelvis's height, strides.
  join(index) {
    let found = this.joins.get(index);
    if (found) return found;
    if (this.joins.size > 8) this.joins.clear();
    const { bank } = this, here = this.numbers[index], before = this.number(index - 1, this.starts[index]);
    const turns = new Float64Array(51), a = new Float64Array(4), b = new Float64Array(4), d = new Float64Array(4);
    for (let k = 0; before !== here && k < 17; k += 1) {
      bank.turn(here, k, a, 0);
      for (let i = 0; i < 3; i += 1) a[i] = -a[i];
      bank.turn(before, k, b, 0);
      multiply(a, 0, b, 0, d, 0);
      const sine = Math.hypot(d[0], d[1], d[2]), sign = d[3] < 0 ? -1 : 1;
      const scale = sine < 1e-9 ? 2 : (sign * 2 * Math.atan2(sine, sign * d[3])) / sine;
      for (let i = 0; i < 3; i += 1) turns[3 * k + i] = d[i] * scale;
    }
    found = { turns, height: bank.height(before) - bank.height(here),
      stride: this.strides[index - 1] - this.strides[index], any: before !== here };
    this.joins.set(index, found);
    return found;
  }

  // Forget what ended before a frame, as somebody does who is watched while the model runs.
  forget(frame) {
    const first = this.at(frame);
    if (first < 64) return;
    for (const each of ["starts", "numbers", "moving", "strides"]) this[each] = this[each].slice(first);
    this.joins.clear();
  }
}

// Where a person is: samples of (x, y, heading) at rising frames, straight between them.
class Track {
  // z: elevations; 0 where they are left out.
  constructor(frames = [], x = [], y = [], heading = [], z = null) {
    Object.assign(this, { frames, x, y, heading, z, near: 0 });
  }

  add(frame, [x, y, z], heading) {
    const last = this.heading[this.heading.length - 1] ?? heading, round = 2 * Math.PI;
    this.frames.push(frame);
    this.x.push(x);
    this.y.push(y);
    this.z.push(z);
    this.heading.push(heading + round * Math.round((last - heading) / round));
  }

  // Place and heading at a time: [x, y, heading, z].
  at(frame) {
    const { frames, x, y, heading, z } = this, last = frames.length - 1;
    let k = Math.min(this.near, last);
    while (k < last && frames[k + 1] <= frame) k += k + 64 < last && frames[k + 64] <= frame ? 64 : 1;
    while (k > 0 && frames[k] > frame) k -= k > 64 && frames[k - 64] > frame ? 64 : 1;
    this.near = k;
    if (k === last || frame <= frames[k]) return [x[k], y[k], heading[k], z ? z[k] : 0];
    const u = (frame - frames[k]) / (frames[k + 1] - frames[k]);
    const between = (values) => values[k] + u * (values[k + 1] - values[k]);
    return [between(x), between(y), between(heading), z ? between(z) : 0];
  }

  forget(frame) {
    if (this.frames.length < 256 || this.frames[128] > frame) return;
    for (const each of ["frames", "x", "y", "heading", "z"]) this[each] = this[each].slice(128);
    this.near = 0;
  }
}
