"use strict";
// Fields to choose what a chart shows: a column, and whether its axis is logarithmic.
//
// choice.column(parent, word, names, chosen, onChange) -> <select>; its value is a place in `names`
// choice.powers(parent, onChange) -> <input type=checkbox>
// choice.key(parent, d, className, text): an entry of a legend, with the sign that it tells of
const choice = (() => {
  function column(parent, word, names, chosen, onChange) {
    const label = charts.part("label", "", parent);
    const field = document.createElement("select");
    label.append(`${word} `, field);
    names.forEach((name, k) => field.add(new Option(name, k)));
    field.value = chosen;
    field.onchange = onChange;
    return field;
  }

  function powers(parent, onChange) {
    const label = charts.part("label", "", parent);
    const field = document.createElement("input");
    field.type = "checkbox";
    label.append(field, " log");
    field.onchange = onChange;
    return field;
  }

  function key(parent, d, className, text) {
    const entry = charts.part("span", "", parent);
    const sign = charts.node(
      "svg",
      { viewBox: "-11 -7 22 14", width: 22, height: 14, "aria-hidden": true },
      entry,
    );
    charts.node("path", { d, class: className }, sign);
    entry.append(` ${text}`);
    return entry;
  }

  return { column, powers, key };
})();
