// Storeys of a building: the one that is shown, and a section through all: a part of the crowd's view.

const SIDE_BY_SIDE = "";
const CUT_HIGH = 2.2, CUT_MARGIN = 26; // metres above the topmost floor; pixels for texts

const STOREYS = {
  data() {
    return { storey: SIDE_BY_SIDE, along: 0 };
  },
  computed: {
    storeys() { return (this.floor && this.floor.storeys) || null; },
    // Levels from the topmost, then landings.
    choices() {
      const names = (own) => this.storeys.sheets.filter(({ level }) => level === own)
        .sort((a, b) => b.elevation - a.elevation).map(({ name }) => name);
      return this.storeys ? [...names(true), ...names(false)] : [];
    },
    // Stairs and lifts have a line on each of their levels.
    listed() { return [...new Map((this.floor.openings || []).map((each) => [each.name, each])).values()]; },
    sheet() { return this.storeys && this.storeys.sheets.find(({ name }) => name === this.storey); },
    shownBounds() { return this.sheet ? this.sheet.bounds : this.floor && this.floor.bounds; },
  },
  methods: {
    chooseStorey(name) {
      this.storey = name;
      this.fit();
    },
    turnSection() {
      this.along = 1 - this.along;
      this.fresh = true;
    },
    isShown(x) { return !this.sheet || (x >= this.sheet.left && x <= this.sheet.right); },
    // What is drawn afterwards is drawn on the storey alone.
    clipToStorey(ctx) {
      if (!this.sheet) return;
      const [left] = this.place(this.sheet.left, 0), [right] = this.place(this.sheet.right, 0);
      ctx.beginPath();
      ctx.rect(left, 0, right - left, ctx.canvas.height);
      ctx.clip();
    },
    openingsShown() { return (this.floor.openings || []).filter(({ a }) => this.isShown(a[0])); },
    // The picture without people on other storeys.
    onStorey(now) {
      if (!this.sheet) return now;
      const kept = [];
      for (let k = 0; k < now.people.length; k += FIELDS) {
        if (this.isShown(now.people[k + 1])) kept.push(...now.people.subarray(k, k + FIELDS));
      }
      return { ...now, people: new Float32Array(kept) };
    },
    paintSection(now) {
      const canvas = this.$refs.section, r = this.ratio;
      if (!canvas || !this.storeys || !canvas.clientWidth) return;
      resizeTo([canvas], Math.round(canvas.clientWidth * r), Math.round(canvas.clientHeight * r));
      const { sheets, flights, bounds } = this.storeys, k = this.along, ctx = canvas.getContext("2d");
      const heights = sheets.map(({ elevation }) => elevation), least = bounds[k], most = bounds[k + 2];
      const low = Math.min(...heights), high = Math.max(...heights) + CUT_HIGH, margin = CUT_MARGIN * r;
      const scale = Math.min((canvas.width - 6 * margin) / (most - least), (canvas.height - 1.5 * margin) / (high - low));
      const left = canvas.width / 2 - (scale * (most - least)) / 2 + margin, base = canvas.height - margin;
      const at = (along, z) => [left + scale * (along - least), base - scale * (z - low)];
      ctx.fillStyle = this.colours.ground;
      ctx.fillRect(0, 0, canvas.width, canvas.height);
      ctx.strokeStyle = this.colours.wall;
      ctx.fillStyle = this.colours.text;
      ctx.font = `${11 * r}px sans-serif`;
      ctx.textAlign = "right";
      ctx.lineWidth = 1.5 * r;
      ctx.beginPath();
      for (const { name, level, elevation, floor: own } of sheets) {
        const [x, y] = at(own[k], elevation);
        ctx.moveTo(x, y);
        ctx.lineTo(...at(own[k + 2], elevation));
        if (level) ctx.fillText(name, left - 6 * r, y + 4 * r);
      }
      for (const { head, down, going, top, bottom, riser, risers, tread } of flights) {
        ctx.moveTo(...at(head[k], top));
        if (!risers) ctx.lineTo(...at(head[k] + going * down[k], bottom));
        for (let step = 1; step <= risers; step += 1) {
          ctx.lineTo(...at(head[k] + (step - 1) * tread * down[k], top - step * riser));
          if (step < risers) ctx.lineTo(...at(head[k] + step * tread * down[k], top - step * riser));
        }
      }
      ctx.stroke();
      ctx.textAlign = "left";
      ctx.fillText(`${k ? "y" : "x"} against z, ${(most - least).toFixed(0)} m wide`, 8 * r, canvas.height - 7 * r);
      const size = Math.max(0.25 * scale, 2 * r);
      for (let j = 0; j < now.people.length; j += FIELDS) {
        const place = trueOf(this.storeys, now.people[j + 1], now.people[j + 2], now.people[j + 5]);
        const [x, y] = at(place[k], place[2]);
        ctx.fillStyle = now.people[j] === this.selected ? "#e6007e" : colourOf(now.people[j + 4], now.legend);
        ctx.beginPath();
        ctx.arc(x, y - size, size, 0, 2 * Math.PI);
        ctx.fill();
      }
    },
  },
};
