"use strict";
// Checks of the scripts that draw charts, run in a browser by test_charts_scripts.py: each throws
// where something is wrong. Numbers here are worked out by hand or from what curves are.
const assert = (truth, ...said) => {
  if (!truth) throw new Error(said.map((one) => JSON.stringify(one)).join(" "));
};
const near = (a, b, within) => assert(Math.abs(a - b) <= within, a, b, within);
const range = (n) => Array.from({ length: n }, (_, i) => i);

function place(width = 500, height = 260) {
  const made = document.createElement("div");
  made.style.cssText = `width: ${width}px; height: ${height}px`;
  document.body.replaceChildren(made);
  return made;
}

// Points of cubic curves "Cx y x y x y..." from a start.
function bezier(start, d, count = 20) {
  const n = d.slice(1).split(/[ C]+/).map(Number), p = [start, [n[0], n[1]], [n[2], n[3]], [n[4], n[5]]];
  return range(count + 1).map((k) => {
    const t = k / count, w = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3];
    return [0, 1].map((c) => w.reduce((sum, share, i) => sum + share * p[i][c], 0));
  });
}

// Texts of a chart lie beside each other and within it.
function apart(chart, ...said) {
  const boxes = [...chart.element.querySelectorAll("svg text")].map((one) => one.getBoundingClientRect());
  assert(boxes.length > 3, ...said);
  boxes.forEach((a, i) => boxes.slice(0, i).forEach((b) => {
    assert(a.left >= b.right || b.left >= a.right || a.top >= b.bottom - 2 || b.top >= a.bottom - 2, ...said, a, b);
  }));
  const own = chart.element.getBoundingClientRect();
  for (const { left, right } of boxes) assert(left >= own.left - 1 && right <= own.right + 1, ...said, left, right);
}

const point = (chart, i, k = 0) => {
  chart.mark(i, k);
  const { x, y, width, height } = chart.element.querySelector(".marks circle").getBoundingClientRect();
  chart.mark(null);
  return { clientX: x + width / 2, clientY: y + height / 2 };
};
const over = (chart, at, type = "pointermove") =>
  chart.element.querySelector(".chart-stage").dispatchEvent(new PointerEvent(type, { bubbles: true, ...at }));
const press = (chart, key) =>
  chart.element.querySelector("svg").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));

const checks = {
  "ticks are round, few and say what they are"() {
    for (const [low, high] of [[0, 1], [-3.7, 12.2], [1e-9, 4e-9], [999.9991, 999.9998], [-2e6, 7e7], [0.11, 0.13]]) {
      for (const most of [2, 4, 7]) {
        const axis = axes.make({ values: [[low, high]], most });
        assert(axis.ticks.length >= 1 && axis.ticks.length <= most + 1, low, high, most, axis.ticks);
        for (const { at, text } of axis.ticks) near(Number(text.replaceAll("−", "-")), axis.value(at), 1e-3 * (high - low));
        assert(new Set(axis.ticks.map(({ text }) => text)).size === axis.ticks.length, axis.ticks);
        const steps = axis.ticks.slice(1).map(({ at }, i) => axis.value(at) - axis.value(axis.ticks[i].at));
        for (const step of steps) assert(/^[125]0*$/.test(step.toPrecision(6).replace(/[.]|e.*$/g, "").replace(/^0+/, "")), step);
      }
    }
  },
  "powers have powers of ten"() {
    const axis = axes.make({ values: [[1e-9, 1e-3]], log: true, most: 8 });
    for (const { at } of axis.ticks) near(Math.log10(axis.value(at)) % 1, 0, 1e-9);
    near(axis.place(1e-6), 0.5, 1e-9);
  },
  "what is flat lies in the middle, what is missing nowhere"() {
    for (const v of [0, 1, -7e5, 1e-12]) near(axes.make({ values: [[v, v + 1e-13 * Math.abs(v)]] }).place(v), 0.5, 1e-6);
    const axis = axes.make({ values: [[null, NaN, 2, 4, Infinity]] });
    assert(Number.isNaN(axis.place(null)) && Number.isNaN(axis.place(NaN)));
    near(axis.place(3), 0.5, 1e-9);
    assert(axes.make({ values: [[]] }).place(0.5) === 0.5);
  },
  "numbers in few digits"() {
    for (const [v, text] of [[-0.5, "−0.5"], [1e-7, "1e−7"], [2.5e8, "2.5e8"], [0.1 + 0.2, "0.3"], [null, "none"]]) {
      assert(axes.say(v) === text, v, axes.say(v));
    }
  },
  "smooth curves go through their points and are round where points are"() {
    const circle = range(13).map((i) => [100 + 80 * Math.cos(i / 2.2), 100 + 80 * Math.sin(i / 2.2)]);
    const parts = paths.parts(circle);
    parts.slice(1, -1).forEach((part, i) => {
      const curve = bezier(circle[i + 1], part);
      near(curve.at(-1)[0], circle[i + 2][0], 0.051);
      for (const [x, y] of curve) near(Math.hypot(x - 100, y - 100), 80, 0.6);
    });
  },
  "smooth curves do not leave what goes one way"() {
    const steep = [[0, 0], [10, 0.5], [20, 1], [21, 90], [40, 91], [60, 92]];
    const curve = paths.parts(steep).flatMap((part, i) => bezier(steep[i], part));
    curve.slice(1).forEach(([x, y], i) => assert(x >= curve[i][0] - 0.06 && y >= curve[i][1] - 0.06, curve[i], x, y));
  },
  "corners are corners and gaps are gaps"() {
    const corner = [[0, 20], [10, 10], [20, 0], [30, 10], [40, 20]];
    paths.parts(corner, [2]).forEach((part, i) => {
      for (const [x, y] of bezier(corner[i], part)) near(y, Math.abs(x - 20), 0.06);
    });
    assert(!bezier(corner[1], paths.parts(corner)[1]).every(([x, y]) => Math.abs(y - Math.abs(x - 20)) < 0.06));
    const gap = [[0, 0], [1, 1], [NaN, 2], [3, 3], [4, 4]];
    assert(paths.straight(gap) === "M0 0L1 1M3 3L4 4", paths.straight(gap));
    assert(paths.smooth(gap).match(/M/g).length === 2);
    assert(paths.straight([[0, 0], [NaN, 0], [2, 2], [3, 3]]).startsWith("M0 0h0M"));
  },
  "given tangents are followed"() {
    const x = range(7).map((i) => i / 2), s = { x, y: x.map(Math.sin), tx: x.map(() => 1), ty: x.map(Math.cos) };
    const chart = charts.plot(place(), { xLabel: "x", yLabel: "y", series: [s] });
    const path = chart.element.querySelector(".line"), total = path.getTotalLength();
    const a = point(chart, 0), b = point(chart, 2), seen = path.getScreenCTM();
    for (const k of range(21)) {
      const at = new DOMPoint(...["x", "y"].map((c) => path.getPointAtLength((total * k) / 20)[c])).matrixTransform(seen);
      const x = (at.x - a.clientX) / (b.clientX - a.clientX);
      near(((at.y - a.clientY) / (b.clientY - a.clientY)) * Math.sin(1), Math.sin(x), 0.004);
    }
  },
  "labels do not overlap"() {
    for (const width of [180, 390, 1400]) {
      for (const values of [[-123456.7, 0.5], [1e-12, 3e-12], [1000.0001, 1000.0003], [1, 2]]) {
        const chart = charts.plot(place(width), { xLabel: "x", yLabel: "y", series: [{ x: values, y: values }] });
        apart(chart, width, values);
      }
      const words = range(40).map((i) => `a word ${"of some length ".repeat(i % 4)}${i}`), one = range(40);
      apart(charts.plot(place(width), { xLabel: "x", yLabel: "y", xWords: words, yWords: words, series: [{ x: one, y: one }] }), width);
    }
  },
  "a pointer finds the nearest point, and leaves"() {
    const told = [], x = range(50).map((i) => i / 49);
    const chart = charts.plot(place(), {
      xLabel: "s", yLabel: "u", series: [{ x, y: x.map((v) => v * v), name: "u2" }, { x, y: x.map((v) => -v), name: "u3" }],
      onHover: (i) => told.push(i), onLeave: () => told.push("left"), onClick: (i) => told.push(`click ${i}`),
    });
    const { clientX, clientY } = point(chart, 31);
    over(chart, { clientX, clientY: clientY + 60 });
    over(chart, { clientX: clientX + 0.5, clientY: clientY + 60 });
    over(chart, { clientX, clientY }, "click");
    assert(chart.element.querySelectorAll(".marks circle").length === 2);
    assert(chart.element.querySelector(".chart-foot").textContent === `s ${axes.say(31 / 49, 4)}`);
    assert(chart.element.querySelector(".chart-head").textContent.includes(axes.say((31 / 49) ** 2, 4)));
    over(chart, {}, "pointerleave");
    assert(JSON.stringify(told) === '[31,"click 31","left"]', told);
    assert(!chart.element.querySelector(".marks").children.length);
  },
  "keys move the mark"() {
    const told = [], x = [0, 1, 2, 3];
    const chart = charts.plot(place(), { xLabel: "s", yLabel: "u", series: [{ x, y: x }], onHover: (i) => told.push(i), onLeave: () => told.push("left"), onClick: (i) => told.push(-i) });
    for (const key of ["ArrowRight", "ArrowRight", "End", "ArrowLeft", "Enter", "Escape", "End", "Home", "a"]) press(chart, key);
    assert(JSON.stringify(told) === '[0,1,3,2,-2,"left",3,0]', told);
    assert(chart.element.querySelector("output").textContent.startsWith("s 0"));
  },
  "the same scale on both axes"() {
    const chart = charts.plot(place(600, 200), { xLabel: "a", yLabel: "b", equal: true, series: [{ x: [0, 1, 0], y: [0, 0, 1] }] });
    const [a, b, c] = [0, 1, 2].map((i) => point(chart, i));
    near(b.clientX - a.clientX, a.clientY - c.clientY, 0.1);
  },
  "a cloud has every point, crosses, and what lacks a value on the axis"() {
    const cloud = { x: [0, 1, 2, 3], y: [0, 1, NaN, NaN], colour: () => "#ff0000", cross: (i) => i > 1, edge: (i) => i === 2 };
    const chart = charts.plot(place(), { xLabel: "a", yLabel: "b", cloud, tip: String });
    const canvas = chart.element.querySelector("canvas"), pen = canvas.getContext("2d"), frame = canvas.getBoundingClientRect();
    const scale = canvas.width / frame.width;
    const red = (i, right = 0) => {
      const { clientX, clientY } = point(chart, i, "cloud");
      return pen.getImageData((clientX - frame.x + right) * scale, (clientY - frame.y) * scale, 1, 1).data[3] > 100;
    };
    assert(red(0) && red(1) && red(2));
    assert(red(0, 2.5) && red(1, 2.5) && !red(2, 2.5)); // dots, and a cross
    near(point(chart, 2, "cloud").clientX - point(chart, 1, "cloud").clientX, point(chart, 1, "cloud").clientX - point(chart, 0, "cloud").clientX, 0.1);
    chart.mark(3, "cloud");
    assert(!chart.element.querySelectorAll(".marks circle").length);
  },
  "nothing to draw is drawn as nothing"() {
    for (const series of [[], [{ x: [], y: [] }], [{ x: [NaN], y: [1] }], [{ x: [1], y: [2] }]]) {
      const chart = charts.plot(place(), { xLabel: "a", yLabel: "b", series });
      chart.mark(0);
      press(chart, "ArrowRight");
      over(chart, { clientX: 100, clientY: 100 });
      chart.update({ series: [{ x: [0, 1], y: [0, 1] }] });
      assert(chart.element.querySelector(".line").getAttribute("d").includes("L"));
    }
  },
};
