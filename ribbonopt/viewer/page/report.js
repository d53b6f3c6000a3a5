"use strict";
// The report of a batch: light or dark, its scatter and its table.
(() => {
  const get = (id) => document.getElementById(id);
  const data = JSON.parse(get("data").textContent);
  const media = matchMedia("(prefers-color-scheme: dark)");
  const dark = (on) => document.documentElement.classList.toggle("dark", on);
  dark(media.matches);
  media.addEventListener("change", () => dark(media.matches));
  get("theme").hidden = false;
  get("theme").onclick = () => dark(!document.documentElement.classList.contains("dark"));
  if (!data.rows.length) return;
  get("plot").hidden = get("all").hidden = false;
  batch.build(get("scatter"), get("rows"), data);
})();
