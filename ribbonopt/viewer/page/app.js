"use strict";
// The page as a whole: which shape is shown, what is said of it, what all parts mark together.
const FIELDS = [["", "plain"], ["u2", "bending u₂"], ["u3", "twist u₃"], ["eta", "η = u₃/u₂"],
  ["energy", "energy per length"]];
const [WHOLE, FASTEST, SLOWEST] = [9000, 40, 300]; // milliseconds: of all shapes played, of each

function makeApp() {
  const get = (id) => document.getElementById(id);
  let ribbon, panels, overview, motion;
  let shape = -1;
  let playing = null;

  function mark(row, from) {
    ribbon.mark(row);
    panels.mark(row, from);
  }

  function show(i) {
    if (i === shape || i < 0 || i >= view.shapes.length) return;
    shape = i;
    ribbon.show(i);
    panels.show(i);
    motion?.show(i);
    tell(i);
    paint();
    overview?.mark(view.shapes[i].row);
  }

  function tell(i) {
    const { caption, note, numbers, warnings, verified } = view.shapes[i];
    get("slider").value = i;
    get("slider").setAttribute("aria-valuetext", caption);
    get("count").textContent = `${i + 1} of ${view.shapes.length}`;
    get("caption").textContent = [caption, note].filter(Boolean).join("; ");
    get("caption").className = verified ? "good" : "bad";
    const list = document.createElement("dl");
    for (const [name, value] of numbers) {
      for (const [tag, text] of [["dt", name], ["dd", value]]) {
        list.appendChild(document.createElement(tag)).textContent = text;
      }
    }
    const said = (warnings || []).map((text) => {
      const line = document.createElement("p");
      line.className = "bad";
      line.textContent = `warning: ${text}`;
      return line;
    });
    get("facts").replaceChildren(...(numbers.length ? [list] : []), ...said);
  }

  function paint() {
    const scale = ribbon.colour(get("field").value);
    get("scale").hidden = !scale;
    if (!scale) return;
    get("scale").querySelector("i").style.background = `linear-gradient(to right, ${scale.css})`;
    get("low").textContent = axes.say(scale.from, 3);
    get("high").textContent = axes.say(scale.to, 3);
  }

  function play(on) {
    clearInterval(playing);
    const pace = Math.min(Math.max(WHOLE / view.shapes.length, FASTEST), SLOWEST);
    playing = on ? setInterval(() => show((shape + 1) % view.shapes.length), pace) : null;
    get("play").textContent = on ? "❚❚" : "▶";
    get("play").setAttribute("aria-label", on ? "pause" : "play");
  }

  function dark(on) {
    document.documentElement.classList.toggle("dark", on);
    ribbon?.recolour();
  }

  function controls() {
    const media = matchMedia("(prefers-color-scheme: dark)");
    dark(media.matches);
    media.addEventListener("change", () => dark(media.matches));
    let before = false; // what is printed is light
    const isDark = () => document.documentElement.classList.contains("dark");
    addEventListener("beforeprint", () => ((before = isDark()), dark(false)));
    // Firefox has the colours of paper until all who are told of the end have heard of it.
    addEventListener("afterprint", () => setTimeout(() => dark(before)));
    get("theme").onclick = () => dark(!isDark());
    const known = FIELDS.filter(([name]) => !name || view.ranges[name]);
    for (const [name, text] of known) get("field").add(new Option(text, name));
    get("field").onchange = paint;
    get("again").onclick = () => get("stage").querySelector("canvas").dispatchEvent(new Event("dblclick"));
    for (const form of ["look", "steps", "motion"]) get(form).onsubmit = (event) => event.preventDefault();
    get("steps").hidden = view.shapes.length < 2;
    get("slider").max = view.shapes.length - 1;
    get("slider").oninput = () => {
      play(false);
      show(+get("slider").value);
    };
    get("play").onclick = () => play(!playing);
    const strides = { ArrowLeft: -1, ArrowRight: 1 }; // Home and End scroll, or move the slider
    document.addEventListener("keydown", ({ key, target, altKey, ctrlKey, metaKey }) => {
      if (!strides[key] || view.shapes.length < 2) return;
      if (target.closest("input, select, canvas, svg, .scroll")) return; // which have uses for them
      if (altKey || ctrlKey || metaKey) return; // Alt and an arrow lead to another page
      play(false);
      show(Math.min(Math.max(shape + strides[key], 0), view.shapes.length - 1));
    });
  }

  // The diagram of a branch. Where few of many points have shapes, a click shows the nearest one.
  function drawDiagram() {
    get("diagram").hidden = false;
    const far = (i, row) => Math.abs(view.shapes[i].row - row);
    return diagram.build(get("diagram"), view.diagram, {
      onClick: (row) => {
        play(false);
        show(view.shapes.reduce((best, _, i) => (far(i, row) < far(best, row) ? i : best), 0));
      },
      onLeave: () => overview.mark(view.shapes[shape].row),
    });
  }

  // Scatter and table of a batch. A row without a shape says so.
  function drawBatch() {
    get("diagram").hidden = get("table").hidden = false;
    get("ribbon").hidden = get("panels").hidden = !view.shapes.length;
    document.body.classList.toggle("bare", !view.shapes.length);
    return batch.build(get("diagram"), get("table"), view.table, (row) => {
      const i = view.shapes.findIndex((one) => one.row === row);
      if (i >= 0) {
        show(i);
        tell(i);
        return get("stage").scrollIntoView({ block: "nearest" });
      }
      const { names, rows, verified } = view.table;
      const [number, status] = ["number", "status"].map((name) => rows[row][names.indexOf(name)]);
      const seen = view.shapes[shape] ? `; seen is ${view.shapes[shape].caption}` : "";
      get("caption").textContent = `ribbon ${number}, ${status}: its shape is not on this page${seen}`;
      get("caption").className = verified[row] ? "" : "bad";
      get("facts").replaceChildren();
    });
  }

  async function begin() {
    if (view.shapes.length) await shapes.read();
    controls();
    ribbon = makeRibbon(get("stage"), (row) => mark(row));
    panels = makePanels(get("panels"), mark);
    if (view.modes) motion = await makeMotion(get("motion"), ribbon);
    if (view.diagram) overview = drawDiagram();
    if (view.table) overview = { mark: drawBatch().choose };
    if (view.shapes.length) show(0);
    document.documentElement.dataset.ready = "";
  }

  begin().catch(fail);
  return { show, mark };
}
const app = makeApp();
