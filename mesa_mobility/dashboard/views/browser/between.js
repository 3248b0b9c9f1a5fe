// Where people have been between two pictures of a run: what `steps_between` in serialization.py tells.

const FRAMES_A_SECOND = 30, ROUND = 65536;

// Everybody at each time, as pictures; in the colours of the picture before, newcomers in those of the next.
function picturesBetween({ frames, counts, rows, places, risen, origin, step }, before, next) {
  if (!frames.length) return [];
  const who = numbers(rows, Int32Array), at = numbers(places, Uint16Array), up = risen && numbers(risen), values = new Map();
  const same = before && JSON.stringify(before.legend) === JSON.stringify(next.legend);
  for (const { people } of same ? [next, before] : [next]) {
    for (let k = 0; k < people.length; k += FIELDS) values.set(people[k], people[k + 4]);
  }
  let n = 0;
  return frames.map((frame, i) => {
    const people = new Float32Array(FIELDS * counts[i]);
    for (let k = 0; k < people.length; k += FIELDS, n += 1) {
      people[k] = who[n];
      people[k + 1] = origin[0] + step * at[3 * n];
      people[k + 2] = origin[1] + step * at[3 * n + 1];
      people[k + 3] = (2 * Math.PI * at[3 * n + 2]) / ROUND;
      people[k + 4] = values.get(who[n]) ?? next.legend.low;
      people[k + 5] = up ? up[n] : 0;
    }
    return { run: next.run, elapsed: frame / FRAMES_A_SECOND, inside: counts[i], legend: next.legend, people };
  });
}

// When and where people have come in or left, as [row, {elapsed, people: FIELDS of one person}].
function passagesOf(text) {
  const found = [], all = numbers(text);
  for (let k = 0; k < all.length; k += 6) {
    const [row, frame, x, y, heading, risen] = all.subarray(k, k + 6);
    found.push([row, { elapsed: frame / FRAMES_A_SECOND, people: Float32Array.of(row, x, y, heading, 0, risen) }]);
  }
  return found;
}

// Everybody at a time between two pictures a and b; came and left: when and where people did so.
function mixed(a, b, elapsed, { came, left }, storeys) {
  const next = new Map(), people = new Float32Array(a.people.length + b.people.length);
  let n = 0;
  const put = (from, j, begins, to, k, ends, value) => {
    between(people, n, from, j, to, k, (elapsed - begins) / Math.max(ends - begins, 1e-9), storeys);
    people[n + 4] = value;
    n += FIELDS;
  };
  for (let k = 0; k < b.people.length; k += FIELDS) next.set(b.people[k], k);
  for (let j = 0; j < a.people.length; j += FIELDS) {
    const row = a.people[j], k = next.get(row), end = k === undefined && passage(left, row, a, b), value = a.people[j + 4];
    if (k !== undefined) put(a.people, j, a.elapsed, b.people, k, b.elapsed, value);
    else if (!end) put(a.people, j, 0, a.people, j, 1, value); // nobody knows when
    else if (elapsed < end.elapsed) put(a.people, j, a.elapsed, end.people, 0, end.elapsed, value);
    next.delete(row);
  }
  for (const [row, k] of next) {
    const start = passage(came, row, a, b);
    if (start && start.elapsed <= elapsed) put(start.people, 0, start.elapsed, b.people, k, b.elapsed, b.people[k + 4]);
  }
  return { ...a, elapsed, inside: n / FIELDS, people: people.subarray(0, n) };
}

// The passage of somebody between two pictures.
function passage(known, row, a, b) {
  const found = known.get(row);
  return found && found.elapsed >= a.elapsed - 1e-6 && found.elapsed <= b.elapsed + 1e-6 ? found : null;
}

// Somebody a share of the way from one place to another; on the sheet of the nearer one, if these are two.
function between(people, n, from, j, to, k, share, storeys) {
  people.set(from.subarray(j, j + FIELDS), n);
  let turn = to[k + 3] - from[j + 3];
  turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  people[n + 3] += share * turn;
  const [a, b] = storeys ? [sheetAt(storeys, from[j + 1]), sheetAt(storeys, to[k + 1])] : [null, null], on = share < 0.5 ? a : b;
  const mix = (i, p, q) => { people[n + i] = (1 - share) * (from[j + i] + p) + share * (to[k + i] + q); };
  for (const i of [0, 1]) mix(i + 1, a === b ? 0 : on.shift[i] - a.shift[i], a === b ? 0 : on.shift[i] - b.shift[i]);
  mix(5, a === b ? 0 : a.elevation - on.elevation, a === b ? 0 : b.elevation - on.elevation);
}
