"use strict";
// Thousands of points of a chart, on a canvas: ten thousand stay quick.
const cloud = (() => {
  // `begin` and `end` are told of each drawing, and how many points and crosses there are.
  function draw(canvas, { x, colour, cross, begin, end }, { width, height, left, spot }, head) {
    const dots = window.devicePixelRatio || 1;
    const pen = canvas.getContext("2d");
    [canvas.width, canvas.height] = [Math.round(width * dots), Math.round(height * dots)];
    pen.setTransform(dots, 0, 0, dots, left * dots, head * dots);
    const size = x.length > 2000 ? 2 : x.length > 400 ? 2.6 : 3.6;
    const crosses = [];
    let count = 0;
    begin?.();
    for (let i = 0; i < x.length; i++) {
      const [px, py] = spot(i);
      if (px - px !== 0 || py - py !== 0) continue;
      count++;
      if (cross && cross(i)) {
        crosses.push([px, py, i]);
        continue;
      }
      pen.fillStyle = colour(i);
      pen.beginPath();
      pen.arc(px, py, size, 0, 7);
      pen.fill();
    }
    pen.lineWidth = 1.5;
    for (const [px, py, i] of crosses) {
      pen.strokeStyle = colour(i);
      pen.beginPath();
      for (const s of [-4, 4]) {
        pen.moveTo(px - s, py - 4);
        pen.lineTo(px + s, py + 4);
      }
      pen.stroke();
    }
    end?.(count, crosses.length);
  }

  // What is on a canvas does not follow the style sheet by itself.
  function onTheme(draw) {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
    const watched = { attributes: true, attributeFilter: ["class", "style", "data-theme"] };
    new MutationObserver(draw).observe(document.documentElement, watched);
  }

  return { draw, onTheme };
})();
