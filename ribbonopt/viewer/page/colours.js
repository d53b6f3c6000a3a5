"use strict";
// Colours of the page, as the style sheet has them, and the scales that colour the surface.
const colours = (() => {
  // From low to high: one scale for numbers of one sign, one with its middle at zero. Lightness rises
  // evenly along the first and to both sides of the second, so that they are read without hues too.
  const RISING = ["#2b1a56", "#3b3f8f", "#2f6a9e", "#1f8f98", "#3bb07f", "#8ccb5e", "#e8dc56"];
  const SIGNED = ["#123f73", "#3a78b8", "#8fb6d9", "#e4e2de", "#efb184", "#d2692f", "#8c2d04"];

  function parsed(text) {
    const digits = text.trim().slice(1);
    const long = digits.length === 3 ? [...digits].map((d) => d + d).join("") : digits;
    return [0, 2, 4].map((k) => parseInt(long.slice(k, k + 2), 16) / 255);
  }

  // A variable of the style sheet, as it is in light or dark, as three numbers from 0 to 1.
  function named(name) {
    return parsed(getComputedStyle(document.documentElement).getPropertyValue(name));
  }

  // What colours a field of values from low to high: stops, and the place of a value from 0 to 1.
  function scale([low, high]) {
    const signed = low < 0 && high > 0;
    const far = Math.max(-low, high);
    const [from, to] = signed ? [-far, far] : [low, high];
    const size = to - from || 1;
    return {
      stops: (signed ? SIGNED : RISING).map(parsed),
      css: (signed ? SIGNED : RISING).join(","),
      from,
      to: from + size,
      place: (value) => (Number.isNaN(value) ? -1 : Math.min(Math.max((value - from) / size, 0), 1)),
    };
  }

  function mixed(stops, place) {
    const at = place * (stops.length - 1);
    const k = Math.min(Math.floor(at), stops.length - 2);
    return stops[k].map((low, c) => low + (at - k) * (stops[k + 1][c] - low));
  }

  return { named, scale, mixed };
})();
