// Plays the run in the page, with nothing from the network.
"use strict";

const element = (id) => document.getElementById(id);
const PAPER = { ground: "#d9d9d4", free: "#f5f5f2", wall: "#9a9a97" };
const SCALE = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"].map(channels);
const KINDS_OF_PEOPLE = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#999999", "#5b3a93", "#8c510a",
  "#b5a300", "#00a6a6", "#b2182b"].map(channels);
const FASTEST = 1.8, SPAN = 15; // m/s of the scale's last colour; frames over which a speed is taken
const state = { frame: 0, playing: true, people: [], run: null, stage: null, below: Infinity };

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
  for (let k = 0; k < rows.length; k += 6) {
    const [row, places, pieces, decisions, kind, bank] = rows.subarray(k, k + 6);
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
    found.push({ row, kind, bank, track, course, aid: header.aids[kind] || "", colour: [0.5, 0.5, 0.5], first: track.frames[0],
      last: track.frames[places - 1], decided: { frames: part("decisions", 0, d, decisions),
        options: raw("decisions", 1, d, decisions), shares: raw("decisions", 2, d, decisions) } });
    t += places;
    c += pieces;
    d += decisions;
  }
  return found;
}

function present() {
  return state.people.filter((each) => each.first <= state.frame && state.frame <= each.last);
}

// Those on the storeys that are shown.
function shown() {
  return present().filter(({ track }) => track.at(state.frame)[3] < state.below - CUT_ROUNDED);
}

function colour(people) {
  const byKind = element("colour").value === "type";
  for (const person of people) {
    if (byKind) {
      person.colour = KINDS_OF_PEOPLE[person.kind % KINDS_OF_PEOPLE.length];
      continue;
    }
    const end = Math.min(state.frame + SPAN, person.last), begin = Math.max(Math.min(state.frame, end - SPAN), person.first);
    const a = person.track.at(begin), b = person.track.at(end);
    const speed = end > begin ? (Math.hypot(b[0] - a[0], b[1] - a[1]) * RATE) / (end - begin) : 0;
    person.colour = SCALE[Math.round(Math.min(speed / FASTEST, 1) * (SCALE.length - 1))];
  }
}

function chosen() { return Number(element("person").value); }

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

function draw() {
  const people = shown();
  colour(people);
  state.stage.draw(people, state.frame, chosen());
  element("time").value = state.frame / RATE;
  element("said").textContent = `${(state.frame / RATE).toFixed(2)} of ${(state.last / RATE).toFixed(1)} s, ${people.length} there`;
  element("why").textContent = why();
}

function play(on) {
  state.playing = on;
  element("play").textContent = on ? "Pause" : "Play";
}

function show(frame) {
  play(false);
  state.frame = Math.min(Math.max(frame, state.first), state.last);
  draw();
}

const step = (frames) => show(Math.round(state.frame) + frames);

function decision(by) {
  const person = state.people.find((each) => each.row === chosen());
  if (!person) return;
  const frames = Array.from(person.decided.frames);
  const next = by > 0 ? frames.find((each) => each > state.frame + 1e-6) : frames.reverse().find((each) => each < state.frame - 1e-6);
  if (next !== undefined) show(next);
}

function listen() {
  const keys = { " ": () => play(!state.playing), ArrowLeft: () => step(-1), ArrowRight: () => step(1),
    PageUp: () => decision(-1), PageDown: () => decision(1) };
  element("play").onclick = keys[" "];
  element("back").onclick = keys.ArrowLeft;
  element("on").onclick = keys.ArrowRight;
  element("earlier").onclick = keys.PageUp;
  element("later").onclick = keys.PageDown;
  element("time").oninput = () => show(Number(element("time").value) * RATE);
  element("camera").onchange = () => {
    // Somebody has to be followed.
    if (["follow", "eyes"].includes(element("camera").value) && chosen() < 0 && present().length) {
      element("person").value = present()[0].row;
    }
    state.stage.look(element("camera").value);
  };
  element("storey").onchange = () => {
    state.below = Number(element("storey").value);
    state.stage.scenery.cut(state.below);
  };
  window.addEventListener("keydown", (event) => {
    if (["SELECT", "BUTTON"].includes(event.target.tagName) || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
  let down = null;
  const canvas = state.stage.canvas;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("click", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    element("person").value = state.stage.personAt(event.clientX, event.clientY, shown(), state.frame);
  });
}

function offerStoreys(storeys) {
  const cuts = storeyCuts(storeys);
  element("storeys").hidden = !cuts.length;
  for (const { name, below } of cuts) element("storey").add(new Option(`up to ${name}`, below));
}

async function open() {
  state.run = await unbundle(CONTENT);
  const { header } = state.run;
  state.people = peopleOf(state.run);
  Object.assign(state, { first: header.first, last: header.last, frame: header.first });
  state.stage = new Stage(element("view"), figureOf(state.run));
  state.stage.setFloor(header.floor, PAPER);
  Object.assign(element("time"), { min: state.first / RATE, max: state.last / RATE });
  for (const { row } of state.people) element("person").add(new Option(row));
  offerStoreys(header.floor.storeys || []);
  if (header.types.length < 2) element("colour").remove(1);
  listen();
  let before = performance.now();
  const loop = (now) => {
    const passed = Math.max(0, now - before) / 1000;
    before = now;
    requestAnimationFrame(loop);
    if (state.playing) {
      state.frame += passed * RATE * Number(element("speed").value);
      if (state.frame > state.last) state.frame = state.first;
      state.stage.adapt(passed);
    }
    draw();
  };
  requestAnimationFrame(loop);
  document.body.dataset.ready = "yes";
}

open().catch((error) => { element("said").textContent = `cannot be shown: ${error.message}`; });
