// A crowd in three dimensions: people as figures, and cameras. z is up, in metres.
"use strict";

const EYES = 0.1;
const FOLLOWED = 1.1, OVER = 0.25; // metres: height of the place that is followed; a camera's way above walls
// Height on the screen from which people are figures, have rounder limbs, feet on the floor, and all corners.
const FIGURE_PIXELS = 6, ROUND_PIXELS = 48, PLACED_PIXELS = 64, FINE_PIXELS = 110;
const FINE_MOST = 24, HELD_MOST = 100; // figures with all corners, with feet held on the floor
const QUICK = 0.018; // seconds between pictures from which on there is more detail
// Where pictures come more slowly than in so many seconds: fewer pixels, then fewer figures.
const DETAIL = [{ slow: 0.042, share: 1, afar: 1 }, { slow: 0.042, share: 0.8, afar: 1 }, { slow: 0.042, share: 0.65, afar: 1 },
  { slow: 0.064, share: 0.5, afar: 1 }, { slow: 0.064, share: 0.5, afar: 2 }, { slow: 0.064, share: 0.5, afar: 4 },
  { slow: Infinity, share: 0.5, afar: 8 }];
const FROM = [0.31, -0.77, 0.72], ROOM_HIGH = 1.8, MARGIN = 1.06; // where the camera stands; metres; room round the floor
const SEATED = "wheelchair", RING = "#e6007e";

class Stage {
  // figure: {skeleton, meshes, looks}, see animation/figures/levels.py and animation/figures/clothes.py. Throws where a page cannot draw so.
  constructor(holder, figure) {
    this.holder = holder;
    this.skeleton = figure.skeleton;
    this.renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
    this.canvas = this.renderer.domElement;
    this.canvas.style.cssText = "display: block; width: 100%; height: 100%; touch-action: none";
    holder.appendChild(this.canvas);
    this.scene = new THREE.Scene();
    this.scene.matrixWorldAutoUpdate = false;
    this.perspective = new THREE.PerspectiveCamera(50, 1, 0.1, 1000);
    this.above = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 500);
    for (const camera of [this.perspective, this.above]) camera.up.set(0, 0, 1);
    this.orbit = new THREE.OrbitControls(this.perspective, this.canvas);
    this.body = new Body(this.skeleton);
    this.rows = 0;
    this.bones = { value: null };
    this.tops = figure.looks.map(([top]) => channels(top));
    this.troops = new Troops(figure.meshes, figure.looks, this.bones, this.scene);
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.36, 0.46, 24), flat(RING));
    this.scene.add(this.ring);
    this.scenery = new Scenery(this.scene);
    this.how = "orbit";
    this.missed = false; // whether somebody was to be followed who is not there
    this.sharp = 1; // pixels drawn for each one shown, along a side
    this.detail = 0;
    this.still = false; // whether the next picture stays for a while
    this.pace = 0.03;
    this.since = 0;
    this.drawn = 0;
  }

  dispose() {
    this.setFloor(null);
    this.orbit.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }

  // floor: what `floor.py` or `storeys.py` makes, or null; colours: {ground, free, wall} as "#rrggbb".
  setFloor(floor, colours) {
    if (!floor) {
      this.scenery.clear();
      return;
    }
    this.scene.background = new THREE.Color(colours.ground);
    this.scenery.set(floor, colours);
    this.body.footing = floor.flights ? new Footing(floor.flights) : null;
    const same = this.bounds && String(this.bounds) === String(floor.bounds);
    this.bounds = floor.bounds;
    if (!same) this.fit();
  }

  // The whole floor is in the picture.
  fit() {
    this.resize(true);
    const [x0, y0, x1, y1] = this.bounds, { top } = this.scenery, { orbit, perspective } = this;
    orbit.target.set((x0 + x1) / 2, (y0 + y1) / 2, 0.8 + top / 2);
    const away = new THREE.Vector3(...FROM).normalize();
    perspective.position.copy(away).add(orbit.target);
    perspective.lookAt(orbit.target);
    perspective.updateMatrixWorld();
    const [right, up] = [0, 1].map((k) => new THREE.Vector3().setFromMatrixColumn(perspective.matrixWorld, k));
    const high = Math.tan((perspective.fov * Math.PI) / 360), wide = high * perspective.aspect;
    let far = 1;
    for (const x of [x0, x1]) {
      for (const y of [y0, y1]) {
        for (const z of [0, top + ROOM_HIGH]) {
          const corner = new THREE.Vector3(x, y, z).sub(orbit.target);
          const needed = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / high);
          far = Math.max(far, corner.dot(away) + needed * MARGIN);
        }
      }
    }
    perspective.position.copy(away).multiplyScalar(far).add(orbit.target);
    orbit.update();
  }

  resize(always = false) {
    const { clientWidth: width, clientHeight: height } = this.holder;
    const ratio = (window.devicePixelRatio || 1) * this.sharp * this.level.share, size = `${width} ${height} ${ratio}`;
    if (!width || !height || (size === this.size && !always)) return;
    this.size = size;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    if (!this.bounds) return;
    const [x0, y0, x1, y1] = this.bounds;
    const half = Math.max((y1 - y0) / 2, ((x1 - x0) / 2) * (height / width)) * 1.1;
    Object.assign(this.above, { left: (-half * width) / height, right: (half * width) / height, top: half, bottom: -half });
    this.above.position.set((x0 + x1) / 2, (y0 + y1) / 2, 50 + this.scenery.top);
    this.above.up.set(0, 1, 0);
    this.above.lookAt((x0 + x1) / 2, (y0 + y1) / 2, 0);
    this.above.updateProjectionMatrix();
  }

  get level() { return DETAIL[this.still ? 0 : this.detail]; }

  get camera() { return this.how === "plan" ? this.above : this.perspective; }

  // Less detail where pictures come slowly, more where there is time.
  adapt(seconds) {
    if (seconds > 2) return; // another tab was shown
    this.pace += 0.15 * (seconds - this.pace);
    this.since += seconds;
    if (this.since < 0.5) return;
    this.since = 0;
    if (this.pace > DETAIL[this.detail].slow) this.detail += 1;
    else if (this.pace < QUICK && this.detail > 0) this.detail -= 1;
    this.resize();
  }

  // people: [{row, track, course or null, aid: what they hold or sit in, colour: [r, g, b] or null for the colour of
  // their clothes}]; chosen: a row or -1.
  draw(people, frame, chosen) {
    this.resize();
    const rows = people.length;
    if (rows > this.rows) this.enlarge(Math.ceil(1.25 * rows));
    const who = people.find((each) => each.row === chosen);
    this.turned = null;
    this.follow(who, frame);
    const camera = this.camera, data = this.bones.value && this.bones.value.image.data;
    camera.updateMatrixWorld();
    const right = camera === this.above ? null : new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const wide = this.perspective.aspect * Math.tan((this.perspective.fov * Math.PI) / 360);
    const { x: cx, y: cy, z: cz } = camera.position, ahead = camera.getWorldDirection(new THREE.Vector3());
    const pixels = camera === this.above ? this.canvas.clientHeight / (this.above.top - this.above.bottom)
      : this.canvas.clientHeight / (2 * Math.tan((this.perspective.fov * Math.PI) / 360));
    this.troops.begin();
    this.ring.visible = Boolean(who);
    const figures = [], least = FIGURE_PIXELS * this.level.afar;
    let pawns = 0;
    for (const person of people) {
      const [x, y, heading, z] = person.track.at(frame), dx = x - cx, dy = y - cy;
      const depth = dx * ahead.x + dy * ahead.y + (z + 1 - cz) * ahead.z;
      if (depth < -1 || (person === who && this.how === "eyes")) continue;
      if (right && Math.abs(dx * right.x + dy * right.y) > wide * Math.max(depth, 0) + 1.5) continue; // beside the picture
      const high = camera === this.above ? pixels : (1.75 * pixels) / Math.max(depth, 0.3);
      if (person === who) this.mark(x, y, z);
      const look = person.row % this.tops.length, colour = person.colour || this.tops[look];
      const size = person.course ? person.course.bank.scale : person.scale || 1;
      this.troops.shadows.add({ stand: [x, y, heading, person.aid === SEATED ? 1.3 : size], rise: z + OVER_MARKINGS });
      if (person.aid === SEATED || (person.course && high >= least)) figures.push({ person, high, look, colour });
      else {
        this.troops.add(high < ROUND_PIXELS ? "person_speck" : "person_pawn", { stand: [x, y, heading, size], rise: z, colour, look });
        pawns += 1;
      }
    }
    figures.sort((a, b) => b.high - a.high);
    let fine = 0, row = 0;
    while (fine < Math.min(FINE_MOST, figures.length) && figures[fine].high >= FINE_PIXELS) fine += 1;
    figures.forEach(({ person, high, look, colour }, k) => {
      const level = k < fine ? "near" : "far", { aid } = person;
      if (aid === SEATED) {
        const [x, y, heading, rise] = person.track.at(frame), stand = [x, y, heading, 1];
        this.troops.add(`seated_${level}`, { stand, rise, colour, look });
        this.troops.add(`${aid}_${level}`, { stand, rise, colour, look });
        return;
      }
      if (high >= PLACED_PIXELS || person === who) this.body.pose(person, frame, k < HELD_MOST || person === who);
      else this.body.poseFarAway(person, frame);
      this.write(data, row, person.course.bank.scale);
      this.troops.add(high < ROUND_PIXELS && !this.still ? "person_small" : `person_${level}`, { row, colour, look });
      if (aid) this.troops.add(`${aid}_${level}`, { row, colour, look });
      row += 1;
    });
    this.troops.finish();
    this.figures = [fine, figures.length - fine, pawns];
    if (row) this.bones.value.needsUpdate = true;
    this.renderer.render(this.scene, camera);
    this.shownFrom = camera.position.toArray();
    if (this.turned) camera.position.copy(this.turned);
    this.drawn += 1;
  }

  // For a corner v of the figure: where bone b takes it is turn(v) * scale + place.
  write(data, row, scale) {
    const { places, turns } = this.body, rest = this.skeleton.rest, moved = [0, 0, 0];
    for (let j = 0; j < BONES; j += 1) {
      const at = 8 * (row * BONES + j);
      for (let i = 0; i < 4; i += 1) data[at + i] = turns[4 * j + i];
      turned(turns, 4 * j, rest, 3 * j, ZERO, 0, moved, 0);
      for (let i = 0; i < 3; i += 1) data[at + 4 + i] = places[3 * j + i] - scale * moved[i];
      data[at + 7] = scale;
    }
  }

  enlarge(rows) {
    this.rows = rows;
    this.bones.value = sheet(2 * BONES, rows, this.bones.value);
  }

  mark(x, y, z) {
    this.ring.position.set(x, y, z + 0.02);
    this.ring.updateMatrixWorld();
  }

  // Joints of somebody's body: where the head is and where it looks.
  head(person, frame) {
    const [x, y, heading, z] = person.track.at(frame);
    if (person.aid === SEATED || !person.course) {
      const c = Math.cos(heading), s = Math.sin(heading), [forward, , high] = this.skeleton.seatedHead;
      const place = person.aid === SEATED ? [x + c * forward, y + s * forward, z + high] : [x, y, z + 1.6];
      return { place, ahead: [c, s, 0] };
    }
    this.body.pose(person, frame, false);
    const ahead = [0, 0, 0];
    turned(this.body.turns, 16, [1, 0, 0], 0, ZERO, 0, ahead, 0);
    // How heads are bent is not as recorded: eyes look straight on.
    const long = Math.hypot(ahead[0], ahead[1]) || 1;
    return { place: [...this.body.places.slice(12, 15)], ahead: [ahead[0] / long, ahead[1] / long, 0] };
  }

  follow(who, frame) {
    const { orbit, perspective: camera } = this, follows = this.how === "follow" || this.how === "eyes";
    // Nobody to follow, or no longer: the whole floor instead.
    if (follows && !who && !this.missed) this.fit();
    this.missed = follows && !who;
    orbit.enabled = this.how !== "plan" && (this.how !== "eyes" || this.missed);
    if (!follows || this.missed) {
      if (orbit.enabled) orbit.update();
      return;
    }
    if (this.how === "follow") {
      const [x, y, , z] = who.track.at(frame), target = new THREE.Vector3(x, y, z + FOLLOWED);
      camera.position.add(target.clone().sub(orbit.target));
      orbit.target.copy(target);
      const away = camera.position.clone().sub(target);
      if (away.length() > 8) camera.position.copy(target).addScaledVector(away.normalize(), 5);
      orbit.update();
      // The reader's own view comes back after the picture, for the next turn of theirs.
      this.turned = camera.position.clone();
      camera.position.set(...overWalls(this.scenery.wallsAt(z), target.toArray(), this.turned.toArray()));
      camera.lookAt(target);
      return;
    }
    const { place, ahead } = this.head(who, frame);
    camera.position.set(place[0] + 0.12 * ahead[0], place[1] + 0.12 * ahead[1], place[2] + EYES);
    camera.lookAt(camera.position.x + ahead[0], camera.position.y + ahead[1], camera.position.z + ahead[2]);
  }

  look(how) {
    if (this.how === "eyes" && how !== "eyes") this.fit();
    this.how = how;
  }

  // From a place at another one, both [x, y, z].
  lookFrom(eye, target) {
    this.orbit.target.set(...target);
    this.perspective.position.set(...eye);
    this.orbit.update();
  }

  // The direction on the floor that is to the right in the picture, of length 1.
  toTheRight() {
    this.camera.updateMatrixWorld();
    const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), far = Math.hypot(right.x, right.y);
    return far ? [right.x / far, right.y / far] : [1, 0];
  }

  // The person nearest to a place on the page, within so many pixels; -1 for nobody.
  personAt(clientX, clientY, people, frame, reach = 30) {
    const box = this.canvas.getBoundingClientRect(), place = new THREE.Vector3();
    let best = reach, who = -1;
    for (const { row, track } of people) {
      const [x, y, , z] = track.at(frame);
      place.set(x, y, z + 1).project(this.camera);
      if (place.z > 1) continue;
      const px = box.left + ((place.x + 1) / 2) * box.width, py = box.top + ((1 - place.y) / 2) * box.height;
      const away = Math.hypot(px - clientX, (py - clientY) / 2);
      if (away < best) [best, who] = [away, row];
    }
    return who;
  }
}

// The camera that looks from `camera` at `target`, raised about it until it looks over all walls between.
// So it is never in an obstacle, whose edge would lie between. [x, y, z], metres.
function overWalls(walls, target, camera) {
  const [x, y, z] = target, dx = camera[0] - x, dy = camera[1] - y, dz = camera[2] - z;
  const level = Math.hypot(dx, dy), long = Math.hypot(level, dz);
  let steep = level ? dz / level : Infinity;
  for (const [ax, ay, bx, by, base = 0] of walls) {
    // Where the line of sight crosses the wall: at share u of its own length, v of the wall's.
    const wx = bx - ax, wy = by - ay, turn = dx * wy - dy * wx;
    if (!turn) continue;
    const u = ((ax - x) * wy - (ay - y) * wx) / turn, v = ((ax - x) * dy - (ay - y) * dx) / turn;
    if (u > 0 && u <= 1 && v >= 0 && v <= 1) steep = Math.max(steep, (base + WALL_HEIGHT + OVER - z) / (u * level));
  }
  if (!level || steep <= dz / level) return camera;
  const share = long / Math.hypot(1, steep) / level;
  return [x + share * dx, y + share * dy, z + share * level * steep];
}
