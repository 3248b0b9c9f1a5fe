// From the plane, in which a building's sheets lie side by side, to true places: buildings/places.py.

const STAIR_END = 0.3; // metres that a flight goes on on its copy

function sheetAt({ sheets }, px) { return sheets.find(({ right }) => px <= right); }

// The true place [x, y, z] of a place in the plane, from whose floor a lift has carried somebody by risen.
function trueOf({ sheets, flights }, px, py, risen = 0) {
  const number = sheets.findIndex(({ right }) => px <= right), { shift, elevation } = sheets[number];
  const x = px - shift[0], y = py - shift[1];
  for (const { head, down, width, going, top, bottom, upper, lower } of flights) {
    if (upper !== number && lower !== number) continue;
    const dx = x - head[0], dy = y - head[1], away = dx * down[0] + dy * down[1];
    const aside = Math.abs(dy * down[0] - dx * down[1]);
    if (away < -STAIR_END || away > going + STAIR_END || aside > width / 2) continue;
    if (away < 0 && number === upper) continue; // on the floor before its head
    if (away > going && number === lower) continue; // or before its foot
    return [x, y, top + (Math.min(Math.max(away, 0), going) / going) * (bottom - top)];
  }
  return [x, y, elevation + risen];
}
