// What all canvases of the page share; see canvases.py.

// Numbers of a kind from base64.
function numbers(text, kind = Float32Array) {
  // A loop: `Uint8Array.from` with a function takes thirty times as long.
  const bytes = atob(text), values = new Uint8Array(bytes.length);
  for (let k = 0; k < bytes.length; k += 1) values[k] = bytes.charCodeAt(k);
  return new kind(values.buffer);
}

// Lines of an SVG for the joints of a pose: 0 from the side, x forwards; 1 from the front.
function stickFigure(pose, pairs, axis, colours) {
  if (!pose) return [];
  return pairs.map(([a, b], k) => ({
    x1: pose[a][axis], y1: -pose[a][2], x2: pose[b][axis], y2: -pose[b][2],
    stroke: k < 3 ? colours.left : k < 6 ? colours.right : colours.text, "stroke-width": 0.03,
    "stroke-linecap": "round" }));
}

function pixelRatio() {
  return window.devicePixelRatio || 1;
}

// Many small pictures are slow where a graphics card is only stood in for; they are quick without.
function drawnByProcessor(canvas) { return canvas.getContext("2d", { willReadFrequently: true }); }

// Gives canvases a size in pixels of the screen; tells whether it was another one.
function resizeTo(canvases, width, height) {
  if (canvases.every((canvas) => canvas.width === width && canvas.height === height)) return false;
  for (const canvas of canvases) Object.assign(canvas, { width, height });
  return true;
}

// A plate behind a text, so that it can be read whatever it lies on.
function plate(ctx, x, y, width, height, colours) {
  const fill = ctx.fillStyle;
  ctx.fillStyle = colours.plate;
  ctx.fillRect(x, y, width, height);
  ctx.fillStyle = fill;
}

function savePicture(canvas, name) {
  canvas.toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

function saveText(text, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A file of the reader's choice.
function readText(take) {
  const input = document.createElement("input");
  input.type = "file";
  input.onchange = async () => take(await input.files[0].text());
  input.click();
}
