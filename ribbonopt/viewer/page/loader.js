"use strict";
// Unpacks the script of the page, which stands there deflated, and runs it; says where that fails.
function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
}

function fail(error) {
  const old = typeof DecompressionStream === "undefined";
  const reason = old ? "this browser is too old (DecompressionStream is missing)" : error.message;
  document.getElementById("caption").textContent = `The page cannot be shown: ${reason}`;
  throw error;
}

(async () => {
  for (const part of ["main", "#theme"]) document.querySelector(part).hidden = false;
  const script = document.createElement("script");
  script.textContent = await inflated(document.getElementById("script").textContent).text();
  document.head.append(script);
})().catch(fail);
