// Plays the run in the page, with nothing from the network.
"use strict";

const element = (id) => document.getElementById(id);
const ASKED = null; // the film that a program asks for
const AWAKE = 600, SETTLED = 250; // milliseconds
const PAPER = { ground: "#d9d9d4", free: "#f5f5f2" };
const state = { frame: 0, playing: true, people: [], run: null, stage: null, plan: null, curves: null, below: Infinity,
  until: 0, drawn: 0, still: false, path: new CameraPath(), along: false };

const inPlan = () => element("camera").value === "plan";
const chosen = () => Number(element("person").value);
const pressed = (id) => element(id).getAttribute("aria-pressed") === "true";

function present() {
  return state.people.filter((each) => each.first <= state.frame && state.frame <= each.last);
}

// Those on the storeys that are shown.
function shown() {
  return present().filter(({ track }) => track.at(state.frame)[3] < state.below - CUT_ROUNDED);
}

// A picture at which somebody looks for a while has all its detail.
function draw(still = false) {
  Object.assign(state, { still, drawn: performance.now() });
  if (state.stage) state.stage.still = still;
  const people = inPlan() ? peopleOn(storeyShown()) : shown(), map = mapNow();
  colour(people);
  if (inPlan()) drawPlan(people, map);
  else drawStage(people, map);
  const seconds = state.frame / RATE;
  element("time").value = seconds;
  tell("said", `${seconds.toFixed(2)} of ${(state.last / RATE).toFixed(1)} s, ${people.length} there`);
  tell("why", why());
  if (pressed("charted")) drawCurves(seconds);
  showLegends();
}

// A text that is written anew is laid out anew, even if it is the same.
function tell(id, text) {
  if (element(id).textContent !== text) element(id).textContent = text;
}

function drawPlan(people, map) {
  const rows = new Float32Array(FIELDS * people.length), byClothes = element("colour").value === "clothes";
  people.forEach(({ row, track, value }, k) => {
    const [x, y, heading] = track.at(state.frame);
    rows.set([row, x, y, heading, byClothes ? 0 : value, 0], FIELDS * k);
  });
  state.plan.selected = chosen();
  state.plan.draw({ people: rows, legend: legendOfPeople() }, map);
  showScale();
}

function drawStage(people, map) {
  if (map !== state.mapped) state.stage.scenery.setLayer(map, storeyShown());
  state.mapped = map;
  if (state.along && state.path.views.length && element("camera").value === "orbit") {
    const { eye, target } = state.path.at(state.frame);
    state.stage.lookFrom(eye, target);
  }
  state.stage.draw(people, state.frame, chosen());
}

function drawCurves(seconds) {
  state.curves.draw(seconds);
  const told = state.curves.told(seconds), key = JSON.stringify(told);
  if (state.passed === key) return;
  state.passed = key;
  element("passed").replaceChildren(...told.map(({ name, colour: own, passed }) => {
    const row = document.createElement("div"), number = document.createElement("b");
    row.appendChild(document.createElement("i")).style.background = own;
    number.textContent = passed;
    row.append(number, name);
    return row;
  }));
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

function look() {
  // Somebody has to be followed.
  if (["follow", "eyes"].includes(element("camera").value) && chosen() < 0 && present().length) {
    element("person").value = present()[0].row;
  }
  element("view").hidden = inPlan();
  element("plan").hidden = element("scale").hidden = !inPlan();
  if (inPlan()) {
    showFloor();
    state.plan.resize();
  } else state.stage.look(element("camera").value);
}

// The floor of the storey that the plan shows.
function showFloor() {
  const storey = storeyShown(), flights = (state.run.header.floor.flights || [])
    .filter(({ top, bottom }) => [top, bottom].some((each) => Math.abs(each - storey.elevation) < 0.01));
  state.plan.setFloor({ bounds: state.run.header.floor.bounds, ...storey }, flights);
}

function fill() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}

// What somebody does is drawn for a moment; a page that stands still takes no time.
function wake() { state.until = performance.now() + AWAKE; }

function listen() {
  for (const name of ["pointerdown", "pointermove", "wheel", "keydown", "change", "input", "click", "resize"]) {
    window.addEventListener(name, wake, { capture: true, passive: true });
  }
  wake();
  const keys = { " ": () => play(!state.playing), ArrowLeft: () => step(-1), ArrowRight: () => step(1),
    PageUp: () => decision(-1), PageDown: () => decision(1), f: fill };
  element("play").onclick = keys[" "];
  element("back").onclick = keys.ArrowLeft;
  element("on").onclick = keys.ArrowRight;
  element("earlier").onclick = keys.PageUp;
  element("later").onclick = keys.PageDown;
  element("full").onclick = fill;
  element("time").oninput = () => show(Number(element("time").value) * RATE);
  element("camera").onchange = look;
  element("storey").onchange = () => {
    state.below = Number(element("storey").value);
    if (state.stage) state.stage.scenery.cut(state.below);
    showFloor();
  };
  fold("charted", ["curves", "passed"]);
  fold("folded", ["panel"]);
  listenToPath();
  window.addEventListener("keydown", (event) => {
    if (["SELECT", "BUTTON"].includes(event.target.tagName) || event.ctrlKey || event.metaKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
  const scrub = (event) => { if (event.buttons & 1) show(state.curves.at(event.clientX) * RATE); };
  element("curves").addEventListener("pointerdown", scrub);
  element("curves").addEventListener("pointermove", scrub);
  if (state.stage) listenToStage();
}

function listenToStage() {
  element("walls").onchange = () => state.stage.scenery.setGlassy(element("walls").value === "glass");
  let down = null;
  const canvas = state.stage.canvas;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("click", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    element("person").value = state.stage.personAt(event.clientX, event.clientY, shown(), state.frame);
  });
}

function fold(button, parts) {
  element(button).onclick = () => {
    const on = !pressed(button);
    element(button).setAttribute("aria-pressed", String(on));
    for (const part of parts) element(part).hidden = !on;
  };
}

function listenToPath() {
  const { path } = state, tell = (text = "") => {
    const views = path.views.map(({ frame }) => `${(frame / RATE).toFixed(1)} s`).join(", ");
    element("path").textContent = text || (views ? `views at ${views}` : "");
  };
  const go = (on) => {
    state.along = on;
    element("along").setAttribute("aria-pressed", String(on));
  };
  element("add").onclick = () => {
    path.add(state.frame, state.stage.perspective.position.toArray(), state.stage.orbit.target.toArray());
    tell();
  };
  element("clear").onclick = () => {
    path.clear();
    go(false);
    tell();
  };
  element("along").onclick = () => go(!state.along && path.views.length > 0);
  element("save").onclick = () => saveText(path.text(), "camera_path.json");
  element("load").onclick = () => readText((text) => {
    try {
      path.read(text);
      tell();
    } catch (error) { tell(`no camera path: ${error.message}`); }
  });
}

function clickPlan([x, y], reach) {
  let near = reach, who = -1;
  for (const { row, track } of peopleOn(storeyShown())) {
    const [px, py] = track.at(state.frame), away = Math.hypot(px - x, py - y);
    if (away < near) [near, who] = [away, row];
  }
  element("person").value = who;
}

function offerStoreys(storeys) {
  const cuts = storeyCuts(storeys);
  element("storeys").hidden = !cuts.length;
  for (const { name, below } of cuts) element("storey").add(new Option(`up to ${name}`, below));
}

// Where a browser draws nothing in three dimensions, the plan is left.
function stageOrNone({ floor }) {
  try {
    const stage = new Stage(element("view"), figureOf(state.run));
    stage.setFloor(floor, PAPER);
    return stage;
  } catch (error) {
    if (ASKED) throw error;
    element("flat").hidden = false;
    element("camera").value = "plan";
    for (const part of ["camera", "walls", "add", "along", "load"]) element(part).disabled = true;
    return null;
  }
}

async function open() {
  state.run = await unbundle(CONTENT);
  const { header } = state.run;
  state.people = peopleOf(state.run);
  Object.assign(state, { first: header.first, last: header.last, frame: header.first });
  state.stage = stageOrNone(header);
  state.plan = new PlanView(element("plan"), { click: clickPlan });
  state.curves = new Curves(element("curves"), header.doors, state.first / RATE, state.last / RATE);
  Object.assign(element("time"), { min: state.first / RATE, max: state.last / RATE });
  for (const { row } of state.people) element("person").add(new Option(row));
  offerStoreys(header.floor.storeys || []);
  if (header.types.length < 2) element("colour").remove(2);
  listen();
  if (!state.stage) look();
  if (ASKED) {
    await film(ASKED);
    return;
  }
  let before = performance.now();
  const loop = (now) => {
    const passed = Math.max(0, now - before) / 1000;
    before = now;
    requestAnimationFrame(loop);
    if (state.playing) {
      state.frame += passed * RATE * Number(element("speed").value);
      if (state.frame > state.last) state.frame = state.first;
      if (!inPlan()) state.stage.adapt(passed);
    }
    if (state.playing || now < state.until) draw();
    else if (!state.still && now - state.drawn > SETTLED) draw(true);
  };
  requestAnimationFrame(loop);
  document.body.dataset.ready = "yes";
}

open().catch((error) => { element("said").textContent = `cannot be shown: ${error.message}`; });
