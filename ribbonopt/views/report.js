"use strict";
// Scatter of any two columns of the rows, drawn on a canvas: ten thousand points stay quick.
const { names, numeric, rows, status, defaults } = JSON.parse(document.getElementById("data").textContent);
const el = (id) => document.getElementById(id);
const canvas = document.querySelector("canvas"), pen = canvas.getContext("2d");
const STYLE = getComputedStyle(document.documentElement);
const colour = (name) => STYLE.getPropertyValue(name).trim();
const PALETTE = ["#1f5fa8", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#777777"];
const PAD = { left: 74, right: 96, top: 12, bottom: 46 };
let points = [];

for (const id of ["x", "y", "c"]) {
  const all = id === "c" ? ["(one colour)", ...names] : names;
  all.forEach((name) => el(id).add(new Option(name)));
  el(id).value = defaults[id] ?? all[0];
}
el("lx").checked = defaults.lx;
el("ly").checked = defaults.ly;
for (const id of ["x", "y", "c", "lx", "ly"]) el(id).onchange = draw;
el("plot").hidden = false;
window.onresize = draw;
draw();

// What a column says of a row: a number, or the place of a word among the words of the column.
function column(name) {
  const at = names.indexOf(name);
  const raw = rows.map((row) => row[at]);
  if (numeric[at]) return { values: raw, words: null };
  const words = [...new Set(raw.filter((value) => value !== null).map(String))];
  return { values: raw.map((value) => (value === null ? null : words.indexOf(String(value)))), words };
}

function scale(name, log, from, to) {
  const { values, words } = column(name);
  const given = values.filter((value) => value !== null && (!log || value > 0));
  let low = Math.min(...given), high = Math.max(...given);
  if (!given.length) [low, high] = [0, 1];
  const f = log && !words && given.length ? Math.log10 : (value) => value;
  let [a, b] = [f(low), f(high)];
  const margin = (b - a || Math.abs(a) || 1) * 0.04;
  [a, b] = words ? [-0.5, words.length - 0.5] : [a - margin, b + margin];
  const place = (value) =>
    value === null || (f !== Math.log10 ? false : value <= 0) ? null : from + ((f(value) - a) / (b - a)) * (to - from);
  return { values, words, place, ticks: words ? words.map((_, i) => i) : ticks(a, b, f === Math.log10) };
}

function ticks(a, b, log) {
  const step = 10 ** Math.floor(Math.log10((b - a) / 4));
  const nice = [1, 2, 5, 10].find((m) => (b - a) / (m * step) <= 6) * step;
  const found = [];
  if (log && b - a > 1.5) {
    for (let e = Math.ceil(a); e <= b; e += Math.ceil((b - a) / 8)) found.push(10 ** e);
  } else {
    for (let k = Math.ceil(a / nice); k * nice <= b; k++) found.push(log ? 10 ** (k * nice) : k * nice);
  }
  return found;
}

function label(value, words) {
  const text = words ? words[value] : Number(value.toPrecision(4)).toString();
  return text.length > 14 ? text.slice(0, 13) + "…" : text;
}

function shades(name) {
  if (name === "(one colour)") return { of: () => PALETTE[0] };
  const { values, words } = column(name);
  if (words) return { of: (i) => PALETTE[values[i] % PALETTE.length] ?? colour("--none"), words };
  const given = values.filter((value) => value !== null);
  const low = Math.min(...given), high = Math.max(...given);
  const shade = (t) => `hsl(${250 - 210 * t} 70% ${38 + 16 * t}%)`;
  const of = (i) => (values[i] === null ? colour("--none") : shade((values[i] - low) / (high - low || 1)));
  return { of, shade, low, high };
}

function draw() {
  const width = canvas.clientWidth, height = canvas.clientHeight, dots = window.devicePixelRatio || 1;
  canvas.width = width * dots;
  canvas.height = height * dots;
  pen.setTransform(dots, 0, 0, dots, 0, 0);
  pen.font = "12px system-ui, sans-serif";
  const right = width - PAD.right, bottom = height - PAD.bottom;
  const x = scale(el("x").value, el("lx").checked, PAD.left, right);
  const y = scale(el("y").value, el("ly").checked, bottom, PAD.top);
  axes(x, y, right, bottom);
  const shade = shades(el("c").value);
  points = [];
  rows.forEach((_, i) => {
    const failed = !status[i];
    let [px, py] = [x.place(x.values[i]), y.place(y.values[i])];
    if (failed && px !== null && py === null) py = bottom; // it has inputs, and no answer
    if (failed && py !== null && px === null) px = PAD.left;
    if (px !== null && py !== null) points.push([px, py, i, failed]);
  });
  const size = points.length > 2000 ? 2 : 3.2;
  for (const [px, py, i, failed] of points) {
    if (failed) continue;
    pen.fillStyle = shade.of(i);
    pen.beginPath();
    pen.arc(px, py, size, 0, 7);
    pen.fill();
  }
  pen.strokeStyle = colour("--bad");
  pen.lineWidth = 1.6;
  for (const [px, py, , failed] of points) {
    if (!failed) continue;
    pen.beginPath();
    for (const s of [1, -1]) {
      pen.moveTo(px - 4, py - 4 * s);
      pen.lineTo(px + 4, py + 4 * s);
    }
    pen.stroke();
  }
  legend(shade, right + 14);
}

function axes(x, y, right, bottom) {
  pen.strokeStyle = colour("--line");
  pen.fillStyle = colour("--ink");
  pen.lineWidth = 1;
  pen.textAlign = "center";
  let last = -Infinity;
  for (const tick of x.ticks) {
    const at = x.place(tick);
    if (at - last < 52) continue; // no room for its label
    last = at;
    line(at, PAD.top, at, bottom);
    pen.fillText(label(tick, x.words), at, bottom + 16);
  }
  pen.fillText(el("x").value, (PAD.left + right) / 2, bottom + 36);
  pen.textAlign = "right";
  for (const tick of y.ticks) {
    const at = y.place(tick);
    line(PAD.left, at, right, at);
    pen.fillText(label(tick, y.words), PAD.left - 6, at + 4);
  }
  pen.save();
  pen.translate(12, (PAD.top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.fillText(el("y").value, 0, 0);
  pen.restore();
}

function line(a, b, c, d) {
  pen.beginPath();
  pen.moveTo(a, b);
  pen.lineTo(c, d);
  pen.stroke();
}

function legend(shade, left) {
  pen.textAlign = "left";
  if (shade.words) {
    shade.words.slice(0, 12).forEach((word, i) => {
      pen.fillStyle = PALETTE[i % PALETTE.length];
      pen.fillRect(left, PAD.top + 18 * i, 9, 9);
      pen.fillStyle = colour("--ink");
      pen.fillText(label(i, shade.words), left + 14, PAD.top + 9 + 18 * i);
    });
  } else if (shade.shade) {
    for (let k = 0; k < 100; k++) {
      pen.fillStyle = shade.shade(1 - k / 99);
      pen.fillRect(left, PAD.top + 1.6 * k, 10, 2);
    }
    pen.fillStyle = colour("--ink");
    pen.fillText(label(shade.high), left + 15, PAD.top + 9);
    pen.fillText(label(shade.low), left + 15, PAD.top + 161);
  }
}

canvas.onmousemove = (event) => {
  const { offsetX, offsetY } = event;
  let best = null, gap = 100;
  for (const point of points) {
    const here = (point[0] - offsetX) ** 2 + (point[1] - offsetY) ** 2;
    if (here < gap) [best, gap] = [point, here];
  }
  const tip = el("tip");
  tip.style.display = best ? "block" : "none";
  if (!best) return;
  const shown = new Set(["number", "status", ...defaults.inputs, el("x").value, el("y").value, el("c").value]);
  const lines = names.map((name, k) => [name, rows[best[2]][k]]).filter(([name, value]) => shown.has(name) && value !== null);
  tip.textContent = lines.map(([name, value]) => `${name}: ${value}`).join("\n");
  tip.style.left = `${Math.min(best[0] + 14, canvas.clientWidth - tip.offsetWidth - 4)}px`;
  tip.style.top = `${Math.min(best[1] + 10, canvas.clientHeight - tip.offsetHeight)}px`;
};
canvas.onmouseleave = () => (el("tip").style.display = "none");
