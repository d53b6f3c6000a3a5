"use strict";
// The frame of a chart: how large its plot is, where values lie in it, its grid and its ticks.
//
// frame.layout(asked, width, height) -> { width, height, left, w, h, xa, ya, X(v), Y(v), spot(i) }
//   in pixels, of the plot from its upper left corner; null where there is no room. `asked` is what
//   charts.plot was given, spot(i) the place of a point of the cloud.
// frame.grid(svg, layout) draws lines and texts.
const frame = (() => {
  const FONT = "11px system-ui, sans-serif";
  const HEAD = 8;
  const FOOT = 22;
  const SIDE = 10;
  const GAP = 6; // pixels around the plot

  function node(tag, attributes, parent) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes))
      if (value !== undefined) made.setAttribute(name, value);
    if (parent) parent.append(made);
    return made;
  }

  function part(tag, className, parent) {
    const made = document.createElement(tag);
    made.className = className;
    parent.append(made);
    return made;
  }

  function layout(asked, width, height) {
    if (!width || !height) return null;
    const all = [...(asked.series || []), ...(asked.cloud ? [asked.cloud] : [])];
    const spots = asked.points || [];
    const of = (key) => [...all.map((s) => s[key]), spots.map((p) => p[key])];
    const x = { values: of("x"), range: asked.xRange, log: asked.xLog, words: asked.xWords };
    const y = { values: of("y"), range: asked.yRange, log: asked.yLog, words: asked.yWords };
    const h = height - HEAD - FOOT;
    y.most = Math.max(2, Math.floor(h / 34));
    let ya = axes.make(y);
    const letters = width < 600 ? 12 : 22;
    const widest = () =>
      Math.max(14, ...ya.ticks.map(({ text }) => axes.width(axes.short(text, letters), FONT)));
    const left = Math.ceil(widest()) + GAP + 4;
    const w = Math.max(width - left - SIDE, 20);
    x.most = Math.max(2, Math.floor(w / 62));
    let xa = axes.make(x);
    if (asked.equal) {
      const per = Math.max((xa.high - xa.low) / w, (ya.high - ya.low) / h);
      const wide = ({ low, high }, pixels) => [
        (low + high - per * pixels) / 2,
        (low + high + per * pixels) / 2,
      ];
      [xa, ya] = [axes.make({ ...x, range: wide(xa, w) }), axes.make({ ...y, range: wide(ya, h) })];
    }
    const X = (v) => xa.place(v) * w;
    const Y = (v) => (1 - ya.place(v)) * h;
    return { width, height, left, w, h, xa, ya, letters, X, Y, spot: (i) => spot(asked.cloud, i, X, Y, h) };
  }

  // Pixels of a point of the cloud.
  function spot({ x, y, edge }, i, X, Y, h) {
    const px = X(x[i]);
    const py = Y(y[i]);
    const lacks = [px, py].map(Number.isNaN);
    if (lacks[0] === lacks[1] || !edge?.(i)) return [px, py];
    return lacks[0] ? [0, py] : [px, h];
  }

  function grid(whole, box) {
    const { w, h, xa, ya, letters } = box;
    const line = (d, at, axis) => {
      const zero = !axis.words && Math.abs(axis.value(at)) < 1e-9 * (axis.high - axis.low);
      node("path", { d, class: zero ? "grid zero" : "grid" }, whole);
    };
    const write = (at, text, full) => {
      const made = node("text", at, whole);
      made.textContent = text;
      if (full !== text) node("title", {}, made).textContent = full;
    };
    let last = -Infinity;
    const room = xa.words ? Math.max(6, Math.floor(w / Math.max(xa.ticks.length, 1) / 7)) : 99;
    for (const { at, text } of xa.ticks) {
      const px = at * w;
      const short = axes.short(text, room);
      const half = axes.width(short, FONT) / 2;
      line(`M${px} 0V${h}`, at, xa);
      if (px - half < last + 8 || px + half > w + SIDE) continue; // no room for it
      last = px + half;
      write({ x: px, y: h + 17, "text-anchor": "middle" }, short, text);
    }
    last = Infinity;
    for (const { at, text } of ya.ticks) {
      const py = (1 - at) * h;
      line(`M0 ${py}H${w}`, at, ya);
      if (py > last - 15) continue;
      last = py;
      write({ x: -GAP, y: py + 4, "text-anchor": "end" }, axes.short(text, letters), text);
    }
  }

  return { HEAD, node, part, layout, grid };
})();
