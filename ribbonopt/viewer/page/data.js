"use strict";
// What the page holds: one object `view`, read from the JSON in the page, and `shapes`, its ribbons.
//
// view = {
//   kind: "result" | "branch" | "batch", name, units: {si, length, strain, force, moment, energy},
//   camera: [right, up, towards: 3 numbers each], centred: whether each shape stands for itself,
//   shapes: [{caption, note, numbers: [[name, value]], warnings: [text], verified: true | false,
//             count (rows), solved (rows that do not follow by symmetry), starts: [first rows of
//             pieces], closing: 0 | 1 | -1, rod: true | false}],
//   ranges: {name: [least, largest]} over all shapes, of what is drawn along them,
//   packed: base64 of all rows (packing.py),
//   diagram: what diagram.py gives, of a branch; table: what rows.py gives, of a batch,
//   modes: what motion.py gives, of a result whose modes of small vibrations are known
// }
// shapes.rows(i) -> {count, solved, starts, and Float32Arrays of that length: s, x, y, z, width,
//   slant, u1, u2, u3, eta, n1, n2, n3, m1, m2, m3 (along the directors), energy; and, three numbers
//   a row, d1, d2, d3, b}: NaN where there is no number.
// shapes.along(i, name) -> {s, y}: a column to draw, with NaN between the pieces, and `row`, the
//   row of each point.
const COLUMNS = ["s", "x", "y", "z", "q0", "q1", "q2", "q3", "slant", "width", "u1", "u2", "u3",
  "angle", "nx", "ny", "nz", "mx", "my", "mz", "energy"];
const view = JSON.parse(document.getElementById("data").textContent);

// Tables of columns of numbers as packing.py packs them, of `counts` rows each, columns by `names`:
// read() unpacks, column(i, k) is a Float32Array, NaN where there is no number.
function makeTables(packed, counts, names) {
  let scales, bytes;
  const places = [0];
  for (const count of counts) places.push(places.at(-1) + count * names.length);

  async function read() {
    const raw = await inflated(packed).arrayBuffer();
    const head = counts.length * names.length * 8;
    scales = new DataView(raw, 0, head);
    bytes = new Uint8Array(raw, head);
  }

  function column(i, k) {
    const count = counts[i];
    const at = (i * names.length + k) * 8;
    const offset = scales.getFloat32(at, true);
    const step = scales.getFloat32(at + 4, true);
    const first = places[i] + k * count;
    const total = places.at(-1);
    const found = new Float32Array(count);
    let whole = 0;
    let slope = 0;
    for (let j = 0; j < count; j++) {
      const folded = bytes[first + j] * 256 + bytes[total + first + j];
      slope += folded & 1 ? -(folded + 1) / 2 : folded / 2;
      whole = ((whole + slope) << 16) >> 16;
      found[j] = whole === -32768 ? NaN : offset + step * whole;
    }
    return found;
  }

  return { read, column };
}

const shapes = (() => {
  const counts = view.shapes.map(({ count }) => count);
  const { read, column } = makeTables(view.packed, counts, COLUMNS);
  const cache = new Map();

  function frames(q, count) {
    const [d1, d2, d3] = [0, 1, 2].map(() => new Float32Array(3 * count));
    for (let j = 0; j < count; j++) {
      const size = Math.hypot(q[0][j], q[1][j], q[2][j], q[3][j]);
      const [w, x, y, z] = q.map((part) => part[j] / size);
      d1.set([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], 3 * j);
      d2.set([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], 3 * j);
      d3.set([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], 3 * j);
    }
    return [d1, d2, d3];
  }

  function made(i) {
    const { count, solved, starts } = view.shapes[i];
    const found = { count, solved, starts };
    COLUMNS.forEach((name, k) => (found[name] = column(i, k)));
    const [d1, d2, d3] = frames([found.q0, found.q1, found.q2, found.q3], count);
    Object.assign(found, { d1, d2, d3, b: new Float32Array(3 * count) });
    found.eta = found.angle.map(Math.tan);
    for (const [vector, [x, y, z]] of [["n", ["nx", "ny", "nz"]], ["m", ["mx", "my", "mz"]]]) {
      [d1, d2, d3].forEach((d, k) => {
        const along = (_, j) =>
          found[x][j] * d[3 * j] + found[y][j] * d[3 * j + 1] + found[z][j] * d[3 * j + 2];
        found[vector + (k + 1)] = found.s.map(along);
      });
    }
    for (let j = 0; j < 3 * count; j++) found.b[j] = d2[j] + found.slant[Math.floor(j / 3)] * d3[j];
    return found;
  }

  function rows(i) {
    if (!cache.has(i)) {
      if (cache.size > 20) cache.delete(cache.keys().next().value);
      cache.set(i, made(i));
    }
    return cache.get(i);
  }

  function along(i, name, abscissa = "s") {
    const found = rows(i);
    const [x, y, row] = [[], [], []];
    for (let j = 0; j < found.count; j++) {
      if (j && found.starts.includes(j)) {
        x.push(found[abscissa][j]);
        y.push(NaN);
        row.push(j);
      }
      x.push(found[abscissa][j]);
      y.push(found[name][j]);
      row.push(j);
    }
    return { x, y, row };
  }

  return { read, rows, along };
})();
