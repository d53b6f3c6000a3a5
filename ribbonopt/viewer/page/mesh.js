"use strict";
// A ribbon as what is drawn: points across each row, faces between rows, and lines on them.
const ACROSS = 3; // points of a row: the edges and the centre line
const GENERATRICES = 48; // over the length drawn

function makeMesh(rows, closing) {
  const { count, b, width, s, d1 } = rows;
  const points = new Float32Array(3 * ACROSS * count);
  const normals = new Float32Array(3 * ACROSS * count);
  for (let j = 0; j < count; j++) {
    const middle = [rows.x[j], rows.y[j], rows.z[j]];
    for (let k = 0; k < ACROSS; k++) {
      const at = 3 * (ACROSS * j + k);
      for (let c = 0; c < 3; c++) {
        points[at + c] = middle[c] + (k - 1) * width[j] * b[3 * j + c];
        normals[at + c] = d1[3 * j + c];
      }
    }
  }
  const point = (j, k) => points.subarray(3 * (ACROSS * j + k), 3 * (ACROSS * j + k) + 3);
  const faces = [];
  for (let j = 0; j + 1 < count; j++) {
    for (let k = 0; k + 1 < ACROSS; k++) {
      const a = ACROSS * j + k;
      faces.push(a, a + 1, a + ACROSS, a + 1, a + ACROSS + 1, a + ACROSS);
    }
  }
  const pale = (j) => (j >= rows.solved ? 1 : 0);
  const [edges, centre, across] = [[], [], []];
  const segment = (list, j, k, i, l) => list.push(...point(j, k), ...point(i, l), pale(j));
  for (let j = 0; j + 1 < count; j++) {
    segment(edges, j, 0, j + 1, 0);
    segment(edges, j, 2, j + 1, 2);
    segment(centre, j, 1, j + 1, 1);
  }
  const step = (s[count - 1] - s[0]) / GENERATRICES;
  for (let j = 1, next = s[0] + step; j + 1 < count; j++) {
    if (s[j] < next) continue;
    segment(across, j, 0, j, 2);
    while (s[j] >= next) next += step;
  }
  if (!closing) [0, count - 1].forEach((j) => segment(edges, j, 0, j, 2));
  return {
    points,
    normals,
    faces: new Uint32Array(faces),
    pale: Float32Array.from({ length: ACROSS * count }, (_, i) => pale(Math.floor(i / ACROSS))),
    edges: new Float32Array(edges),
    centre: new Float32Array(centre),
    across: new Float32Array(across),
    count,
    point,
  };
}
