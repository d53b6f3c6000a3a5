"use strict";
// The curves along the ribbon: strains, their path in the plane, force and moment. Each marks the
// row under the pointer, and `onHover(row)` tells it to the others. `makePanels(place, onHover)`
// gives show(i) and mark(row).
function makePanels(place, onHover) {
  const NOTHING = 1e-7; // of the largest strain: less is rounding
  const made = new Map(); // by name: chart, its rows by point, its points by row
  const label = (quantity, unit) => (unit ? `${quantity} (${unit})` : quantity);
  const { units } = view;
  const abscissa = label("arclength s", units.length);

  function largest(i, name) {
    return shapes.rows(i)[name].reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
  }

  // A curve as what was solved and, dashed, what follows by symmetry; over the same points.
  function series(i, names, x = "s") {
    return names.flatMap((name) => {
      const { x: places, y, row } = shapes.along(i, name, x);
      const { solved, count } = view.shapes[i];
      const cut = (keep) => y.map((value, k) => (keep(row[k]) ? value : NaN));
      const found = [{ x: places, y: cut((j) => j < solved), name: named(name), className: name }];
      if (solved < count) {
        const y2 = cut((j) => j >= solved);
        found.push({ x: places, y: y2, className: name, dashed: true });
      }
      return found;
    });
  }

  const named = (name) => name.replace("1", "₁").replace("2", "₂").replace("3", "₃");

  // Of the plane: with the origin, from which regions spread.
  function around(i, name) {
    const values = shapes.rows(i)[name].filter((value) => !Number.isNaN(value));
    const [low, high] = range([name]) || [Math.min(...values), Math.max(...values)];
    const room = 0.06 * Math.max(high - low, high, -low);
    return values.length ? [Math.min(low, 0) - room, Math.max(high, 0) + room] : undefined;
  }

  // Over all shapes, so that they can be compared; what is but rounding lies in the middle.
  function range(names) {
    const known = names.every((name) => view.ranges[name]);
    if (view.shapes.length < 2 || view.kind === "batch" || !known) return undefined;
    const [low, high] = [Math.min, Math.max].map((least, k) =>
      least(...names.map((name) => view.ranges[name][k])),
    );
    const room = 0.05 * (high - low);
    const flat = !(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high), 1e-300));
    return flat ? undefined : [low - room, high + room];
  }

  function region(i) {
    const far = 50 * Math.max(largest(i, "u2"), largest(i, "u3"), 1e-12);
    return [1, -1].map((sign) => ({
      x: [0, sign * far, sign * far],
      y: [0, far, -far],
      className: "allowed",
    }));
  }

  function ends(i) {
    const rows = shapes.rows(i);
    const last = rows.solved - 1;
    const at = (j, mark, title) => ({ x: rows.u2[j], y: rows.u3[j], mark, title, className: "u2" });
    return [at(0, "dot", "start"), at(last, "square open", "end of what was solved")];
  }

  const kinds = {
    strains: (i) => {
      const most = Math.max(...["u1", "u2", "u3"].map((name) => largest(i, name)));
      const names = largest(i, "u1") > NOTHING * most ? ["u1", "u2", "u3"] : ["u2", "u3"];
      const yRange = range(names);
      return { series: series(i, names), yRange, yLabel: label("strains", units.strain) };
    },
    plane: (i) => ({
      series: series(i, ["u3"], "u2").map((one) => ({ ...one, name: undefined, className: "u2" })),
      xLabel: label("bending u₂", units.strain),
      yLabel: label("twist u₃", units.strain),
      xRange: around(i, "u2"),
      yRange: around(i, "u3"),
      equal: true,
      pick: "xy",
      regions: view.allowed ? region(i) : [],
      points: ends(i),
    }),
    forces: (i) => ({
      series: series(i, ["n1", "n2", "n3"]),
      yRange: range(["n1", "n2", "n3"]),
      yLabel: label("force along the directors", units.force),
    }),
    moments: (i) => ({
      series: series(i, ["m1", "m2", "m3"]),
      yRange: range(["m1", "m2", "m3"]),
      yLabel: label("moment along the directors", units.moment),
    }),
  };

  function show(i) {
    const { row } = shapes.along(i, "u2");
    const points = new Map(row.map((j, k) => [j, k]));
    for (const [name, options] of Object.entries(kinds)) {
      if (name === "plane" && view.shapes[i].rod) {
        made.get(name)?.element.setAttribute("hidden", "");
        continue;
      }
      const given = { xLabel: abscissa, pick: "x", ...options(i) };
      const known = made.get(name);
      if (known) {
        known.element.removeAttribute("hidden");
        Object.assign(known, { row, points });
        known.chart.update(given);
        known.chart.mark(null);
      } else {
        made.set(name, begin(name, given, row, points));
      }
    }
  }

  function begin(name, given, row, points) {
    const element = document.createElement("div");
    element.className = name;
    place.append(element);
    const panel = { element, row, points };
    panel.chart = charts.plot(element, {
      ...given,
      onHover: (k) => onHover(panel.row[k], panel.chart),
      onLeave: () => onHover(null, panel.chart),
    });
    return panel;
  }

  return {
    show,
    mark: (row, except) => {
      for (const { chart, points } of made.values()) {
        if (chart !== except) chart.mark(row === null ? null : points.get(row));
      }
    },
  };
}
