"use strict";
// Scatter of any two columns of the rows of a batch, coloured by a third. `data` is what
// ribbonopt/viewer/rows.py gives; points are called by their row.
//
// const view = scatter.build(element, data, { onHover(row), onLeave(), onChoose(row) });
// view.mark(row | null)
const scatter = (() => {
  const PLAIN = "(one colour)";
  const LETTERS = 12;
  const STEPS = 64;
  const PALETTE = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => `--branch${k}`);
  // Viridis; paper swallows its lightest end, a dark page its darkest.
  const RAMP = [
    [68, 1, 84],
    [65, 68, 135],
    [42, 120, 142],
    [34, 168, 132],
    [122, 209, 81],
    [253, 231, 37],
  ];
  const ON_PAPER = [0, 0.88];
  const ON_DARK = [0.25, 1];

  const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Whether the page is dark: by the colour of its paper.
  function isDark() {
    const digits = variable("--paper").slice(1, 7);
    return parseInt(digits.slice(0, 2), 16) < 128;
  }

  function ramp(t) {
    const [low, high] = isDark() ? ON_DARK : ON_PAPER;
    const at = (low + t * (high - low)) * (RAMP.length - 1);
    const k = Math.min(Math.floor(at), RAMP.length - 2);
    return `rgb(${RAMP[k].map((v, j) => Math.round(v + (at - k) * (RAMP[k + 1][j] - v))).join(" ")})`;
  }

  // What a column says of a row: a number, or the place of a word among the words of the column.
  function column(data, name) {
    const at = data.names.indexOf(name);
    let values = data.rows.map((row) => row[at]);
    let words = null;
    if (!data.numeric[at]) {
      const places = new Map();
      values.forEach((v) => v !== null && !places.has(v) && places.set(v, places.size));
      words = [...places.keys()];
      values = values.map((v) => (v === null ? NaN : places.get(v)));
    }
    return { name, words, values: values.map((v) => v ?? NaN), log: data.log[at] };
  }

  // Ribbons of one word would hide each other: they are spread by the golden ratio.
  function spread({ values, words }, share) {
    return words ? values.map((v, i) => v + (((i + 1) * share) % 1) * 0.5 - 0.25) : values;
  }

  // The colour of each row, and what tells of it.
  function shades(data, name) {
    if (name === PLAIN) return { of: () => variable(PALETTE[0]) };
    const { values, words, log } = column(data, name);
    const none = variable("--none");
    if (words) {
      const paint = (k) =>
        variable((name === "status" && data.colours[words[k]]) || PALETTE[k % PALETTE.length]);
      const known = words.map((_, k) => paint(k));
      return { of: (i) => known[values[i]] ?? none, words, paint };
    }
    const [low, high] = axes.extent([values], log);
    const f = log ? Math.log10 : (v) => v;
    const size = f(high) - f(low) || 1;
    // Whole steps, so that few colours are set up for many points.
    const known = Array.from({ length: STEPS + 1 }, (_, k) => ramp(k / STEPS));
    const of = (i) => known[Math.round(((f(values[i]) - f(low)) / size) * STEPS)] ?? none;
    return { of, name: name + (log ? " (log)" : ""), low, high };
  }

  function build(element, data, { onHover, onLeave, onChoose } = {}) {
    const form = charts.part("div", "choice", element);
    const place = charts.part("div", "scatter", element);
    const legend = charts.part("div", "legend", element);
    const names = data.names.filter((_, k) => data.axis[k]);
    const logs = {};
    const fields = {};
    const nameOf = (key) => (key === "c" ? [PLAIN, ...names] : names)[fields[key].value];
    for (const axis of ["x", "y"]) {
      const group = charts.part("span", "", form);
      const chosen = Math.max(names.indexOf(data[axis]), 0);
      fields[axis] = choice.column(group, axis, names, chosen, () => (suggest(axis), show()));
      logs[axis] = choice.powers(group, () => show());
      suggest(axis);
    }
    const shown = charts.part("span", "", form);
    const first = names.indexOf(data.c) + 1;
    fields.c = choice.column(shown, "colour", [PLAIN, ...names], first, () => show());

    // Logarithmic axes where they can be, and ticked where they are usual, once a column is chosen.
    function suggest(key) {
      const { words, values, log } = column(data, nameOf(key)),
        [low] = axes.extent([values]);
      const can = !words && low > 0 && low < Infinity;
      Object.assign(logs[key], { disabled: !can, checked: can && log });
    }

    function tip(row) {
      const told = ["number", ...data.inputs, "status", ...["x", "y", "c"].map(nameOf)];
      const lines = [...new Set(told)]
        .filter((name) => data.names.includes(name))
        .map((name) => {
          const value = data.rows[row][data.names.indexOf(name)];
          return `${name}: ${value === null ? "none" : typeof value === "number" ? axes.say(value, 8) : value}`;
        });
      return lines.join("\n");
    }

    function drawing() {
      const x = column(data, nameOf("x"));
      const y = column(data, nameOf("y"));
      const by = nameOf("c");
      let shade = null;
      const bad = (i) => !data.verified[i];
      return {
        xLabel: x.name,
        yLabel: y.name,
        xLog: logs.x.checked,
        yLog: logs.y.checked,
        xWords: x.words || undefined,
        yWords: y.words || undefined,
        cloud: {
          x: spread(x, 0.618034),
          y: spread(y, 0.754878),
          // Colours of the page may change: they are looked up each time all is drawn.
          begin: () => (shade = shades(data, by)),
          colour: (i) => (bad(i) && by !== "status" ? variable("--bad") : shade.of(i)),
          cross: bad,
          edge: bad, // what failed has inputs and often no answer
          end: (count, crosses) => key(shade, count, crosses),
        },
      };
    }

    function key(shade, count, crosses) {
      legend.replaceChildren();
      const entry = (text, background) => {
        const span = charts.part("span", "", legend);
        if (background) charts.part("i", "", span).style.background = background;
        span.append(text);
        return span;
      };
      if (shade.words) {
        shade.words.slice(0, LETTERS).forEach((word, k) => entry(axes.short(word, 60), shade.paint(k)));
        if (shade.words.length > LETTERS) entry(`and ${shade.words.length - LETTERS} more`);
      } else if (shade.name && shade.low <= shade.high) {
        const colours = [0, 0.2, 0.4, 0.6, 0.8, 1].map(ramp).join(", ");
        const span = entry("", `linear-gradient(90deg, ${colours})`);
        span.firstChild.className = "ramp";
        span.prepend(`${shade.name}: ${axes.say(shade.low)}`);
        span.append(axes.say(shade.high));
      }
      if (crosses) entry(`× ${crosses} failed, on the axis where a value is missing`).className = "bad";
      const without = data.rows.length - count;
      if (without) entry(`${without} of ${data.rows.length} without these values`);
    }

    const show = () => chart.update(drawing());
    const own = { tip, onHover, onLeave, onClick: (row) => onChoose?.(row) };
    const chart = charts.plot(place, { ...drawing(), ...own });
    return { mark: (row) => chart.mark(row, "cloud") };
  }

  return { build };
})();
