// The bodies of people from the poses that they go through: what mesa_mobility/bodies/motion.py and
// feet.py do.
"use strict";

const STEP_FRAMES = 9, LANDING = 4, BEFORE = 45; // frames
const FARTHEST = 0.15, STEP_LIFT = 0.03, STRAIGHT = 0.9995; // metres, metres, share of the leg

// One body at a time: where its joints are, and how they are turned. Scratch arrays are shared.
class Body {
  constructor(skeleton) {
    this.skeleton = skeleton;
    this.footing = null; // stairs that carry bodies and feet
    this.places = new Float64Array(66);
    this.turns = new Float64Array(88);
    this.local = new Float64Array(4);
    this.other = new Float64Array(4);
    this.whole = Array.from(skeleton.parents, (_, j) => j);
    this.legs = [0, ...skeleton.legs.flat()];
    this.turnOf = new Map(Array.from(skeleton.turning, (j, k) => [j, k]));
    this.turnAt = Int32Array.from({ length: 22 }, (_, j) => this.turnOf.get(j) ?? -1);
    this.inLeg = Uint8Array.from({ length: 22 }, (_, j) => (skeleton.legs.some((leg) => leg.includes(j)) ? 1 : 0));
  }

  // The body at a time in frames; feet are held where they bear on the floor, if asked for.
  pose({ course, track }, frame, holding) {
    const from = Math.floor(frame), feet = holding ? this.held(course, from, track) : null;
    this.unheld(course, frame, track, this.whole);
    this.put(course.bank.scale, track.at(frame), feet, frame - from);
  }

  // The same for somebody far away: the nearest recorded frame, feet as they were recorded, shorter steps by legs that
  // swing less.
  poseFarAway({ course, track }, frame) {
    const { bank, starts } = course, { parents, offsets } = this.skeleton, { places, turns, local, other } = this;
    const index = course.at(frame), number = course.number(index, frame), stride = course.strides[index];
    const join = index > 0 && frame - starts[index] < BLEND ? course.join(index) : null;
    const left = join && join.any ? fade(Math.max(frame - starts[index], 0)) : 0;
    for (let j = 0; j < 22; j += 1) {
      const k = this.turnAt[j], parent = parents[j];
      if (parent >= 0) turned(turns, 4 * parent, offsets, 3 * j, places, 3 * parent, places, 3 * j);
      else places.fill(0, 0, 3);
      if (k < 0) {
        for (let i = 0; i < 4; i += 1) turns[4 * j + i] = turns[4 * parent + i];
        continue;
      }
      bank.turn(number, k, local, 0);
      if (left) {
        exponential(left * join.turns[3 * k], left * join.turns[3 * k + 1], left * join.turns[3 * k + 2], other);
        multiply(local, 0, other, 0, local, 0);
      }
      if (stride < 0.999 && this.inLeg[j]) {
        const sign = local[3] < 0 ? -1 : 1;
        for (let i = 0; i < 3; i += 1) local[i] *= stride * sign;
        local[3] = 1 - stride + stride * sign * local[3];
        normalise(local, 0);
      }
      if (parent >= 0) multiply(turns, 4 * parent, local, 0, turns, 4 * j);
      else for (let i = 0; i < 4; i += 1) turns[i] = local[i];
    }
    this.height = bank.height(number) + (join ? left * join.height : 0);
    const [x, y, heading, z] = track.at(frame), { scale } = bank, carried = this.footing ? this.footing.carried([x, y, z]) : z;
    const c = Math.cos(heading), s = Math.sin(heading);
    local.set([0, 0, Math.sin(heading / 2), Math.cos(heading / 2)]);
    for (let j = 0; j < 22; j += 1) {
      const px = places[3 * j], py = places[3 * j + 1];
      places[3 * j] = scale * (c * px - s * py) + x;
      places[3 * j + 1] = scale * (s * px + c * py) + y;
      places[3 * j + 2] = scale * (places[3 * j + 2] + this.height) + carried;
      multiply(local, 0, turns, 4 * j, turns, 4 * j);
    }
  }

  // The pose seen from where the person faces, the pelvis at the origin.
  unheld(course, frame, track, joints) {
    const { bank, starts } = course, { parents, offsets } = this.skeleton, { places, turns, local, other } = this;
    const index = course.at(frame), whole = course.number(index, frame);
    const phase = Math.max(0, frame - starts[index]), share = course.moving[index] ? phase - Math.floor(phase) : 0;
    const next = share > 0 ? bank.later(whole, 1) : whole;
    const joins = [];
    let stride = course.strides[index], height = (1 - share) * bank.height(whole) + share * bank.height(next);
    for (let i = index; i > 0 && frame - starts[i] < BLEND; i -= 1) {
      if (frame < starts[i]) continue;
      const join = course.join(i), left = fade(frame - starts[i]);
      stride += left * join.stride;
      height += left * join.height;
      if (join.any) joins.push([join.turns, left]);
    }
    for (const j of joints) {
      const k = this.turnOf.get(j), parent = parents[j];
      if (parent >= 0) turned(turns, 4 * parent, offsets, 3 * j, places, 3 * parent, places, 3 * j);
      else places.fill(0, 0, 3);
      if (k === undefined) {
        for (let i = 0; i < 4; i += 1) turns[4 * j + i] = turns[4 * parent + i];
        continue;
      }
      bank.turn(whole, k, local, 0);
      if (share > 0) {
        bank.turn(next, k, other, 0);
        const same = local[0] * other[0] + local[1] * other[1] + local[2] * other[2] + local[3] * other[3] < 0 ? -1 : 1;
        for (let i = 0; i < 4; i += 1) local[i] += share * (same * other[i] - local[i]);
        normalise(local, 0);
      }
      if (joins.length) {
        let x = 0, y = 0, z = 0;
        for (const [away, left] of joins) {
          x += left * away[3 * k];
          y += left * away[3 * k + 1];
          z += left * away[3 * k + 2];
        }
        exponential(x, y, z, other);
        multiply(local, 0, other, 0, local, 0);
      }
      if (parent >= 0) multiply(turns, 4 * parent, local, 0, turns, 4 * j);
      else for (let i = 0; i < 4; i += 1) turns[i] = local[i];
    }
    this.height = height;
    this.bearingNumber = whole;
    if (Math.abs(stride - 1) > 1e-6) {
      const spin = Math.abs(track.at(frame + 1)[2] - track.at(frame - 1)[2]) * 0.5 * RATE;
      this.shorten(stride, Math.min(Math.max(stride, spin, 0), 1));
    }
  }

  // Feet are drawn in under the body by the share to which steps are shortened, and lifted less.
  shorten(stride, lively) {
    const { places, turns, local, other } = this, floor = this.skeleton.ankleHeight - this.height;
    for (const [hip, knee, ankle, toe] of this.skeleton.legs) {
      const a = 3 * ankle, q = 4 * ankle;
      const target = [places[a] * stride, places[a + 1], floor + lively * (places[a + 2] - floor)];
      const x = turns[q], y = turns[q + 1], z = turns[q + 2], w = turns[q + 3];
      const yaw = Math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
      local.set([0, 0, -Math.sin(yaw / 2), Math.cos(yaw / 2)]);
      multiply(local, 0, turns, q, other, 0);
      const sign = other[3] < 0 ? -1 : 1, sine = Math.hypot(other[0], other[1], other[2]);
      const scale = sine < 1e-9 ? 0 : (lively * sign * 2 * Math.atan2(sine, sign * other[3])) / sine;
      exponential(other[0] * scale, other[1] * scale, other[2] * scale, other);
      local[2] = -local[2];
      multiply(local, 0, other, 0, turns, q);
      this.bend(hip, knee, ankle, target);
      turned(turns, q, this.skeleton.offsets, 3 * toe, places, a, places, 3 * toe);
    }
  }

  // Two-bone inverse kinematics: the ankle is put where wanted, or as near as the leg reaches.
  bend(hip, knee, ankle, target) {
    const { places: p, turns } = this, { offsets } = this.skeleton;
    const h = 3 * hip, n = 3 * knee, a = 3 * ankle;
    const thigh = Math.abs(offsets[n + 2]), shank = Math.abs(offsets[a + 2]);
    const old = [p[a] - p[h], p[a + 1] - p[h + 1], p[a + 2] - p[h + 2]];
    const along = [target[0] - p[h], target[1] - p[h + 1], target[2] - p[h + 2]];
    const distance = Math.hypot(...along), way = Math.hypot(...old);
    const reach = Math.min(Math.max(distance, Math.abs(thigh - shank) + 1e-9), STRAIGHT * (thigh + shank));
    for (let i = 0; i < 3; i += 1) {
      along[i] /= distance;
      old[i] /= way;
    }
    const swing = shortest(old, along), bent = [0, 0, 0], q = 4 * hip;
    turned(swing, 0, [p[n] - p[h], p[n + 1] - p[h + 1], p[n + 2] - p[h + 2]], 0, ZERO, 0, bent, 0);
    // A straight leg bends to where the body faces.
    const ahead = [0, 0, 0];
    turned(turns, 0, [1, 0, 0], 0, ZERO, 0, ahead, 0);
    let dot = 0;
    for (let i = 0; i < 3; i += 1) {
      bent[i] += 0.02 * ahead[i];
      dot += bent[i] * along[i];
    }
    for (let i = 0; i < 3; i += 1) bent[i] -= dot * along[i];
    const length = Math.hypot(...bent) || 1;
    const cosine = Math.min(Math.max((thigh * thigh + reach * reach - shank * shank) / (2 * thigh * reach), -1), 1);
    const sine = Math.sqrt(1 - cosine * cosine), newKnee = [0, 0, 0], newAnkle = [0, 0, 0];
    for (let i = 0; i < 3; i += 1) {
      newKnee[i] = p[h + i] + thigh * (cosine * along[i] + (sine * bent[i]) / length);
      newAnkle[i] = p[h + i] + reach * along[i];
    }
    const upper = [p[n] - p[h], p[n + 1] - p[h + 1], p[n + 2] - p[h + 2]];
    const lower = [p[a] - p[n], p[a + 1] - p[n + 1], p[a + 2] - p[n + 2]];
    const newUpper = newKnee.map((value, i) => value - p[h + i]), newLower = newAnkle.map((value, i) => value - newKnee[i]);
    multiply(shortest(unit(upper), unit(newUpper)), 0, turns, q, turns, q);
    multiply(shortest(unit(lower), unit(newLower)), 0, turns, 4 * knee, turns, 4 * knee);
    p.set(newKnee, n);
    p.set(newAnkle, a);
  }

  // How far both feet are held away in this frame and the next one, from the past that matters.
  held(course, frame, track) {
    let feet = course.feet;
    if (!feet || frame < feet.frame - 1 || frame > feet.frame + BEFORE) {
      const first = Math.max(frame - BEFORE, Math.min(frame, Math.ceil(track.frames[0])));
      course.feet = feet = { frame: first, now: this.skeleton.legs.map(() => startingFoot()), before: null };
      this.observe(course, first, track, feet.now, true);
      feet.before = feet.now.map((each) => ({ ...each }));
    }
    while (feet.frame <= frame) {
      feet.before = feet.now.map((each) => ({ ...each, downs: each.downs.slice() }));
      feet.frame += 1;
      this.observe(course, feet.frame, track, feet.now, false);
    }
    return feet;
  }

  observe(course, frame, track, now, first) {
    this.unheld(course, frame, track, this.legs);
    const [x, y, heading] = track.at(frame), c = Math.cos(heading), s = Math.sin(heading), p = this.places;
    const scale = course.bank.scale;
    this.skeleton.legs.forEach(([, , ankle, toe], side) => {
      const at = (j) => [x / scale + c * p[3 * j] - s * p[3 * j + 1], y / scale + s * p[3 * j] + c * p[3 * j + 1]];
      follow(now[side], at(ankle), at(toe), course.bank.bearing(this.bearingNumber, side), first);
    });
  }

  // Onto the person's place in the world, feet held; the size of the body comes last.
  put(scale, where, feet, share) {
    const [x, y, heading, z] = where, { footing } = this, carried = (footing ? footing.carried([x, y, z]) : z) / scale;
    const { places: p, turns, local } = this, c = Math.cos(heading), s = Math.sin(heading);
    local.set([0, 0, Math.sin(heading / 2), Math.cos(heading / 2)]);
    for (let j = 0; j < 22; j += 1) {
      const px = p[3 * j], py = p[3 * j + 1];
      p[3 * j] = c * px - s * py + x / scale;
      p[3 * j + 1] = s * px + c * py + y / scale;
      p[3 * j + 2] += this.height + carried;
      multiply(local, 0, turns, 4 * j, turns, 4 * j);
    }
    this.skeleton.legs.forEach(([hip, knee, ankle, toe], side) => {
      const a = 3 * ankle, target = [p[a], p[a + 1], p[a + 2]];
      let landed = 0;
      if (feet) {
        const one = feet.before[side], two = feet.now[side], u = share;
        const mix = (key) => one[key] + u * (two[key] - one[key]);
        target[0] += mix("awayX");
        target[1] += mix("awayY");
        target[2] += mix("lift");
        landed = mix("landed");
      }
      const lowest = this.lowest(4 * ankle) + target[2] - this.floor(where, 4 * ankle, target, landed, scale);
      if (lowest < 0) target[2] -= lowest;
      else target[2] -= landed * lowest;
      if (feet || lowest < 0) {
        this.bend(hip, knee, ankle, target);
        turned(turns, 4 * ankle, this.skeleton.offsets, 3 * toe, p, a, p, 3 * toe);
      }
    });
    for (let k = 0; k < 66; k += 1) p[k] *= scale;
  }

  // The height of the floor under a foot: a foot over an edge is on the higher tread, a swinging one passes the edges.
  floor([x, y, , z], q, ankle, landed, scale) {
    if (!this.footing) return z / scale;
    const { heel, ball } = this.skeleton, out = [0, 0, 0], heights = [-Infinity, -Infinity];
    for (const end of [heel, ball]) {
      turned(this.turns, q, end, 0, ankle, 0, out, 0);
      this.footing.beneath([x, y, z], out[0] * scale, out[1] * scale).forEach((height, k) => {
        heights[k] = Math.max(heights[k], height / scale);
      });
    }
    return heights[1] + landed * (heights[0] - heights[1]);
  }

  // Of heel and ball, below the ankle.
  lowest(q) {
    const out = [0, 0, 0], { heel, ball } = this.skeleton;
    turned(this.turns, q, heel, 0, ZERO, 0, out, 0);
    const low = out[2];
    turned(this.turns, q, ball, 0, ZERO, 0, out, 0);
    return Math.min(low, out[2]);
  }
}

function unit(v) {
  const length = Math.hypot(...v) || 1;
  return v.map((each) => each / length);
}

function shortest(a, b) {
  const q = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
    1 + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]];
  if (q[3] < 1e-12) return [0, 0, 1, 0];
  normalise(q, 0);
  return q;
}

function startingFoot() {
  return { awayX: 0, awayY: 0, lift: 0, leftX: 0, leftY: 0, since: STEP_FRAMES, steps: false, landed: 0, downs: [],
    ankle: null, toe: null, bearing: 0 };
}

// A foot one frame on: it stays where it bears on the floor, is led back while it swings, and takes
// a step where it would be held too far away. See feet.py.
function follow(foot, ankle, toe, bearing, first) {
  let stepping = false;
  const both = foot.bearing & bearing;
  if (!first && !foot.steps && both) {
    const [now, before] = both & 2 ? [toe, foot.toe] : [ankle, foot.ankle];
    foot.since = 0;
    foot.awayX -= now[0] - before[0];
    foot.awayY -= now[1] - before[1];
    foot.lift = 0;
    if (Math.hypot(foot.awayX, foot.awayY) > FARTHEST) {
      foot.steps = true;
      foot.leftX = foot.awayX;
      foot.leftY = foot.awayY;
    }
  } else if (!first) {
    if (!foot.steps && foot.since === 0) {
      foot.leftX = foot.awayX;
      foot.leftY = foot.awayY;
    }
    foot.since = Math.min(foot.since + 1, STEP_FRAMES);
    const u = foot.since / STEP_FRAMES, rest = 1 - u * u * (3 - 2 * u);
    foot.awayX = rest * foot.leftX;
    foot.awayY = rest * foot.leftY;
    foot.lift = foot.steps ? STEP_LIFT * Math.sin(Math.PI * u) : 0;
    stepping = foot.steps;
    if (foot.since === STEP_FRAMES) foot.steps = false;
  }
  Object.assign(foot, { ankle, toe, bearing });
  const down = bearing && !stepping ? 1 : 0;
  if (!foot.downs.length) foot.downs = new Array(LANDING).fill(down);
  foot.downs = [...foot.downs.slice(1), down];
  foot.landed = foot.downs.reduce((sum, each) => sum + each, 0) / LANDING;
}
