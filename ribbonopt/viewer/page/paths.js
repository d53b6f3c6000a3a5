"use strict";
// Curves as SVG paths: straight from point to point, or smooth through points of which nothing more
// is known. Points are pixels [x, y]; where one is NaN the curve is interrupted.
//
// paths.straight(points), paths.smooth(points, corners), paths.along(points, tangents) -> text of d
// paths.parts(points, corners) -> the piece from each point to the next, "" at gaps
const paths = (() => {
  const STEEPEST = 3; // slope over that of the chord, at which cubic curves go one way still
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const isThere = (p) => p[0] - p[0] === 0 && p[1] - p[1] === 0;
  const digits = (v) => Math.round(v * 10) / 10; // of a pixel
  const text = (...points) => points.map((p) => `${digits(p[0])} ${digits(p[1])}`).join(" ");

  // A point alone is a dot, where lines have round ends.
  const dotted = (d) => d.replace(/M([^MLC]+)(?=M|$)/g, "M$1h0");

  function straight(points) {
    let found = "";
    let pen = "M";
    for (const p of points) {
      if (isThere(p)) [found, pen] = [found + pen + text(p), "L"];
      else pen = "M";
    }
    return dotted(found);
  }

  // Through points with given directions of the curve, in pixels; their lengths do not matter.
  function along(points, tangents) {
    let found = "";
    for (let i = 0; i < points.length; i++) {
      if (!isThere(points[i])) continue;
      const joined = i > 0 && isThere(points[i - 1]);
      found += joined
        ? bent(points[i - 1], points[i], unit(tangents[i - 1]), unit(tangents[i]))
        : "M" + text(points[i]);
    }
    return found;
  }

  function smooth(points, corners = []) {
    let found = "";
    let joined = false;
    const pieces = parts(points, corners);
    points.forEach((p, i) => {
      if (!isThere(p)) return;
      found += (joined ? "" : `M${text(p)}`) + (pieces[i] || "");
      joined = Boolean(pieces[i]);
    });
    return dotted(found);
  }

  // Cubic curves in the chord length. The tangent at a point is that of the parabola through its
  // neighbours; along an axis that the points go along one way the curves do so too.
  function parts(points, corners = []) {
    const found = new Array(Math.max(points.length - 1, 0)).fill("");
    const cuts = new Set(corners);
    let run = [];
    const end = () => {
      if (run.length > 1) {
        const own = run.map((i) => points[i]);
        const tangents = tangentsOf(own);
        for (let k = 1; k < own.length; k++)
          found[run[k - 1]] = bent(own[k - 1], own[k], tangents[k - 1], tangents[k]);
      }
      run = [];
    };
    for (let i = 0; i < points.length; i++) {
      if (!isThere(points[i])) end();
      else {
        run.push(i);
        if (cuts.has(i)) (end(), run.push(i));
      }
    }
    end();
    return found;
  }

  function bent(a, b, out, into) {
    const third = Math.hypot(...minus(b, a)) / 3;
    return (
      "C" +
      text(
        [a[0] + third * out[0], a[1] + third * out[1]],
        [b[0] - third * into[0], b[1] - third * into[1]],
        b,
      )
    );
  }

  function unit(way) {
    const length = Math.hypot(...way);
    return length > 0 ? way.map((v) => v / length) : [0, 0];
  }

  function tangentsOf(points) {
    const ways = points.slice(1).map((p, i) => minus(p, points[i]));
    const chords = ways.map((way) => Math.max(Math.hypot(...way), 1e-9));
    const towards = ways.map((way, i) => way.map((v) => v / chords[i]));
    const last = ways.length;
    const inner = (i) =>
      [0, 1].map(
        (k) => (chords[i] * towards[i - 1][k] + chords[i - 1] * towards[i][k]) / (chords[i - 1] + chords[i]),
      );
    const end = (way, next) => {
      const found = [0, 1].map((k) => 2 * way[k] - next[k]);
      return Math.hypot(...found) > 1 ? unit(found) : found;
    };
    if (last === 1) return [towards[0], towards[0]];
    const found = points.map((_, i) => (i === 0 || i === last ? null : inner(i)));
    found[0] = end(towards[0], found[1]);
    found[last] = end(towards[last - 1], found[last - 1]);
    return found.map((tangent, i) => oneWay(tangent, i, towards));
  }

  // No steeper along an axis than curves that go one way there have (Fritsch and Carlson); next to
  // where points turn nothing is asked: there it would flatten what is round.
  function oneWay(tangent, i, towards) {
    const near = [i - 2, i - 1, i, i + 1].map((j) => towards[Math.min(Math.max(j, 0), towards.length - 1)]);
    return tangent.map((v, k) => {
      const around = near.map((way) => way[k]);
      const most = STEEPEST * Math.min(Math.abs(around[1]), Math.abs(around[2]));
      if (around.every((w) => w > 0)) return Math.min(Math.max(v, 0), most);
      if (around.every((w) => w < 0)) return Math.max(Math.min(v, 0), -most);
      return v;
    });
  }

  return { straight, smooth, along, parts, text, isThere };
})();
