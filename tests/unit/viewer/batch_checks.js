"use strict";
// Checks of diagrams and of batches in a browser, as charts_checks.js; `given` is made in Python.
const branch = (data, calls) => diagram.build(place(700, 500), data, calls);
const curves = () => [...document.querySelectorAll('.diagram g[class^="branch"] .line')];
const rows = () => [...document.querySelectorAll("tbody tr")].map((row) => row.cells[0].textContent);
const choose = (field, word) => {
  field.value = [...field.options].find((option) => option.text.startsWith(word)).value;
  field.onchange();
};

Object.assign(checks, {
  "a diagram tells states apart and cuts at jumps"() {
    branch(given.branch);
    const drawn = curves();
    const dashed = drawn.filter((line) => line.classList.contains("dashed"));
    assert(dashed.length === 1 && drawn.length === 3, drawn.length);
    assert(drawn.every((line) => line.getAttribute("d").includes("C")));
    assert(drawn[2].parentNode.classList.contains("branch1"));
    const legend = document.querySelector(".legend").textContent;
    for (const word of ["branch 1", "stable", "unstable", "branch point", "kink (1)"]) assert(legend.includes(word), legend);
    const titles = [...document.querySelectorAll(".point title")].map((title) => title.textContent);
    assert(titles.includes("branch point, point 2"), titles);
  },
  "a point of a diagram is told and chosen"() {
    let chosen = null;
    branch(given.branch, { onClick: (row) => (chosen = row) });
    const svg = document.querySelector(".chart svg");
    for (const key of ["ArrowRight", "ArrowRight", "ArrowRight", "ArrowRight", "Enter"]) {
      svg.dispatchEvent(new KeyboardEvent("keydown", { key }));
    }
    assert(chosen === 3, chosen);
    const tip = document.querySelector(".chart-tip").textContent;
    assert(tip === "point 3\nlaw.p: 3\nenergy: 6\nunstable, 1 direction", tip);
  },
  "other columns of a diagram"() {
    branch(given.branch);
    choose(document.querySelectorAll("select")[1], "u2");
    assert(document.querySelector(".chart-y").textContent === "u2");
    choose(document.querySelectorAll("select")[1], "estimated error");
    assert(document.querySelectorAll("input")[1].checked); // powers
  },
  "a curve under another is seen beside it"() {
    branch(given.mirrored);
    const behind = curves().map((line) => line.parentNode.classList.contains("behind"));
    assert(behind.join() === "false,true,false", behind);
  },
  "stages of a diagram one by one"() {
    branch(given.stages);
    const stage = document.querySelectorAll("select")[2];
    assert(stage.options.length === 3 && document.querySelector(".chart-foot").textContent === "law.q");
    choose(stage, "1");
    assert(document.querySelector(".chart-foot").textContent === "law.p" && curves().length === 3, curves().length);
    choose(stage, "2");
    assert(document.querySelector(".chart-foot").textContent === "law.q" && curves().length === 1, curves().length);
  },
  "diagrams and batches without rows"() {
    branch(given.none).mark(0);
    batch.build(place(), document.body, given.empty).choose(0);
    assert(!document.querySelector("svg, table"));
  },
  "a table is sorted, filtered and paged"() {
    place().append(document.createElement("div"));
    table.build(document.body.firstChild, given.batch);
    const head = (name) => [...document.querySelectorAll("th button")].find((one) => one.textContent === name);
    assert(rows().length === 100 && rows()[0] === "1" && rows()[99] === "100");
    head("energy").click();
    head("energy").click();
    assert(rows()[0] === "249" && document.querySelector('[aria-sort="descending"]'), rows()[0]); // 250 has failed
    document.querySelectorAll(".pages button")[1].click();
    document.querySelectorAll(".pages button")[1].click();
    assert(rows().length === 50 && rows().slice(-5).sort().join() === "100,150,200,250,50", rows()); // missing last
    choose(document.querySelector("select"), "failed");
    assert(rows().length === 5 && document.querySelector(".pages").hidden);
    choose(document.querySelector("select"), "all");
    assert(rows().length === 100);
  },
  "texts do not act"() {
    place();
    table.build(document.body.firstChild, given.hostile);
    scatter.build(document.body.firstChild, given.hostile);
    assert(!document.querySelector("td b, th b, option b, .legend b, .chart b"));
    assert(document.querySelector("tbody").textContent.includes("<b>bold</b>"));
    assert(!window.acted);
  },
  "scatter and table are linked"() {
    const above = place(), below = document.createElement("div"), told = [];
    document.body.append(below);
    batch.build(above, below, given.batch, (row) => told.push(row));
    below.querySelectorAll("tbody tr")[6].click();
    assert(told.join() === "6" && document.querySelector(".chosen").cells[0].textContent === "7");
    assert(above.querySelectorAll(".marks circle").length === 1);
    const svg = above.querySelector("svg");
    for (const key of ["End", "Enter"]) svg.dispatchEvent(new KeyboardEvent("keydown", { key }));
    assert(told.join() === "6,249", told);
    assert(document.querySelector(".chosen").cells[0].textContent === "250");
  },
  "words, one colour and powers of a scatter"() {
    scatter.build(place(), given.batch);
    const [x, y, colour] = document.querySelectorAll("select");
    choose(x, "word");
    assert([...document.querySelectorAll(".chart text")].some((one) => one.textContent === "left"));
    choose(colour, "(one");
    choose(y, "error");
    assert(document.querySelectorAll("input")[1].checked);
    assert(document.querySelector(".legend").textContent.includes("5 failed"), document.querySelector(".legend").textContent);
  },
});
