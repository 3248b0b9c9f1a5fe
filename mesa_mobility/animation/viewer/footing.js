// Where bodies and feet are on stairs: what mesa_mobility/buildings/footing.py does, for one person.
"use strict";

const FOOT_REACH = 0.8, FOOT_ASIDE = 0.5, SAME_FLIGHT = 0.05, EDGE = 1e-6; // metres

class Footing {
  constructor(flights) { this.flights = flights; }

  // The height above which the body of somebody at [x, y, z] is drawn.
  carried([x, y, z]) {
    let found = z;
    for (const flight of this.flights) {
      const [down, aside] = onFlight(flight, x, y), { going, tread, riser, bottom, top } = flight;
      if (!flight.risers || down <= 0 || down >= going || aside > flight.width / 2 || Math.abs(slope(flight, down) - z) > SAME_FLIGHT) continue;
      const end = Math.min(tread, going / 2), drop = (0.5 + end / tread) * riser;
      if (down < end) found = top - (drop * down) / end;
      else if (down > going - end) found = bottom + (drop * (going - down)) / end;
      else found = top - riser * (0.5 + down / tread);
    }
    return found;
  }

  // Heights at a place beneath somebody at [x, y, z]: of the tread or floor, and of the line over its edges.
  beneath([x, y, z], px, py) {
    const found = [z, z];
    for (const flight of this.flights) {
      const [down, aside] = onFlight(flight, x, y), { going, width, tread, riser, bottom, top } = flight;
      const along = Math.min(Math.max(down, 0), going);
      if (Math.abs(down - along) > FOOT_REACH || aside > width / 2 + FOOT_REACH
        || Math.abs(slope(flight, along) - z) > SAME_FLIGHT) continue;
      const on = down === along && aside <= width / 2, [foot, beside] = onFlight(flight, px, py);
      if (beside > width / 2 + (on ? FOOT_ASIDE : 0) || !(on || (foot > 0 && foot < going + tread))) continue;
      if (!flight.risers) {
        found[0] = found[1] = slope(flight, Math.min(Math.max(foot, 0), going));
        continue;
      }
      const within = (height) => Math.min(Math.max(height, bottom), top);
      const count = foot >= going ? flight.risers : Math.ceil((foot - EDGE) / tread);
      found[0] = within(top - riser * count);
      found[1] = within(top - (riser * foot) / tread);
    }
    return found;
  }
}

// Metres down from the head of a flight, and metres from its middle line.
function onFlight({ head, down }, x, y) {
  const dx = x - head[0], dy = y - head[1];
  return [dx * down[0] + dy * down[1], Math.abs(dy * down[0] - dx * down[1])];
}

function slope({ top, bottom, going }, down) {
  return top + (down / going) * (bottom - top);
}
