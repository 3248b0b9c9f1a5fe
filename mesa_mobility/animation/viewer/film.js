// A film of the run, picture by picture, for the program that asks for it: see animation/film_bodies.py.
"use strict";

const CAPTION = 15, SHARP = 2; // pixels; pixels drawn for each one of the picture, along a side
const REACH = 1.2, HIGHEST = 2.3; // metres: how far round their place people, what they hold and their shadows may be

// asked: {frames, width, height, path, glass, colour}.
async function film(asked) {
  const { stage } = state, { width, height } = asked, sheet = Object.assign(document.createElement("canvas"), { width, height });
  // In memory: without a graphics card that is where all pixels are.
  const ctx = sheet.getContext("2d", { alpha: false, willReadFrequently: true });
  play(false);
  // The page itself need not be drawn.
  element("view").style.cssText = `position: fixed; inset: auto; left: 0; top: 0; width: ${width}px; height: ${height}px`;
  document.body.style.visibility = "hidden";
  element("camera").value = "orbit";
  element("colour").value = asked.colour;
  Object.assign(stage, { still: true, sharp: SHARP });
  stage.resize(true);
  stage.fit();
  stage.scenery.setGlassy(asked.glass);
  if (asked.path) {
    state.path.read(JSON.stringify(asked.path));
    state.along = true;
  }
  const gl = stage.renderer.getContext(), image = new ImageData(width, height), whole = [0, 0, width, height];
  stage.renderer.setScissorTest(true);
  let sent = null, before = whole;
  for (const [number, frame] of asked.frames.entries()) {
    state.frame = frame;
    const people = shown(), now = asked.path ? whole : crowded(stage, people, frame, whole), part = around(before, now);
    before = now;
    colour(people);
    stage.renderer.setScissor(...part);
    drawStage(people, mapNow());
    read(gl, part, image);
    ctx.putImageData(image, 0, 0);
    caption(ctx, `${(frame / RATE).toFixed(1)} s, ${people.length} people`);
    const { data } = ctx.getImageData(0, 0, width, height);
    await sent;
    sent = fetch(`picture/${number}`, { method: "POST", body: data });
  }
}

// The part of the picture in which people are, while the camera stands: [left, lower edge, width, height] from below.
function crowded({ perspective: camera }, people, frame, [, , width, height]) {
  const xs = [], ys = [], corner = new THREE.Vector3();
  camera.updateMatrixWorld();
  for (const { track } of people) {
    const [x, y, , z] = track.at(frame);
    for (let k = 0; k < 8; k += 1) {
      corner.set(x + (k & 1 ? REACH : -REACH), y + (k & 2 ? REACH : -REACH), z + (k & 4 ? HIGHEST : 0)).project(camera);
      // What is beside or behind the camera may be anywhere.
      if (Math.abs(corner.z) > 1) return [0, 0, width, height];
      xs.push(((corner.x + 1) / 2) * width);
      ys.push(((corner.y + 1) / 2) * height);
    }
  }
  if (!xs.length) return [0, 0, 0, 0];
  const within = (value, most) => Math.min(Math.max(value, 0), most);
  const left = within(Math.floor(Math.min(...xs)), width), low = within(Math.floor(Math.min(...ys)), height);
  return [left, low, within(Math.ceil(Math.max(...xs)), width) - left, within(Math.ceil(Math.max(...ys)), height) - low];
}

// The smallest rectangle round two.
function around(a, b) {
  if (!a[2] || !a[3]) return b;
  if (!b[2] || !b[3]) return a;
  const [x, y] = [0, 1].map((k) => Math.min(a[k], b[k]));
  return [x, y, Math.max(a[0] + a[2], b[0] + b[2]) - x, Math.max(a[1] + a[3], b[1] + b[3]) - y];
}

// Puts a part of what is drawn into an image, whose rows go downwards: of SHARP x SHARP pixels the mean.
function read(gl, [left, low, wide, high], { data, width, height }) {
  if (!wide || !high) return;
  const row = 4 * SHARP * wide, drawn = new Uint8Array(row * SHARP * high);
  gl.readPixels(SHARP * left, SHARP * low, SHARP * wide, SHARP * high, gl.RGBA, gl.UNSIGNED_BYTE, drawn);
  for (let y = 0; y < high; y += 1) {
    let to = 4 * (width * (height - 1 - low - y) + left), from = SHARP * y * row;
    for (let x = 0; x < wide; x += 1, to += 4, from += 4 * SHARP) {
      for (let k = 0; k < 4; k += 1) {
        let sum = 0;
        for (let j = from + k; j < from + SHARP * row; j += row) for (let i = j; i < j + 4 * SHARP; i += 4) sum += drawn[i];
        data[to + k] = sum / (SHARP * SHARP);
      }
    }
  }
}

function caption(ctx, text) {
  ctx.font = `${CAPTION}px sans-serif`;
  ctx.fillStyle = "rgba(255, 255, 255, 0.8)";
  ctx.fillRect(8, 8, ctx.measureText(text).width + 12, CAPTION + 9);
  ctx.fillStyle = "#222";
  ctx.fillText(text, 14, 11 + CAPTION);
}
