"use strict";
// Charts as SVG, with a canvas over them where there are thousands of points.
//
// const chart = charts.plot(element, {
//   xLabel, yLabel, xLog, yLog, equal,      // equal: the same scale along both axes
//   xRange, yRange,                         // [low, high]; without, all that is drawn is seen
//   xWords, yWords,                         // the words that 0, 1, ... stand for
//   series: [{ x, y, name, className, dashed, smooth, corners, tx, ty, of }],
//   points: [{ x, y, mark, className, title }],  // "dot", "square", "diamond", "triangle", "cross"
//   regions: [{ x, y, className }],         // filled, cut off at the axes, do not set their ends
//   cloud: { x, y, colour(i), cross(i), edge(i) }, // on the canvas; NaN: not drawn, but on the axis
//                                           // if `edge` says so and the other value is known
//   parts(svg, X, Y, node),                 // draws more with functions from values to pixels
//   pick,                                   // "x": the nearest along x, "xy": the nearest point
//   tip(index, series),                     // text beside the pointer; without, values in the head
//   onHover(index, series), onLeave(), onClick(index, series),
// });
// chart.mark(index | null, series?)         // without series: this index in all of them
// chart.update({ series, ... })             // new data on the same axes object
//
// A series is called by its place, the cloud is "cloud". A class sets `color`: curves, marks and
// legend follow it (charts.css). `smooth`: through the points, but for `corners`, indices; tx, ty:
// with these directions of the curve at its points; of(index): class of the mark at a point.
const charts = (() => {
  const { HEAD, node, part } = frame;
  const MARKS = {
    square: "M-4-4H4V4H-4Z",
    diamond: "M0-5.5L5.5 0L0 5.5L-5.5 0Z",
    triangle: "M-5-4H5L0 5Z",
    cross: "M-4-4L4 4M-4 4L4-4",
    dot: "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0-4.5 0Z",
  };

  function plot(element, options) {
    let asked = { ...options };
    let box = null;
    let marked = null;
    element.classList.add("chart");
    element.replaceChildren();
    const head = part("div", "chart-head", element);
    const stage = part("div", "chart-stage", element);
    const foot = part("div", "chart-foot", element);
    const said = part("output", "unseen", element);
    const svg = node("svg", { tabindex: 0, role: "application", "aria-roledescription": "chart" }, stage);
    const canvas = asked.cloud ? part("canvas", "", stage) : null;
    const tip = part("div", "chart-tip", stage);
    const readings = [];
    tip.hidden = true;

    function update(more) {
      asked = { ...asked, ...more };
      svg.setAttribute("aria-label", `${asked.yLabel} against ${asked.xLabel}`);
      title();
      draw();
    }

    // The quantity along y and the names of the series; beside each, its value at the mark.
    function title() {
      const named = (asked.series || []).filter(({ name }) => name);
      head.replaceChildren();
      readings.length = 0;
      const entry = (text, className, k) => {
        const span = part("span", className, head);
        if (className !== "chart-y") part("i", "", span);
        part("span", "", span).textContent = text;
        if (!asked.tip && k !== null) readings.push([part("b", "", span), k]);
      };
      entry(asked.yLabel || "", "chart-y", named.length ? null : 0);
      (asked.series || []).forEach(({ name, className, dashed }, k) => {
        if (name) entry(name, `chart-name ${className || ""} ${dashed ? "dashed" : ""}`, k);
      });
    }

    function draw() {
      box = frame.layout(asked, stage.clientWidth, stage.clientHeight);
      if (!box) return;
      const { width, height, left, w, h, X, Y } = box;
      svg.replaceChildren();
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      const whole = node("g", { transform: `translate(${left} ${HEAD})` }, svg);
      frame.grid(whole, box);
      const inner = node("svg", { width: w, height: h, overflow: "hidden" }, whole);
      for (const { x, y, className } of asked.regions || []) {
        node("path", { d: `${paths.straight(pixels(x, y))}Z`, class: `region ${className || ""}` }, inner);
      }
      box.placed = (asked.series || []).map((one) => {
        const spots = pixels(one.x, one.y);
        let d = one.smooth ? paths.smooth(spots, one.corners) : paths.straight(spots);
        if (one.tx) d = paths.along(spots, directions(one));
        node("path", { d, class: `line ${one.className || ""} ${one.dashed ? "dashed" : ""}` }, inner);
        return spots;
      });
      if (asked.parts) asked.parts(inner, X, Y, node);
      for (const { x, y, mark, className, title: text } of asked.points || []) {
        if (!paths.isThere([X(x), Y(y)])) continue;
        const at = {
          d: MARKS[mark] || MARKS.dot,
          transform: `translate(${X(x)} ${Y(y)})`,
          class: `point ${mark || "dot"} ${className || ""}`,
        };
        const drawn = node("path", at, whole);
        if (text) node("title", {}, drawn).textContent = text;
      }
      box.marks = node("g", { class: "marks" }, whole);
      if (canvas) cloud.draw(canvas, asked.cloud, box, HEAD);
      mark(...(marked || [null]));
    }

    const pixels = (x, y) => Array.from(y, (v, i) => [box.X(x[i]), box.Y(v)]);

    function directions({ x, y, tx, ty }) {
      const { xa, ya, w, h } = box;
      const along = (t, v, axis) => (axis.log ? t / v / Math.LN10 : t) / (axis.high - axis.low);
      return Array.from(x, (v, i) => [along(tx[i], v, xa) * w, -along(ty[i], y[i], ya) * h]);
    }

    function mark(index, series) {
      marked = index === null ? null : [index, series];
      if (!box) return;
      box.marks.replaceChildren();
      readings.forEach(([place]) => (place.textContent = ""));
      foot.textContent = asked.xLabel || "";
      if (index === null) return;
      const spots = series === "cloud" ? [] : box.placed.map((own, k) => [k, own[index]]);
      const seen = spots.filter(([k, p]) => p && paths.isThere(p) && (series === undefined || series === k));
      if (asked.cloud) seen.push(["cloud", box.spot(index)]);
      seen.forEach(([k, [px, py]], i) => {
        const { x, className, of } = asked.series?.[k] || asked.cloud;
        if (!i && along()) node("path", { d: `M${px} 0V${box.h}`, class: "hair" }, box.marks);
        if (py - py === 0)
          node(
            "circle",
            { cx: px, cy: py, r: k === "cloud" ? 7 : 4.5, class: of?.(index) ?? className ?? "" },
            box.marks,
          );
        if (!i && !asked.tip) foot.textContent = `${asked.xLabel} ${axes.say(x[index], 4)}`;
      });
      if (!asked.tip) readings.forEach(([place, k]) => (place.textContent = reading(index, k)));
    }

    // What a named curve says at a point, or its other part of the same class.
    function reading(index, k) {
      const { className } = asked.series?.[k] || {};
      const own = (asked.series || []).filter(
        (one, j) => j === k || (className && one.className === className),
      );
      const there = own.find(({ y }) => axes.known(y[index]));
      return there ? axes.say(there.y[index], 4) : "";
    }

    const along = () =>
      (asked.pick || (pointer.ordered(asked.series || []) ? "x" : "xy")) === "x" && !asked.cloud;

    function told(index, series) {
      if (asked.tip) return asked.tip(index, series);
      return [
        foot.textContent,
        ...[...head.children].map((entry) =>
          [...entry.children]
            .map((part) => part.textContent)
            .join(" ")
            .trim(),
        ),
      ].join(", ");
    }

    const chart = { mark, update, element };
    pointer.follow({
      svg,
      stage,
      tip,
      said,
      chart,
      told,
      asked: () => asked,
      box: () => box,
      along,
      head: HEAD,
    });
    new ResizeObserver(draw).observe(stage);
    if (canvas) cloud.onTheme(draw);
    update({});
    return chart;
  }

  return { plot, node, part, MARKS };
})();
