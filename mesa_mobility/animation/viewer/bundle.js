// Opens what `mesa_mobility/animation/bundle.py` has packed.
"use strict";

const KINDS = { float32: Float32Array, int32: Int32Array, int16: Int16Array, uint16: Uint16Array, uint8: Uint8Array };

async function unbundle(text) {
  const plain = atob(text), packed = new Uint8Array(plain.length);
  for (let k = 0; k < plain.length; k += 1) packed[k] = plain.charCodeAt(k);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const content = await new Response(stream).arrayBuffer();
  const length = new DataView(content).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(content, 4, length)));
  const arrays = {};
  for (const [name, { kind, from, count }] of Object.entries(header.arrays)) {
    arrays[name] = new KINDS[kind](content, 4 + length + from, count);
  }
  return { header, arrays };
}

// Of the arrays "NAME.part", those of one name by part.
function partsOf(arrays, name) {
  const found = {};
  for (const [key, values] of Object.entries(arrays)) {
    if (key.startsWith(`${name}.`)) found[key.slice(name.length + 1)] = values;
  }
  return found;
}

function figureOf({ header, arrays }) {
  return { skeleton: header.skeleton, looks: header.looks,
    meshes: Object.fromEntries(header.figures.map((name) => [name, partsOf(arrays, name)])) };
}

function bankOf({ header, arrays }, name, scale) {
  return new Bank({ ...partsOf(arrays, name), scale }, header.skeleton);
}
