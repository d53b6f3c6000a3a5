"use strict";
// What lies over the picture: the lab's axes, a bar of a round length, what acts on the ribbon.
const SVG = "http://www.w3.org/2000/svg";

function svgNode(name, attributes, parent, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
}

function makeOverlay(svg) {
  const layer = svgNode("g", {}, svg);

  // A line with a head at its end.
  function arrow(from, way, className) {
    const size = Math.hypot(...way);
    if (size < 4) return;
    const [x, y] = [from[0] + way[0], from[1] + way[1]];
    const [u, v] = [way[0] / size, way[1] / size];
    const head = Math.min(7, 0.6 * size);
    const side = 0.38 * head;
    svgNode("path", { d: `M${from.join(" ")}L${x - u * head} ${y - v * head}`, class: className }, layer);
    const corners = [[x, y], [x - u * head - v * side, y - v * head + u * side],
      [x - u * head + v * side, y - v * head - u * side]];
    svgNode("path", { d: `M${corners.map((c) => c.join(" ")).join("L")}Z`, class: `${className} head` }, layer);
  }

  function triad(camera) {
    const origin = [camera.width - 46, camera.height - 44];
    const axes = [0, 1, 2].map((k) => [camera.right[k], -camera.up[k], camera.towards[k]]);
    const taken = [];
    axes.forEach(([x, y], k) => {
      const size = Math.hypot(x, y);
      arrow(origin, [30 * x, 30 * y], "axis");
      if (size < 0.15) return;
      const far = 30 + 9 / size;
      let [left, top] = [origin[0] + far * x, origin[1] + far * y + 4];
      while (taken.some(([a, b]) => Math.hypot(a - left, b - top) < 12)) top -= 12;
      taken.push([left, top]);
      svgNode("text", { x: left, y: top, class: "axis" }, layer, "xyz"[k]);
    });
  }

  function bar(camera, unitName) {
    const most = Math.min(0.25 * camera.width, 160) / camera.scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map((k) => k * power).find((value) => value <= most);
    const pixels = length * camera.scale;
    const y = camera.height - 16;
    svgNode("path", { d: `M16 ${y}h${pixels}m0 -4v8m${-pixels} 0v-8`, class: "bar" }, layer);
    const label = `${Number(length.toPrecision(1))}${unitName && ` ${unitName}`}`;
    svgNode("text", { x: 16 + pixels / 2, y: y - 7, class: "bar" }, layer, label);
  }

  // Forces and moments on the ribbon: `acting` has their places and, as vectors, their shares of the
  // largest of their kind.
  function acting(camera, list) {
    for (const { at, way, kind, press } of list || []) {
      const from = camera.project(...at).slice(0, 2);
      const length = kind === "density" ? 34 : 64;
      const seen = [length * dot(way, camera.right), -length * dot(way, camera.up)];
      const tail = press ? [from[0] - seen[0], from[1] - seen[1]] : from;
      arrow(tail, seen, kind);
      if (kind === "moment") arrow(tail, [0.86 * seen[0], 0.86 * seen[1]], kind); // with two heads
    }
  }

  return {
    resize: (camera) => svg.setAttribute("viewBox", `0 0 ${camera.width} ${camera.height}`),
    draw: (camera, shown, i) => {
      layer.replaceChildren();
      acting(camera, shown.shapes[i].acting);
      triad(camera);
      bar(camera, shown.units.length);
    },
  };
}
