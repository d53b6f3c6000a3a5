"use strict";
// Small vibrations: a field to choose a mode, which is then seen in motion, its amplitude and its
// frequency. `makeMotion(form, ribbon)` gives show(i): only the shape that has modes can move.
// Nothing moves by itself where that is not wanted (prefers-reduced-motion): then the end of a
// motion is shown, until play is pressed. On the picture, m and Shift+m go through the modes, and
// space plays and pauses.
const MOVES = ["x", "y", "z", "rx", "ry", "rz"]; // displacement and rotation of every row
const PERIOD = 2200; // milliseconds of all motions, whatever their frequency

// Rows of a ribbon moved by a times columns of MOVES, directors turned (Rodrigues' formula).
function movedRows(rows, moves, a) {
  const found = { ...rows };
  MOVES.slice(0, 3).forEach((name, c) => (found[name] = rows[name].map((v, j) => v + a * moves[c][j])));
  for (const name of ["d1", "b"]) found[name] = Float32Array.from(rows[name]);
  for (let j = 0; j < rows.count; j++) {
    const turn = [3, 4, 5].map((c) => a * moves[c][j]);
    const angle = Math.hypot(...turn);
    if (!angle) continue;
    const axis = turn.map((part) => part / angle);
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    for (const name of ["d1", "b"]) {
      const v = rows[name].subarray(3 * j, 3 * j + 3);
      const across = cross(axis, v);
      const along = (1 - c) * dot(axis, v);
      found[name].set(axis.map((part, k) => c * v[k] + s * across[k] + along * part), 3 * j);
    }
  }
  return found;
}

async function makeMotion(form, ribbon) {
  const get = (id) => form.querySelector(`#${id}`);
  const canvas = document.querySelector("#stage canvas");
  const { list, shape, count, packed } = view.modes;
  const tables = makeTables(packed, list.map(() => count), MOVES);
  await tables.read();
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  let [mode, moves, phase, before, running] = [-1, null, 0, null, false];

  function pose() {
    if (mode < 0) return ribbon.move((rows) => rows);
    const a = Math.cos(phase) * get("amplitude").value * list[mode].amplitude;
    ribbon.move((rows) => movedRows(rows, moves, a));
  }

  function frame(now) {
    if (!running) return;
    phase = (phase + (2 * Math.PI * Math.min(now - (before ?? now), 100)) / PERIOD) % (2 * Math.PI);
    before = now;
    pose();
    requestAnimationFrame(frame);
  }

  function play(on) {
    const begins = on && !running;
    running = on;
    before = null;
    get("swing").textContent = on ? "❚❚" : "▶";
    get("swing").setAttribute("aria-label", on ? "pause the motion" : "play the motion");
    if (begins) requestAnimationFrame(frame);
  }

  function choose(k) {
    mode = k;
    get("mode").value = k;
    moves = k < 0 ? null : MOVES.map((_, c) => tables.column(k, c));
    phase = 0;
    for (const id of ["swing", "amplitude"]) get(id).disabled = k < 0;
    get("frequency").textContent = k < 0 ? "" : list[k].told;
    get("frequency").className = list[k]?.grows ? "grows" : "";
    play(k >= 0 && !still.matches);
    pose();
  }

  get("mode").add(new Option("at rest", -1));
  list.forEach(({ name }, k) => get("mode").add(new Option(name, k)));
  get("mode").onchange = () => choose(+get("mode").value);
  get("amplitude").oninput = pose;
  get("swing").onclick = () => play(!running);
  canvas.setAttribute("aria-label", `${canvas.getAttribute("aria-label")} m chooses a mode of small vibrations, space plays it.`);
  canvas.addEventListener("keydown", ({ key, altKey, ctrlKey, metaKey }) => {
    if (form.hidden || altKey || ctrlKey || metaKey) return;
    const stride = { m: 1, M: -1 }[key];
    const places = list.length + 1;
    if (stride) choose(((mode + 1 + stride + places) % places) - 1);
    if (key === " " && mode >= 0) play(!running);
  });
  canvas.addEventListener("keydown", (event) => event.key === " " && event.preventDefault());
  still.addEventListener("change", () => still.matches && play(false));

  return {
    show: (i) => {
      form.hidden = i !== shape;
      choose(-1);
    },
  };
}
