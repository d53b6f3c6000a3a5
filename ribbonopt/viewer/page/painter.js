"use strict";
// Draws a ribbon where there is no WebGL: faces and lines sorted from far to near, on a flat canvas.
// The same calls as webgl.js; one face a row, so that it is quick enough to be turned.
function makePainter(canvas) {
  const pen = canvas.getContext("2d");
  let mesh;
  let places;
  const css = (rgb) => `rgb(${rgb.map((part) => Math.round(255 * Math.min(part, 1))).join(" ")})`;

  function lit(camera, look, j) {
    const at = 9 * j;
    const normal = mesh.normals.subarray(at, at + 3);
    let seen = [camera.right, camera.up, camera.towards].map((axis) => dot(axis, normal));
    let colour = seen[2] < 0 ? look.back : look.front;
    if (seen[2] < 0) seen = seen.map((part) => -part);
    if (look.stops) {
      colour = places[3 * j] < 0 ? [0.6, 0.6, 0.6] : colours.mixed(look.stops, places[3 * j]);
    }
    const pale = 0.45 * mesh.pale[3 * j];
    const diffuse = 0.55 + 0.45 * Math.max(dot(seen, unit([-0.45, 0.6, 0.66])), 0);
    return colour.map((part, c) => ((1 - pale) * part + pale * look.paper[c]) * diffuse + 0.02);
  }

  function segments(camera, list, style, lift) {
    const found = [];
    for (let k = 0; k < list.length; k += 7) {
      const from = camera.project(list[k], list[k + 1], list[k + 2]);
      const to = camera.project(list[k + 3], list[k + 4], list[k + 5]);
      found.push({ corners: [from, to], height: (from[2] + to[2]) / 2 + lift, ...style });
    }
    return found;
  }

  function paint(part) {
    pen.beginPath();
    part.corners.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    pen.strokeStyle = part.stroke;
    pen.globalAlpha = part.opacity ?? 1;
    pen.lineWidth = part.width;
    if (part.fill) {
      pen.closePath();
      pen.fillStyle = part.fill;
      pen.fill();
    }
    pen.stroke();
  }

  return {
    lost: () => {},
    load: (given) => (mesh = given),
    paint: (given) => (places = given),
    draw: (camera, look, marked) => {
      const ratio = canvas.width / camera.width;
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.clearRect(0, 0, camera.width, camera.height);
      const at = (j, k) => camera.project(...mesh.point(j, k));
      const parts = [];
      for (let j = 0; j + 1 < mesh.count; j++) {
        const corners = [at(j, 0), at(j, 2), at(j + 1, 2), at(j + 1, 0)];
        const height = corners.reduce((sum, corner) => sum + corner[2], 0) / 4;
        const fill = css(lit(camera, look, j));
        parts.push({ corners, height, fill, stroke: fill, width: 1 });
      }
      const stroke = css(look.lines);
      const lift = 0.02 * mesh.size;
      parts.push(...segments(camera, mesh.across, { stroke, width: 0.6, opacity: 0.45 }, lift));
      parts.push(...segments(camera, mesh.centre, { stroke, width: 0.9 }, lift));
      parts.push(...segments(camera, mesh.edges, { stroke, width: 0.9 }, lift));
      parts.sort((a, b) => a.height - b.height).forEach(paint);
      const style = { stroke: css(look.mark), width: 2.4, opacity: 0.9 };
      if (marked) segments(camera, marked, style, 0).forEach(paint);
      pen.globalAlpha = 1;
    },
  };
}
