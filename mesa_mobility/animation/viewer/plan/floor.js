// The floor plan on a canvas: free floor, walls, obstacles, doors and exits with their names.

function outlined(ctx, rings, place) {
  ctx.beginPath();
  for (const ring of rings) {
    ring.forEach((p, k) => (k ? ctx.lineTo(...place(...p)) : ctx.moveTo(...place(...p))));
    ctx.closePath();
  }
}

// `place` turns metres into pixels, `r` is the number of pixels in one of the page.
// What `over` paints lies on the free floor, and on it alone.
function paintFloor(ctx, floor, place, r, colours, over = null) {
  const solids = floor.solids || [], seats = solids.filter(({ kind }) => kind === "seat");
  outlined(ctx, floor.outline, place);
  ctx.fillStyle = colours.solid;
  ctx.fill();
  for (const { kind, rings } of solids) {
    if (kind !== "wall") continue;
    outlined(ctx, rings, place);
    ctx.fill("evenodd");
  }
  ctx.fillStyle = colours.free;
  for (const rings of floor.free) {
    outlined(ctx, rings, place);
    ctx.fill("evenodd");
  }
  if (over) {
    ctx.save();
    outlined(ctx, floor.free.flat(), place);
    ctx.clip("evenodd");
    over(ctx);
    ctx.restore();
  }
  ctx.fillStyle = colours.seat;
  for (const { rings } of seats) {
    outlined(ctx, rings, place);
    ctx.fill();
  }
  ctx.fillStyle = "rgba(255, 193, 7, 0.25)"; // slow zones
  for (const zone of floor.zones) {
    outlined(ctx, [zone], place);
    ctx.fill();
  }
  for (const refuge of floor.refuges || []) paintRefuge(ctx, refuge, place, r, colours);
  ctx.strokeStyle = colours.away;
  ctx.lineWidth = r;
  ctx.setLineDash([4 * r, 4 * r]);
  for (const obstacle of floor.obstacles) {
    if (obstacle.there) continue;
    outlined(ctx, [obstacle.ring], place);
    ctx.stroke();
  }
  ctx.setLineDash([]);
  ctx.strokeStyle = colours.wall;
  ctx.lineWidth = 1.3 * r;
  ctx.beginPath();
  for (const [x0, y0, x1, y1] of floor.walls) {
    ctx.moveTo(...place(x0, y0));
    ctx.lineTo(...place(x1, y1));
  }
  ctx.stroke();
  for (const opening of floor.openings) paintOpening(ctx, opening, place, r, colours);
}

function paintRefuge(ctx, { name, rings, middle: spot }, place, r, colours) {
  outlined(ctx, rings, place);
  ctx.fillStyle = colours.refuge;
  ctx.fill("evenodd");
  ctx.strokeStyle = ctx.fillStyle = colours.exit;
  ctx.lineWidth = r;
  ctx.stroke();
  ctx.font = `${12 * r}px sans-serif`;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillText(name, ...place(...spot));
}

function openingColour(opening, colours) {
  return opening.open ? colours[opening.kind === "exit" ? "exit" : "door"] : colours.closed;
}

function paintOpening(ctx, opening, place, r, colours) {
  const a = place(...opening.a), b = place(...opening.b), [x, y] = middle(a, b), arm = 5 * r;
  ctx.strokeStyle = openingColour(opening, colours);
  ctx.lineWidth = 4 * r;
  ctx.setLineDash(opening.open ? [] : [5 * r, 3 * r]);
  ctx.beginPath();
  ctx.moveTo(...a);
  ctx.lineTo(...b);
  ctx.stroke();
  ctx.setLineDash([]);
  if (opening.open) return;
  for (const [colour, width] of [[colours.plate, 6], [openingColour(opening, colours), 2.5]]) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * r;
    ctx.beginPath();
    ctx.moveTo(x - arm, y - arm); ctx.lineTo(x + arm, y + arm);
    ctx.moveTo(x + arm, y - arm); ctx.lineTo(x - arm, y + arm);
    ctx.stroke();
  }
}

function middle(a, b) {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
}

// Where the names of openings are: beside the line, off the free floor if one side is.
function openingPlates(ctx, floor, place, r) {
  const { width, height } = ctx.canvas, plates = [], high = 18 * r;
  ctx.font = `${12 * r}px sans-serif`;
  const free = new Path2D();
  for (const ring of floor.free.flat()) {
    ring.forEach((p, k) => (k ? free.lineTo(...p) : free.moveTo(...p)));
    free.closePath();
  }
  for (const opening of floor.openings) {
    const { a, b } = opening, m = middle(a, b), far = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    let n = [(b[1] - a[1]) / far, (a[0] - b[0]) / far];
    const onFloor = (sign) => ctx.isPointInPath(free, m[0] + 0.3 * sign * n[0], m[1] + 0.3 * sign * n[1], "evenodd");
    if (onFloor(1) && !onFloor(-1)) n = [-n[0], -n[1]];
    const text = opening.open ? opening.name : `${opening.name}: closed`;
    const wide = ctx.measureText(text).width + 12 * r, [px, py] = place(...m);
    if (px < 0 || py < 0 || px > width || py > height) continue;
    const out = 10 * r + (Math.abs(n[0]) * wide + Math.abs(n[1]) * high) / 2;
    const fits = (sign) => Math.abs(px + sign * n[0] * out - width / 2) <= (width - wide) / 2
      && Math.abs(py - sign * n[1] * out - height / 2) <= (height - high) / 2;
    // On the other side where the canvas ends on this one: the name must not hide the line.
    const side = fits(1) || !fits(-1) ? out : -out;
    const x = Math.min(Math.max(px + n[0] * side, wide / 2), width - wide / 2) - wide / 2;
    const y = Math.min(Math.max(py - n[1] * side, high / 2), height - high / 2) - high / 2;
    const covers = (o) => x < o.x + o.wide && o.x < x + wide && y < o.y + o.high && o.y < y + high;
    // Names that would cover another are in the list below the canvas.
    if (!plates.some(covers)) plates.push({ opening, text, x, y, wide, high });
  }
  return plates;
}

function paintPlates(ctx, plates, r, colours) {
  ctx.font = `${12 * r}px sans-serif`;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.lineWidth = r;
  for (const { opening, text, x, y, wide, high } of plates) {
    ctx.fillStyle = colours.plate;
    ctx.fillRect(x, y, wide, high);
    ctx.strokeStyle = openingColour(opening, colours);
    ctx.setLineDash(opening.open ? [] : [3 * r, 2 * r]);
    ctx.strokeRect(x, y, wide, high);
    ctx.fillStyle = colours.text;
    ctx.fillText(text, x + wide / 2, y + high / 2);
  }
  ctx.setLineDash([]);
}
