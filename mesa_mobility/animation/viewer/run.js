// People of a run, and what they have decided.
"use strict";

function cumulated(values, from, count, step = 1) {
  const found = new Float32Array(count);
  let sum = 0;
  for (let k = 0; k < count; k += 1) {
    sum += values[from + k];
    found[k] = sum * step;
  }
  return found;
}

function peopleOf({ header, arrays }) {
  const { steps } = header, banks = header.scales.map((scale, k) => bankOf({ header, arrays }, `bank${k}`, scale));
  const part = (name, k, from, count, step) => cumulated(arrays[`${name}.${k}`], from, count, step);
  const raw = (name, k, from, count) => arrays[`${name}.${k}`].subarray(from, from + count);
  const found = [], rows = arrays.people;
  let t = 0, c = 0, d = 0;
  for (let k = 0; k < rows.length; k += 7) {
    const [row, places, pieces, decisions, kind, bank, left] = rows.subarray(k, k + 7);
    const track = new Track(part("tracks", 0, t, places), part("tracks", 1, t, places, steps.place),
      part("tracks", 2, t, places, steps.place), part("tracks", 3, t, places, steps.turn),
      arrays["tracks.4"] ? part("tracks", 4, t, places, steps.place) : null);
    let course = null;
    if (bank >= 0 && pieces) {
      course = new Course(banks[bank]);
      course.starts = part("courses", 0, c, pieces);
      course.numbers = raw("courses", 1, c, pieces);
      course.moving = raw("courses", 2, c, pieces);
      course.strides = Float32Array.from(raw("courses", 3, c, pieces), (each) => each / 1000);
      course.own = raw("courses", 4, c, pieces);
    }
    found.push({ row, kind, bank, track, course, aid: header.aids[kind] || "", colour: null, first: track.frames[0],
      last: track.frames[places - 1], out: left === 1, decided: { frames: part("decisions", 0, d, decisions),
        options: raw("decisions", 1, d, decisions), shares: raw("decisions", 2, d, decisions) } });
    t += places;
    c += pieces;
    d += decisions;
  }
  return found;
}

// What the chosen person is doing, from the run's record of decisions.
function why() {
  const person = state.people.find((each) => each.row === chosen());
  if (!person) return "";
  if (person.first > state.frame) return `person ${person.row} is not there yet`;
  if (person.last < state.frame) return `person ${person.row} has left`;
  if (!state.run.header.decided) return `person ${person.row}: the run has no record of decisions`;
  const { frames, options, shares } = person.decided;
  let k = frames.length - 1;
  while (k >= 0 && frames[k] > state.frame) k -= 1;
  if (k < 0) return `person ${person.row}: has not decided yet`;
  const at = (frame) => `${(frame / RATE).toFixed(2)} s`;
  const until = k + 1 < frames.length ? ` until ${at(frames[k + 1])}` : "";
  const told = [`person ${person.row}, decision ${k + 1} of ${frames.length}, taken at ${at(frames[k])}${until}`];
  const others = `why not another: mesa-mobility explain RUN_DIR --person ${person.row} --time ${(frames[k] / RATE).toFixed(2)}`;
  if (options[k] < 0) return [...told, "no option was free: it moves straight towards its target", others].join("\n");
  const share = shares[k] * state.run.header.steps.share;
  told.push(`option ${options[k]} of its map${share < 0.9995 ? `, shortened to ${(100 * share).toFixed(0)} % of its ground` : ""}`);
  if (person.course) {
    const i = person.course.at(state.frame), number = person.course.number(i, state.frame), { clips } = person.course.bank;
    if (person.course.own[i] === k && person.course.moving[i]) {
      let clip = 0;
      while (clips[clip + 1] <= number >> 1) clip += 1;
      told.push(`recorded in ${state.run.header.clips[person.bank][clip]}, ${at((number >> 1) - clips[clip])}${number & 1 ? ", mirrored" : ""}`);
    }
  }
  return [...told, others].join("\n");
}
