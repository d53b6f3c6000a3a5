"use strict";
// Scatter of any two columns of the rows, drawn on a canvas: ten thousand points stay quick.
const el = (id) => document.getElementById(id);
const { names, numeric, log, rows, status, colours, defaults } = JSON.parse(el("data").textContent);
const canvas = document.querySelector("canvas"), pen = canvas.getContext("2d");
const style = getComputedStyle(document.documentElement);
const colour = (name) => style.getPropertyValue(name).trim();
const PALETTE = ["#1f5fa8", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a5a44", "#6b4ea8", "#777777"];
// Viridis but for its lightest end, which white paper swallows.
const RAMP = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [200, 222, 40]];
const PLAIN = "(one colour)", LETTERS = 12;
let points = [];

if (rows.length) start();

function start() {
  for (const id of ["x", "y", "c"]) {
    (id === "c" ? [PLAIN, ...names] : names).forEach((name) => el(id).add(new Option(name)));
    el(id).value = names.includes(defaults[id]) ? defaults[id] : names[0];
    el(id).onchange = () => (suggest(), draw());
  }
  el("lx").onchange = el("ly").onchange = draw;
  el("plot").hidden = false;
  canvas.onpointermove = canvas.onpointerdown = hover;
  canvas.onpointerleave = () => (el("tip").hidden = el("ring").hidden = true);
  window.onresize = draw;
  suggest();
  draw();
}

// Logarithmic axes where they can be, and ticked where they are usual, once a column is chosen.
function suggest() {
  for (const id of ["x", "y"]) {
    const box = el("l" + id), name = el(id).value;
    if (box.dataset.of === name) continue;
    const { words, low } = column(name);
    Object.assign(box, { disabled: words !== null || !(low > 0), checked: log[names.indexOf(name)] });
    box.dataset.of = name;
  }
}

// What a column says of a row: a number, or the place of a word among the words of the column.
function column(name) {
  const at = names.indexOf(name);
  let values = rows.map((row) => row[at]), words = null;
  if (!numeric[at]) {
    const places = new Map();
    values.forEach((v) => v !== null && !places.has(v) && places.set(v, places.size));
    words = [...places.keys()];
    values = values.map((v) => (v === null ? null : places.get(v)));
  }
  let low = Infinity, high = -Infinity;
  for (const v of values) if (v !== null) [low, high] = [Math.min(low, v), Math.max(high, v)];
  return { name, values, words, low, high };
}

// An axis: places of rows between 0 and 1, and round numbers along it.
function axis(id) {
  const { name, values, words, low, high } = column(el(id).value);
  const powers = el("l" + id).checked, f = powers ? Math.log10 : (v) => v;
  let [a, b] = low > high ? [0, 1] : [f(low), f(high)];
  const margin = (b - a || Math.abs(a) || 1) * 0.04;
  [a, b] = words ? [-0.5, Math.max(words.length, 1) - 0.5] : [a - margin, b + margin];
  const place = (v) => (f(v) - a) / (b - a);
  // Ribbons of one word would hide each other: they are spread by the golden ratio.
  const spread = (i) => (words ? (((i + 1) * (id === "x" ? 0.618034 : 0.754878)) % 1) * 0.5 - 0.25 : 0);
  const places = values.map((v, i) => (v === null ? null : place(v + spread(i))));
  const ticks = words ? words.map((text, i) => ({ at: place(i), text })) : round(a, b, powers, place);
  return { name, places, ticks, words };
}

function round(a, b, powers, place) {
  const found = [];
  if (powers && b - a > 1) {
    const factors = b - a < 2.5 ? [1, 2, 5] : [1], stride = Math.ceil((b - a) / 8);
    for (let e = Math.floor(a); e <= b; e += stride) for (const k of factors) found.push(k * 10 ** e);
  } else {
    const [low, high] = powers ? [10 ** a, 10 ** b] : [a, b];
    const unit = 10 ** Math.floor(Math.log10((high - low) / 4));
    const step = [1, 2, 5, 10].map((k) => k * unit).find((s) => (high - low) / s <= 6);
    for (let k = Math.ceil(low / step); k * step <= high; k++) found.push(k * step);
  }
  const digits = Math.ceil(Math.log10(Math.max(1, ...found.map((v) => Math.abs(v) / (b - a))))) + 3;
  const inside = found.map((v) => ({ at: place(v), text: say(v, digits) }));
  return inside.filter(({ at }) => at >= 0 && at <= 1);
}

function say(value, digits = 5) {
  const v = Number(value.toPrecision(Math.min(digits, 15))), size = Math.abs(v);
  const text = v !== 0 && (size < 1e-3 || size >= 1e6) ? v.toExponential() : String(v);
  return text.replaceAll("-", "−").replace("e+", "e");
}

// Long words differ at either end.
function short(text, letters) {
  const half = Math.max(Math.floor((letters - 1) / 2), 1);
  return text.length <= letters ? text : `${text.slice(0, half)}…${text.slice(-half)}`;
}

function shades() {
  if (el("c").value === PLAIN) return { of: () => PALETTE[0] };
  const { name, values, words, low, high } = column(el("c").value);
  const none = colour("--none");
  if (words) {
    const paint = (k) => (name === "status" ? colours[words[k]] : PALETTE[k % PALETTE.length]);
    return { of: (i) => (values[i] === null ? none : paint(values[i])), words, paint };
  }
  const powers = log[names.indexOf(name)], f = powers ? Math.log10 : (v) => v;
  // Whole steps, so that few colours are set up for many points.
  const of = (i) => (values[i] === null ? none : ramp(Math.round(((f(values[i]) - f(low)) / (f(high) - f(low) || 1)) * 64) / 64));
  return { of, name: name + (powers ? " (log)" : ""), low, high };
}

function ramp(t) {
  const k = Math.min(Math.floor(t * (RAMP.length - 1)), RAMP.length - 2), rest = t * (RAMP.length - 1) - k;
  return `rgb(${RAMP[k].map((v, j) => Math.round(v + rest * (RAMP[k + 1][j] - v))).join(" ")})`;
}

function draw() {
  const width = canvas.clientWidth, height = canvas.clientHeight, dots = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [width * dots, height * dots];
  pen.setTransform(dots, 0, 0, dots, 0, 0);
  pen.font = "12px system-ui, sans-serif";
  el("tip").hidden = el("ring").hidden = true;
  const x = axis("x"), y = axis("y"), shade = shades();
  for (const tick of y.ticks) tick.text = short(tick.text, width < 600 ? 12 : 20);
  const left = 34 + Math.max(20, ...y.ticks.map(({ text }) => pen.measureText(text).width));
  const box = { left, right: width - 12, top: 10, bottom: height - 44 };
  frame(x, y, box);
  points = [];
  rows.forEach((_, i) => {
    let px = x.places[i], py = y.places[i];
    // What failed has inputs and often no answer: it is shown on the axis.
    if (!status[i] && px !== null) py ??= 0;
    if (!status[i] && py !== null) px ??= 0;
    if (px === null || py === null) return;
    points.push([box.left + px * (box.right - box.left), box.bottom - py * (box.bottom - box.top), i]);
  });
  const size = points.length > 2000 ? 2 : points.length > 400 ? 2.6 : 3.6;
  for (const [px, py, i] of points.filter((point) => status[point[2]])) {
    pen.fillStyle = shade.of(i);
    pen.beginPath();
    pen.arc(px, py, size, 0, 7);
    pen.fill();
  }
  const crosses = points.filter((point) => !status[point[2]]);
  pen.lineWidth = 1.5;
  for (const [px, py, i] of crosses) {
    pen.strokeStyle = el("c").value === "status" ? shade.of(i) : colour("--bad");
    line(px - 4, py - 4, px + 4, py + 4);
    line(px - 4, py + 4, px + 4, py - 4);
  }
  legend(shade, crosses.length);
}

function frame(x, y, { left, right, top, bottom }) {
  const room = ((right - left) / Math.max(x.ticks.length, 1)) * (x.words ? 1 : Infinity);
  pen.lineWidth = 1;
  pen.textAlign = "center";
  let last = -Infinity;
  for (const { at, text } of x.ticks) {
    const px = left + at * (right - left), said = short(text, Math.max(8, Math.floor(room / 7)));
    pen.strokeStyle = colour("--line");
    line(px, top, px, bottom);
    const half = pen.measureText(said).width / 2;
    if (px - half < last + 8 || px + half > right + 12) continue; // no room for it
    last = px + half;
    pen.fillStyle = colour("--ink");
    pen.fillText(said, px, bottom + 17);
  }
  pen.fillText(titled(x.name, "lx", right - left), (left + right) / 2, bottom + 37);
  pen.textAlign = "right";
  last = Infinity;
  for (const { at, text } of y.ticks) {
    const py = bottom - at * (bottom - top);
    pen.strokeStyle = colour("--line");
    line(left, py, right, py);
    if (py > last - 13) continue;
    last = py;
    pen.fillText(text, left - 7, py + 4);
  }
  pen.save();
  pen.translate(12, (top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.fillText(titled(y.name, "ly", bottom - top), 0, 0);
  pen.restore();
  pen.strokeStyle = colour("--faint");
  line(left, bottom, right, bottom);
  line(left, top, left, bottom);
}

function titled(name, box, room) {
  return short(name, Math.floor(room / 8)) + (el(box).checked ? " (log)" : "");
}

function line(a, b, c, d) {
  pen.beginPath();
  pen.moveTo(a, b);
  pen.lineTo(c, d);
  pen.stroke();
}

function legend(shade, failed) {
  const entry = (text, background) => {
    const span = document.createElement("span");
    if (background) span.appendChild(document.createElement("i")).style.background = background;
    span.append(text);
    el("key").append(span);
    return span;
  };
  el("key").replaceChildren();
  if (shade.words) {
    shade.words.slice(0, LETTERS).forEach((word, k) => entry(short(word, 60), shade.paint(k)));
    if (shade.words.length > LETTERS) entry(`and ${shade.words.length - LETTERS} more`);
  } else if (shade.name && shade.low <= shade.high) {
    const span = entry("", `linear-gradient(90deg, ${[0, 0.2, 0.4, 0.6, 0.8, 1].map(ramp).join(", ")})`);
    span.firstChild.className = "ramp";
    span.prepend(`${shade.name}: ${say(shade.low)}`);
    span.append(say(shade.high));
  }
  if (failed) entry(`× ${failed} failed, on the axis where a value is missing`).className = "bad";
  if (points.length < rows.length) entry(`${rows.length - points.length} of ${rows.length} without these values`);
}

function hover({ offsetX, offsetY }) {
  let best = null, gap = 200;
  for (const point of points) {
    const here = (point[0] - offsetX) ** 2 + (point[1] - offsetY) ** 2;
    if (here < gap) [best, gap] = [point, here];
  }
  const tip = el("tip"), ring = el("ring");
  tip.hidden = ring.hidden = !best;
  if (!best) return;
  const shown = new Set(["number", ...defaults.inputs, "status", ...["x", "y", "c"].map((id) => el(id).value)]);
  const told = [...shown].filter((name) => names.includes(name)).map((name) => [name, rows[best[2]][names.indexOf(name)]]);
  const texts = told.map(([name, v]) => `${name}: ${v === null ? "none" : typeof v === "number" ? say(v, 8) : v}`);
  tip.textContent = texts.join("\n");
  ring.style.left = `${best[0]}px`;
  ring.style.top = `${best[1]}px`;
  const beyond = best[0] + 14 + tip.offsetWidth > canvas.clientWidth;
  tip.style.left = `${Math.max(beyond ? best[0] - 14 - tip.offsetWidth : best[0] + 14, 0)}px`;
  tip.style.top = `${Math.max(Math.min(best[1] + 10, canvas.clientHeight - tip.offsetHeight), 0)}px`;
}
