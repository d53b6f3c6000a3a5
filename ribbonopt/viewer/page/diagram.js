"use strict";
// Diagram of a branch: any column against any other, stable and unstable told apart, special points
// marked. `data` is what ribbonopt/viewer/diagram.py gives; points are called by their row.
//
// const view = diagram.build(element, data, { onHover(row), onLeave(), onClick(row) });
// view.mark(row | null)
const diagram = (() => {
  const STABLE = "stable";
  const UNSTABLE = "unstable";
  const UNKNOWN = "stability unknown";
  const LOCI = { "locus of folds": "locus", "locus of branch points": "locus dashed",
    "locus of buckling points": "locus dotted" };
  const DASHES = { [STABLE]: "", [UNSTABLE]: "dashed", [UNKNOWN]: "dotted", ...LOCI };
  const BRANCHES = 8; // colours
  const HIDDEN = 0.5; // share of its points that lie under another curve: a curve is drawn wider
  const LOOKED_AT = 20; // of its points
  const SIGNS = {
    "first point": ["dot", "faint"],
    "last point": ["cross", "faint"],
    note: ["triangle", "twist open"],
    fold: ["square", "ink"],
    "branch point": ["dot", "ink open"],
    "buckling point": ["diamond", "ink open"],
    kink: ["triangle", "ink open"],
    cusp: ["triangle", "ink"],
    "isola centre": ["dot", "ink"],
    crossing: ["cross", "ink"],
    "double point": ["square", "ink open"],
    turn: ["diamond", "faint"],
    "other special point": ["diamond", "ink"],
  };

  function build(element, data, { onHover, onLeave, onClick } = {}) {
    if (!data.names.length) return { mark() {} }; // a branch without points
    const form = charts.part("div", "choice", element);
    const place = charts.part("div", "diagram", element);
    const legend = charts.part("div", "legend", element);
    const logs = [[], []];
    const fields = ["x", "y"].map((axis, k) => {
      const group = charts.part("span", "", form);
      const field = choice.column(group, axis, data.labels, data[axis], () => (suggest(k), show()));
      logs[k] = choice.powers(group, () => show());
      return field;
    });
    const stages = [...new Set(data.stage)];
    let stage = null; // the one shown, of several
    if (stages.length > 1) {
      const words = ["all", ...stages.map((one) => `${one + 1}: ${data.labels[data.moved[one]]}`)];
      const field = choice.column(charts.part("span", "", form), "stage", words, 0, () => {
        stage = stages[field.value - 1] ?? null;
        if (stage !== null) fields[0].value = data.moved[stage];
        suggest(0);
        suggest(1);
        show();
      });
    }
    const column = (k) => {
      const values = data.columns[fields[k].value];
      return stage === null ? values : values.map((v, row) => (data.stage[row] === stage ? v : null));
    };
    const known = data.negative.some((count) => count !== null);

    // Powers where the scene says so; not where a value is none.
    function suggest(k) {
      const [low] = axes.extent([column(k)]);
      logs[k].disabled = !(low > 0);
      logs[k].checked = low > 0 && data.log[fields[k].value];
    }

    function state(row) {
      if (data.locus[row]) return data.locus[row];
      const count = data.negative[row];
      return count === null ? UNKNOWN : count ? UNSTABLE : STABLE;
    }

    // Of the stretch between two rows: special points belong to both sides.
    function between(a, b) {
      const regular = [a, b].filter((row) => data.kind[row] === "point");
      const states = new Set((regular.length ? regular : [a, b]).map(state));
      return states.size === 1 ? [...states][0] : UNKNOWN;
    }

    function tip(row) {
      const count = data.negative[row];
      const several = stages.length > 1;
      const lines = [`point ${data.number[row]}${data.kind[row] === "point" ? "" : `, ${data.kind[row]}`}`];
      for (const k of [0, 1]) lines.push(`${data.labels[fields[k].value]}: ${axes.say(column(k)[row], 6)}`);
      if (count) lines.push(`unstable, ${count} direction${count > 1 ? "s" : ""}`);
      else if (known || data.locus[row]) lines.push(state(row));
      if (data.branch[row] || several)
        lines.push(`branch ${data.branch[row]}${several ? `, stage ${data.stage[row] + 1}` : ""}`);
      if (data.note[row]) lines.push(data.note[row]);
      return lines.join("\n");
    }

    // Curves through the rows of each piece that have both values, a path for each stretch.
    function curves(inner, X, Y, node) {
      const rough = fields.some(({ value }) => data.rough[value]);
      const corners = new Set(data.corners);
      const at = (row) => [X(column(0)[row]), Y(column(1)[row])];
      const drawn = data.pieces.map(({ branch, rows, beyond }) => {
        const group = node("g", { class: `branch${branch % BRANCHES}` }, inner);
        const own = [...[...beyond].reverse(), ...rows].filter((row) => paths.isThere(at(row)));
        const points = own.map(at);
        const first = own.indexOf(rows.find((row) => paths.isThere(at(row))));
        const cut = own.map((row, i) => (rough || corners.has(row) ? i : -1));
        const parts = paths.parts(points, cut);
        let whole = "";
        let d = "";
        let last = null;
        const end = () =>
          d &&
          node("path", { d, class: `line ${last === null || known || LOCI[last] ? DASHES[last ?? UNKNOWN] : ""}` }, group);
        if (first >= 0 && first === own.length - 1)
          node("path", { d: `M${paths.text(points[first])}h0`, class: "line alone" }, group);
        for (let i = Math.max(first, 0); i < parts.length; i++) {
          const now = between(own[i], own[i + 1]);
          if (now !== last) (end(), (d = `M${paths.text(points[i])}`), (last = now));
          d += parts[i];
          whole += (whole ? "" : `M${paths.text(points[i])}`) + parts[i];
        }
        end();
        return { group, points, whole: node("path", { d: whole, class: "line reach" }, inner) };
      });
      widen(drawn);
    }

    // A curve that one drawn later hides, as mirror images do, is seen on both sides of it.
    function widen(drawn) {
      drawn.forEach(({ group, points }, i) => {
        const some = points.filter((_, k) => k % Math.ceil(points.length / LOOKED_AT) === 0);
        const under = ({ whole }) => {
          const count = some.filter(([x, y]) => whole.isPointInStroke(new DOMPoint(x, y))).length;
          return points.length > 1 && count > HIDDEN * some.length;
        };
        if (drawn.slice(i + 1).some(under)) group.classList.add("behind");
      });
      drawn.forEach(({ whole }) => whole.remove());
    }

    function marks() {
      const order = (row) => Object.keys(SIGNS).indexOf(data.mark[row]); // what matters most on top
      const rows = data.mark.map((_, row) => row).filter((row) => data.mark[row]);
      rows.sort((a, b) => order(a) - order(b));
      return rows.map((row) => {
        const [mark, className] = SIGNS[data.mark[row]] || SIGNS["other special point"];
        return {
          x: column(0)[row],
          y: column(1)[row],
          mark,
          className,
          title: `${data.mark[row]}, point ${data.number[row]}`,
        };
      });
    }

    function key() {
      legend.replaceChildren();
      const seen = (values) => [...new Set(values)].sort((a, b) => a - b);
      const branches = seen(data.branch.filter((_, row) => !data.locus[row]));
      for (const b of branches.length > 1 ? branches : [])
        choice.key(legend, "M-10 0H10", `line branch${b % BRANCHES}`, `branch ${b}`);
      const states = new Set(
        data.pieces.flatMap(({ rows }) => rows.slice(1).map((row, i) => between(rows[i], row))),
      );
      for (const name of known ? Object.keys(DASHES) : Object.keys(LOCI)) {
        if (states.has(name)) choice.key(legend, "M-10 0H10", `line ${DASHES[name]}`, name);
      }
      for (const [name, [mark, className]] of Object.entries(SIGNS)) {
        const count = data.mark.filter((own) => own === name).length;
        const counted = count > 1 || !/point$/.test(name) ? ` (${count})` : "";
        if (count) choice.key(legend, charts.MARKS[mark], `point ${mark} ${className}`, name + counted);
      }
    }

    const branch = (row) => `branch${data.branch[row] % BRANCHES}`;
    const drawing = () => ({
      xLabel: data.labels[fields[0].value],
      yLabel: data.labels[fields[1].value],
      xLog: logs[0].checked,
      yLog: logs[1].checked,
      series: [{ x: column(0), y: column(1), className: "reach", of: branch }],
      points: marks(),
      parts: curves,
    });
    const show = () => chart.update(drawing());
    [0, 1].forEach(suggest);
    key();
    const chart = charts.plot(place, { ...drawing(), pick: "xy", tip, onHover, onLeave, onClick });
    return { mark: (row) => chart.mark(row) };
  }

  return { build };
})();
