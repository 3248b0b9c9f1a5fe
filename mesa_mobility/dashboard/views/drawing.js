// What all canvases of the page share; see canvases.py.

function numbers(text) {
  // A loop: `Uint8Array.from` with a function takes thirty times as long.
  const bytes = atob(text), values = new Uint8Array(bytes.length);
  for (let k = 0; k < bytes.length; k += 1) values[k] = bytes.charCodeAt(k);
  return new Float32Array(values.buffer);
}

function blend(colours, share) {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const k = Math.min(Math.floor(at), colours.length - 2), u = at - k;
  const part = (i, p) => parseInt(colours[i].slice(p, p + 2), 16);
  const mix = (p) => Math.round(part(k, p) + u * (part(k + 1, p) - part(k, p)));
  return `rgb(${mix(1)},${mix(3)},${mix(5)})`;
}

// Of a colour "#rrggbb" or "rgb(r,g,b)", from 0 to 1.
function brightness(colour) {
  const parts = colour[0] === "#" ? [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))
    : colour.match(/\d+/g).map(Number);
  return (0.299 * parts[0] + 0.587 * parts[1] + 0.114 * parts[2]) / 255;
}

// Lines of an SVG for the joints of a pose: 0 from the side, x forwards; 1 from the front.
function stickFigure(pose, pairs, axis) {
  if (!pose) return [];
  return pairs.map(([a, b], k) => ({
    x1: pose[a][axis], y1: -pose[a][2], x2: pose[b][axis], y2: -pose[b][2],
    stroke: k < 3 ? "#0072b2" : k < 6 ? "#d55e00" : "#222", "stroke-width": 0.03,
    "stroke-linecap": "round" }));
}

function pixelRatio() {
  return window.devicePixelRatio || 1;
}

// Gives canvases a size in pixels of the screen; tells whether it was another one.
function resizeTo(canvases, width, height) {
  if (canvases.every((canvas) => canvas.width === width && canvas.height === height)) return false;
  for (const canvas of canvases) Object.assign(canvas, { width, height });
  return true;
}

// A white plate behind a text, so that it can be read whatever it lies on.
function plate(ctx, x, y, width, height) {
  const fill = ctx.fillStyle;
  ctx.fillStyle = "rgba(255, 255, 255, 0.85)";
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
