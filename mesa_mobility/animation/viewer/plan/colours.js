// Colours of light and of dark pages.

// Those of openings differ for every kind of colour vision; closed ones also by dashes and a cross.
const LIGHT = { ground: "#f2f2f0", solid: "#b5b5b5", free: "#ffffff", wall: "#2b2b2b", text: "#222222",
  plate: "rgba(255, 255, 255, 0.85)", away: "#767676", exit: "#00795a", refuge: "#d3ecdb", door: "#0072b2",
  closed: "#b23c00", seat: "#d3c3bd", outline: "rgba(0, 0, 0, 0.7)", self: "#0072b2", left: "#0072b2", right: "#d55e00",
  chosen: "#000000", pointed: "#d50000", hitsWall: "#8d6e63", hitsPerson: "#e6007e",
  scale: ["#fde725", "#5ec962", "#21918c", "#3b528b", "#440154"] };
const DARK = { ground: "#1e1e1e", solid: "#4d5156", free: "#2c2f33", wall: "#d6d6d6", text: "#eeeeee",
  plate: "rgba(24, 25, 27, 0.85)", away: "#a0a0a0", exit: "#3ddc97", refuge: "#1f4a38", door: "#6cc3ff",
  closed: "#ff9a5c", seat: "#5d4c48", outline: "rgba(255, 255, 255, 0.75)", self: "#6cc3ff", left: "#6cc3ff",
  right: "#ff9a5c", chosen: "#ffffff", pointed: "#ff5252", hitsWall: "#bc9a8c", hitsPerson: "#ff6ab5",
  scale: ["#fde725", "#5ec962", "#2bb5ae", "#6f8fd6", "#b07cd8"] };

// From free to jammed, which is bright; told apart with every kind of colour vision.
const HEAT = ["#0d0887", "#4c02a1", "#7e03a8", "#a92395", "#cc4778", "#e56b5d", "#f89540", "#fdc527", "#f0f921"];

// What a view on either kind of page has of it.
const COLOURED = {
  computed: {
    dark() { return Boolean(this.$vuetify && this.$vuetify.theme.dark); },
    colours() { return this.dark ? DARK : LIGHT; },
  },
};

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
