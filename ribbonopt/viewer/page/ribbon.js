"use strict";
// The picture of the ribbon: its canvas, what lies over it (axes, scale, marks), and the hand that
// turns it. `makeRibbon(stage)` gives show(i), mark(row), colour(field); it calls `onHover(row)`
// with the row under the pointer, null where there is none. move(moved) shows it off its place.
function makeRibbon(stage, onHover) {
  const canvas = stage.querySelector("canvas");
  const overlay = makeOverlay(stage.querySelector("svg"));
  const camera = makeCamera(view.camera);
  const brush = makeWebgl(canvas) || makePainter(canvas);
  const BEYOND = 0.12; // of the width
  const state = { shape: 0, field: "", row: null, moved: (rows) => rows };
  let mesh;
  let scale = null;
  let look;
  let waiting = false;

  function draw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      if (mesh && camera.width > 1 && camera.height > 1) paint();
    });
  }

  function paint() {
    const { closing } = view.shapes[state.shape];
    look ??= Object.fromEntries(
      ["front", "back", "paper", "lines", "mark"].map((name) => [name, colours.named(`--${name}`)]),
    );
    const shown = { ...look, stops: scale && scale.stops };
    if (closing < 0) shown.back = look.front; // its two sides are one
    brush.draw(camera, shown, state.row === null ? null : marked(state.row));
    overlay.draw(camera, view, state.shape);
  }

  // The generatrix of a row, a little beyond the edges so that it is seen where rows are steep.
  function marked(row) {
    const [a, b] = [mesh.point(row, 0), mesh.point(row, 2)];
    const beyond = (p, q) => Array.from(p, (part, c) => part + BEYOND * (part - q[c]));
    return new Float32Array([...beyond(a, b), ...beyond(b, a), 0]);
  }

  function load() {
    const shape = view.shapes[state.shape];
    if (shape.centre) camera.centre = shape.centre;
    form();
    dye();
  }

  function form() {
    mesh = makeMesh(state.moved(shapes.rows(state.shape)), view.shapes[state.shape].closing);
    mesh.size = Math.max(...view.camera.extent);
    brush.load(mesh);
    draw();
  }

  function dye() {
    const values = state.field && shapes.rows(state.shape)[state.field];
    scale = values ? colours.scale(view.ranges[state.field]) : null;
    const place = (_, i) => (values ? scale.place(values[Math.floor(i / ACROSS)]) : 0);
    brush.paint(Float32Array.from({ length: ACROSS * mesh.count }, place));
    draw();
  }

  // The row whose generatrix is under the pointer; of several the one that is nearest to the eye.
  function rowAt(x, y) {
    let best = null;
    let nearest = 1e9;
    for (let j = 0; j < mesh.count; j++) {
      const [a, b] = [camera.project(...mesh.point(j, 0)), camera.project(...mesh.point(j, 2))];
      const way = [b[0] - a[0], b[1] - a[1]];
      const long = way[0] ** 2 + way[1] ** 2 || 1;
      const k = Math.min(Math.max(((x - a[0]) * way[0] + (y - a[1]) * way[1]) / long, 0), 1);
      const far = Math.hypot(a[0] + k * way[0] - x, a[1] + k * way[1] - y);
      if (far > 12) continue;
      const height = a[2] + k * (b[2] - a[2]);
      const cost = far - (far < 6 ? 6 : 0) - (20 * height) / view.camera.depth;
      if (cost < nearest) [best, nearest] = [j, cost];
    }
    return best;
  }

  followHand(canvas, camera, { draw, hover: (x, y) => onHover(mesh ? rowAt(x, y) : null) });
  brush.lost(() => {}, load);
  new ResizeObserver(() => {
    camera.width = canvas.clientWidth;
    camera.height = canvas.clientHeight;
    canvas.width = Math.round(camera.width * devicePixelRatio);
    canvas.height = Math.round(camera.height * devicePixelRatio);
    overlay.resize(camera);
    if (mesh && camera.width > 1 && camera.height > 1) paint(); // at once: a canvas of a new size is empty
  }).observe(canvas);

  return {
    camera,
    draw,
    show: (i) => {
      state.shape = i;
      state.row = null;
      load();
    },
    // `moved(rows)` gives the rows in the place of those at rest.
    move: (moved) => {
      state.moved = moved;
      form();
    },
    mark: (row) => {
      state.row = row;
      draw();
    },
    colour: (field) => {
      state.field = field;
      dye();
      return scale;
    },
    recolour: () => {
      look = undefined;
      if (mesh && camera.width > 1 && camera.height > 1) paint(); // at once: it may be to be printed
    },
  };
}
