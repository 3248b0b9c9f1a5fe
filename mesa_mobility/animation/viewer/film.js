// A film of the run, picture by picture, for the program that asks for it: see animation/film_bodies.py.
"use strict";

const CAPTION = 15, SHARP = 2; // pixels; pixels drawn for each one of the picture, along a side

// asked: {frames, width, height, type, quality, path, glass, colour}.
async function film(asked) {
  const { stage } = state, { width, height } = asked, sheet = Object.assign(document.createElement("canvas"), { width, height });
  const ctx = sheet.getContext("2d", { alpha: false });
  play(false);
  element("view").style.cssText = `position: fixed; inset: auto; left: 0; top: 0; width: ${width}px; height: ${height}px`;
  element("camera").value = "orbit";
  element("colour").value = asked.colour;
  Object.assign(stage, { detail: 0, sharp: SHARP });
  stage.resize(true);
  stage.fit();
  stage.scenery.setGlassy(asked.glass);
  if (asked.path) {
    state.path.read(JSON.stringify(asked.path));
    state.along = true;
  }
  for (const [number, frame] of asked.frames.entries()) {
    state.frame = frame;
    draw();
    ctx.drawImage(stage.canvas, 0, 0, width, height);
    caption(ctx, `${(frame / RATE).toFixed(1)} s, ${present().length} people`);
    const picture = await new Promise((done) => sheet.toBlob(done, asked.type, asked.quality));
    await fetch(`picture/${number}`, { method: "POST", body: picture });
  }
}

function caption(ctx, text) {
  ctx.font = `${CAPTION}px sans-serif`;
  ctx.fillStyle = "rgba(255, 255, 255, 0.8)";
  ctx.fillRect(8, 8, ctx.measureText(text).width + 12, CAPTION + 9);
  ctx.fillStyle = "#222";
  ctx.fillText(text, 14, 11 + CAPTION);
}
