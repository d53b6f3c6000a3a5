"use strict";
// Table of the rows of a batch: sorted by any column, some statuses, a page of rows at a time.
//
// const view = table.build(element, data, { onHover(row), onLeave(), onChoose(row) });
// view.choose(row)                          // shows its page and tells it apart
const table = (() => {
  const PAGE = 100;
  const LONGEST = 60;
  const words = new Intl.Collator("en", { numeric: true });
  const ALL = "all";
  const FAILED = "failed";

  const put = (tag, parent, text = "") => {
    const made = charts.part(tag, "", parent);
    made.textContent = text;
    return made;
  };

  // What is missing comes last, whichever way rows are sorted.
  function compare(a, b, down) {
    if (a === null || b === null) return (a === null) - (b === null);
    const order = typeof a === "number" && typeof b === "number" ? a - b : words.compare(a, b);
    return down ? -order : order;
  }

  function build(element, data, { onHover, onLeave, onChoose } = {}) {
    const form = charts.part("div", "choice", element);
    const scroll = charts.part("div", "scroll", element);
    const { names, rows } = data;
    const status = names.indexOf("status");
    const number = names.indexOf("number");
    let sorted = number;
    let down = false;
    let from = 0;
    let chosen = null;
    let kept = rows.map((_, row) => row);

    const statuses = [...new Set(rows.map((row) => row[status]))];
    const count = (of) => rows.filter((_, row) => of(row)).length;
    const filters = [[`${ALL} ${rows.length}`, () => true]];
    if (data.verified.includes(false))
      filters.push([`${FAILED} ${count((row) => !data.verified[row])}`, (row) => !data.verified[row]]);
    for (const name of statuses)
      filters.push([
        `${name} ${count((row) => rows[row][status] === name)}`,
        (row) => rows[row][status] === name,
      ]);
    const filter = choice.column(
      form,
      "status",
      filters.map(([text]) => text),
      0,
      () => arrange(),
    );
    const pages = charts.part("span", "pages", form);
    const back = put("button", pages, "‹");
    const where = put("output", pages);
    const on = put("button", pages, "›");
    back.setAttribute("aria-label", "rows before");
    on.setAttribute("aria-label", "rows after");
    back.onclick = () => turn(from - PAGE);
    on.onclick = () => turn(from + PAGE);

    const whole = put("table", scroll);
    const head = put("tr", put("thead", whole));
    const body = put("tbody", whole);
    names.forEach((name, k) => {
      const cell = put("th", head);
      const sign = put("button", cell, name);
      cell.className = sortsOf(k);
      sign.onclick = () => {
        [sorted, down] = [k, sorted === k && !down];
        arrange();
      };
    });

    function sortsOf(k) {
      return `${data.minor[k] ? "minor" : ""} ${data.numeric[k] ? "n" : ""}`.trim();
    }

    function arrange() {
      const keep = filters[filter.value][1];
      kept = rows.map((_, row) => row).filter(keep);
      kept.sort((a, b) => compare(rows[a][sorted], rows[b][sorted], down) || a - b);
      [...head.children].forEach((cell, k) => {
        if (k === sorted) cell.setAttribute("aria-sort", down ? "descending" : "ascending");
        else cell.removeAttribute("aria-sort");
      });
      turn(0);
    }

    function turn(to) {
      from = Math.max(Math.min(to, kept.length - 1), 0);
      from -= from % PAGE;
      const seen = kept.slice(from, from + PAGE);
      body.replaceChildren(...seen.map(line));
      where.textContent = kept.length ? `${from + 1} to ${from + seen.length} of ${kept.length}` : "no rows";
      back.disabled = from === 0;
      on.disabled = from + PAGE >= kept.length;
      pages.hidden = kept.length <= PAGE;
    }

    function line(row) {
      const made = document.createElement("tr");
      rows[row].forEach((value, k) => cell(made, row, value, k));
      if (row === chosen) made.className = "chosen";
      made.onpointerenter = () => onHover?.(row);
      made.onpointerleave = () => onLeave?.();
      if (onChoose) made.onclick = () => onChoose(row);
      return made;
    }

    function cell(made, row, value, k) {
      const text = value === null ? "" : typeof value === "number" ? axes.say(value, 6) : value;
      const place = put("td", made);
      const link = k === number && data.links[value];
      place.className = sortsOf(k) + (k === status && !data.verified[row] ? " bad" : "");
      if (text.length > LONGEST) place.title = text;
      const said = text.length > LONGEST ? `${text.slice(0, LONGEST - 1)}…` : text;
      if (link) put("a", place, said).href = link;
      else if (onChoose && k === number) put("button", place, said);
      else place.textContent = said;
    }

    function choose(row) {
      chosen = row;
      const at = kept.indexOf(row);
      turn(at < 0 ? from : at);
      // Within the table only: the page stays where it is, so that what was clicked is seen.
      const line = body.querySelector(".chosen");
      if (line) scroll.scrollTop = line.offsetTop - scroll.clientHeight / 2;
    }

    arrange();
    return { choose };
  }

  return { build };
})();
