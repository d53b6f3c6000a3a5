"use strict";
// Checks of a page of two equilibria, run in a browser by test_viewer_scripts.py: each throws where
// something is wrong. `given` has the columns of the first shape as Python knows them.
const assert = (truth, ...said) => {
  if (!truth) throw new Error(said.map((one) => JSON.stringify(one)).join(" "));
};
const near = (a, b, within, ...said) => assert(Math.abs(a - b) <= within, a, b, within, ...said);
const frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
const get = (id) => document.getElementById(id);
const canvas = document.querySelector("#stage canvas");
const foot = () => document.querySelector(".strains .chart-foot").textContent;
const camera = () => {
  const made = makeCamera(view.camera);
  Object.assign(made, { width: canvas.clientWidth, height: canvas.clientHeight });
  return made;
};

// The pixels of the picture: how many are covered, and a sum that tells pictures apart.
function picture(of = canvas) {
  const flat = document.createElement("canvas");
  Object.assign(flat, { width: of.width, height: of.height });
  const pen = flat.getContext("2d");
  pen.drawImage(of, 0, 0);
  const pixels = pen.getImageData(0, 0, of.width, of.height).data;
  const covered = new Uint8Array(pixels.length / 4);
  let sum = 0;
  for (let k = 0; k < pixels.length; k++) {
    if (k % 4 === 3 && pixels[k] > 127) covered[(k - 3) / 4] = 1;
    sum = (sum * 31 + pixels[k]) | 0;
  }
  return { pixels, covered, sum, count: covered.reduce((a, b) => a + b, 0) };
}

function touch(type, x, y, more = {}) {
  const box = canvas.getBoundingClientRect();
  const at = { clientX: box.left + x, clientY: box.top + y, pointerId: 1, bubbles: true, ...more };
  canvas.dispatchEvent(new PointerEvent(type, at));
}

const checks = {
  "rows are those of the shape"() {
    const rows = shapes.rows(0);
    for (const [name, values] of Object.entries(given)) {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      assert(rows[name].length === values.length, name);
      values.forEach((value, j) => near(rows[name][j], value, 1e-4 * (high - low) + 1e-6, name, j));
    }
  },

  "points are where the matrix says"() {
    const one = camera();
    one.turn(0.4, -0.3);
    one.zoomAt(1.7, 30, -20);
    const m = one.matrix();
    for (const p of [[0, 0, 0], [0.1, -0.2, 0.3], [-0.05, 0.01, 0.2]]) {
      const [x, y] = one.project(...p);
      const clip = [0, 1].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
      near(x, (one.width * (1 + clip[0])) / 2, 1e-6);
      near(y, (one.height * (1 - clip[1])) / 2, 1e-6);
    }
  },

  "what is in front follows the hand"() {
    const one = camera();
    const front = one.centre.map((part, k) => part + 0.1 * one.towards[k]);
    const before = one.project(...front);
    one.turn(0.1, 0.2);
    const after = one.project(...front);
    assert(after[0] > before[0] + 1 && after[1] > before[1] + 1, before, after);
    for (const axis of [one.right, one.up, one.towards]) near(dot(axis, axis), 1, 1e-12);
    near(dot(cross(one.right, one.up), one.towards), 1, 1e-12);
  },

  "zoom keeps what is under the pointer"() {
    const one = camera();
    const p = [0.05, 0.02, 0.1];
    const before = one.project(...p);
    one.zoomAt(2.5, before[0] - one.width / 2, before[1] - one.height / 2);
    const after = one.project(...p);
    near(before[0], after[0], 1e-6);
    near(before[1], after[1], 1e-6);
  },

  "edges are as far as the half-width"() {
    const rows = shapes.rows(0);
    const mesh = makeMesh(rows, 0);
    for (let j = 0; j < rows.count; j += 7) {
      const way = [0, 1, 2].map((c) => (mesh.point(j, 2)[c] - mesh.point(j, 0)[c]) / 2);
      const along = way.reduce((sum, part, c) => sum + part * rows.d2[3 * j + c], 0);
      near(along, rows.width[j], 1e-5);
    }
    assert(mesh.faces.every((k) => k < 3 * rows.count));
  },

  async "the same picture with WebGL and without"() {
    assert(canvas.getContext("webgl2"), "no WebGL");
    const other = document.createElement("canvas");
    Object.assign(other, { width: canvas.width, height: canvas.height });
    const painter = makePainter(other);
    const mesh = makeMesh(shapes.rows(0), view.shapes[0].closing);
    mesh.size = 1;
    painter.load(mesh);
    painter.paint(new Float32Array(3 * mesh.count));
    const names = ["front", "back", "paper", "lines", "mark"];
    const look = Object.fromEntries(names.map((name) => [name, colours.named(`--${name}`)]));
    painter.draw(camera(), { ...look, back: look.front }, null);
    const [a, b] = [picture(), picture(other)];
    assert(a.count > 0.03 * a.covered.length, a.count);
    const differ = a.covered.reduce((sum, one, k) => sum + (one !== b.covered[k]), 0);
    assert(differ < 0.04 * a.count, differ, a.count);
    let bluer = 0; // than red: the ribbon has one side, and that is blue
    for (let k = 0; k < a.covered.length; k++) {
      bluer += a.covered[k] && a.pixels[4 * k + 2] >= a.pixels[4 * k];
    }
    assert(bluer > 0.98 * a.count, bluer, a.count);
  },

  async "drag turns, a double click takes it back"() {
    const first = picture().sum;
    touch("pointerdown", 200, 200, { buttons: 1 });
    touch("pointermove", 260, 230, { buttons: 1 });
    touch("pointerup", 260, 230);
    await frame();
    assert(picture().sum !== first, "not turned");
    canvas.dispatchEvent(new MouseEvent("dblclick"));
    await frame();
    assert(picture().sum === first, "not as before");
  },

  async "the ribbon marks the curves"() {
    const rows = shapes.rows(0);
    const one = camera();
    const heights = Array.from(rows.x, (x, j) => one.project(x, rows.y[j], rows.z[j])[2]);
    const j = heights.indexOf(Math.max(...heights)); // nothing lies before it
    touch("pointermove", ...one.project(rows.x[j], rows.y[j], rows.z[j]));
    near(parseFloat(foot().split(" ").at(-1)), rows.s[j], 0.02);
    touch("pointermove", 2, 2);
    assert(!/\d/.test(foot()), foot());
  },

  async "a curve marks the ribbon"() {
    const red = () => {
      const { pixels } = picture();
      let count = 0;
      for (let k = 0; k < pixels.length; k += 4) count += pixels[k] > 180 && pixels[k + 1] < 60;
      return count;
    };
    assert(red() === 0, "red before");
    const stage = document.querySelector(".strains .chart-stage");
    const box = stage.getBoundingClientRect();
    const at = { clientX: box.left + box.width / 2, clientY: box.top + 50, bubbles: true };
    stage.dispatchEvent(new PointerEvent("pointermove", at));
    await frame();
    assert(red() > 40, red());
    assert(/\d/.test(document.querySelector(".moments .chart-foot").textContent));
    stage.dispatchEvent(new PointerEvent("pointerleave", at));
    await frame();
    assert(red() === 0, "red after");
  },

  async "colours follow a field"() {
    const first = picture().sum;
    get("field").value = "u2";
    get("field").onchange();
    await frame();
    assert(picture().sum !== first);
    const [low, high] = view.ranges.u2;
    near(parseFloat(get("high").textContent), Math.max(-low, high), 0.02 * high);
    get("field").value = "";
    get("field").onchange();
    await frame();
    assert(picture().sum === first && get("scale").hidden);
  },

  async "the slider shows another shape"() {
    const [first, line] = [picture().sum, document.querySelector(".strains .line").getAttribute("d")];
    get("slider").value = 1;
    get("slider").oninput();
    await frame();
    assert(picture().sum !== first);
    assert(document.querySelector(".strains .line").getAttribute("d") !== line);
    assert(get("caption").textContent.startsWith(view.shapes[1].caption));
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    await frame();
    assert(picture().sum === first && get("slider").value === "0");
  },

  async "dark and light"() {
    const ink = () => getComputedStyle(document.body).color;
    const before = ink();
    get("theme").click();
    assert(ink() !== before);
    get("theme").click();
    assert(ink() === before);
  },

  "what is said is text"() {
    assert(get("facts").textContent.includes("<b>bold</b>"), get("facts").textContent);
    assert(!get("facts").querySelector("b") && !window.acted);
  },
};
