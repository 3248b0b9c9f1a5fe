// The map on the floor, the legends, and the scale of the plan.
"use strict";

const FASTEST = 1.8, SPAN = 15; // m/s of the dark end of the colours; frames over which a speed is taken
const MAP_EVERY = 10; // frames between two maps
const SPEEDS = { label: "speed, m/s", low: FASTEST, high: 0, names: [] };

function colour(people) {
  const how = element("colour").value, legend = legendOfPeople();
  for (const person of people) {
    person.value = how === "speed" ? speedOf(person) : person.kind;
    person.colour = how === "clothes" ? null : channelsOf(person.value, legend);
  }
}

function speedOf({ first, last, track }) {
  const end = Math.min(state.frame + SPAN, last), begin = Math.max(Math.min(state.frame, end - SPAN), first);
  const a = track.at(begin), b = track.at(end);
  return end > begin ? (Math.hypot(b[0] - a[0], b[1] - a[1]) * RATE) / (end - begin) : 0;
}

function legendOfPeople() {
  return element("colour").value === "speed" ? SPEEDS : { label: "type", low: 0, high: 1, names: state.run.header.types };
}

// The storey whose floor the plan and the map show: of a building the topmost that is not hidden.
function storeyShown() {
  const storeys = state.run.header.floor.storeys;
  if (!storeys) return { ...state.run.header.floor, elevation: 0 };
  return storeys.filter(({ elevation }) => elevation < state.below - CUT_ROUNDED).pop() || storeys[0];
}

function peopleOn({ elevation }) {
  const { storeys } = state.run.header.floor;
  if (!storeys) return present();
  const next = storeys.find((each) => each.elevation > elevation);
  return present().filter(({ track }) => {
    const z = track.at(state.frame)[3];
    return z >= elevation - CUT_ROUNDED && (!next || z < next.elevation - CUT_ROUNDED);
  });
}

// The map of the storey at the time: {pixels, grid}, or null; the same object as long as nothing changes.
function mapNow() {
  const kind = element("layer").value;
  if (!kind) return (state.map = null);
  const storey = storeyShown(), when = Math.floor(state.frame / MAP_EVERY), key = `${kind} ${storey.elevation} ${when}`;
  if (state.map && state.map.key === key) return state.map;
  const grid = gridOf(storey), limits = state.run.header.service;
  let values, most = 1;
  if (kind === "usage") {
    const usage = usageOf(storey, grid);
    values = usage.until(state.frame);
    most = usage.most;
  } else values = grid.densities(placesOn(storey));
  return (state.map = { key, grid, most, pixels: paintedCells(kind, values, limits, most) });
}

function gridOf(storey) {
  state.grids ||= new Map();
  if (!state.grids.has(storey.elevation)) state.grids.set(storey.elevation, new FloorGrid(storey.free));
  return state.grids.get(storey.elevation);
}

// Places of the people on a storey, without those who are over the line of their exit.
function placesOn(storey) {
  return peopleOn(storey).filter((each) => !leaves(each, state.frame)).flatMap(({ track }) => {
    const [x, y, , z] = track.at(state.frame);
    return Math.abs(z - storey.elevation) < 0.05 ? [x, y] : [];
  });
}

const leaves = ({ last, out }, frame) => out && Math.floor(frame) >= last;

function usageOf(storey, grid) {
  state.usages ||= new Map();
  const known = state.usages.get(storey.elevation);
  if (known) return known;
  const visits = [], seen = new Int32Array(grid.cells.length).fill(-1);
  state.people.forEach((person, k) => {
    const { track, first, last } = person;
    for (let frame = first; frame <= last; frame += 1) {
      const [x, y, , z] = track.at(frame), cell = grid.cellAt(x, y);
      if (cell < 0 || seen[cell] === k || leaves(person, frame) || Math.abs(z - storey.elevation) >= 0.05) continue;
      seen[cell] = k;
      visits.push([frame, cell]);
    }
  });
  const found = new Usage(visits, grid.cells.length);
  found.most = Math.max(1, ...found.until(Infinity));
  state.usages.set(storey.elevation, found);
  return found;
}

function showLegends() {
  const kind = element("layer").value, key = [element("colour").value, kind, state.map && state.map.most].join(" ");
  if (state.legends === key) return;
  state.legends = key;
  const legends = element("colour").value === "clothes" ? [] : [legendOfPeople()];
  if (kind) legends.push(LAYERS[kind].legend(state.run.header.service, state.map ? state.map.most : 1));
  element("legend").replaceChildren(...legends.map(drawnLegend));
  element("legend").hidden = !legends.length;
}

function drawnLegend({ label, low, high, names, steps }) {
  const made = document.createElement("div"), add = (parent, name, text, style = "") => {
    const part = document.createElement("div");
    Object.assign(part, { className: name, textContent: text });
    part.style.cssText = style;
    parent.appendChild(part);
    return part;
  };
  add(made, "", label);
  if (steps) {
    const row = add(made, "steps", "");
    for (const { name, colour: shade, text } of steps) {
      const part = document.createElement("span");
      part.textContent = `${name} ${text}`;
      part.style.background = shade;
      part.style.color = brightness(shade) > 0.45 || Number(shade.split(",")[3].slice(0, -1)) < 0.5 ? "#222" : "#fff";
      row.appendChild(part);
    }
  } else if (names.length) {
    names.forEach((name, k) => {
      const row = add(made, "kind", "");
      row.appendChild(document.createElement("i")).style.background = TYPES[k % TYPES.length];
      row.append(name.replaceAll("_", " "));
    });
  } else {
    add(made, "bar", "", `background: linear-gradient(to right, ${HEAT.join(", ")})`);
    const ends = add(made, "ends", ""), end = (value, other) => (value > other ? `${value} or more` : `${value}`);
    for (const text of [end(low, high), end(high, low)]) ends.appendChild(document.createElement("span")).textContent = text;
  }
  return made;
}

function showScale() {
  const [metres, long] = state.plan.scaleBar(), key = `${metres} ${long}`;
  if (state.scale === key) return;
  state.scale = key;
  element("scale").firstElementChild.textContent = `${metres} m`;
  element("scale").lastElementChild.style.width = `${long}px`;
}
