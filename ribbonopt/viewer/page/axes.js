"use strict";
// Axes of charts: where a value lies between the ends of an axis, round numbers, texts that fit.
//
// axes.make({ values, range, log, words, most }) -> { place(v), value(t), ticks: [{ at, text }] }
//   values  arrays of numbers that are to be seen; null, NaN and infinities are passed over
//   range   [low, high] instead of what the values say
//   words   the words that the values 0, 1, ... stand for
//   most    ticks that there is room for
// `place` gives 0 at the low end and 1 at the high one, NaN where there is no value.
const axes = (() => {
  const NOISE = 1e-9;
  const LEAST = 1e-4; // as ribbonopt/views/columns.py: less is rounding
  const MARGIN = 0.05; // of the axis, beside what is drawn
  const pen = document.createElement("canvas").getContext("2d");

  const known = (v) => v !== null && v !== undefined && Number.isFinite(+v);

  function extent(arrays, positive = false) {
    let low = Infinity;
    let high = -Infinity;
    for (const values of arrays) {
      for (const v of values) {
        if (!known(v) || (positive && !(v > 0))) continue;
        if (v < low) low = v;
        if (v > high) high = v;
      }
    }
    return [low, high];
  }

  function make({ values = [], range, log = false, words, most = 6 }) {
    const f = log ? Math.log10 : (v) => v;
    const back = log ? (v) => 10 ** v : (v) => v;
    const [low, high] = words ? [-0.5, Math.max(words.length, 1) - 0.5] : ends(values, range, f, log);
    const place = (v) => (known(v) ? (f(v) - low) / (high - low) : NaN);
    const value = (t) => back(low + t * (high - low));
    const found = words ? words.map((text, k) => ({ v: k, text })) : round(low, high, log, most);
    const ticks = found.map(({ v, text }) => ({ at: place(v), text }));
    return {
      place,
      value,
      low,
      high,
      log,
      words,
      ticks: ticks.filter(({ at }) => at > -1e-9 && at < 1 + 1e-9),
    };
  }

  // Ends of an axis, of powers as logarithms; what is flat but for rounding lies in the middle.
  function ends(values, range, f, log) {
    const [low, high] = range || extent(values, log);
    if (low > high) return [0, 1];
    const size = Math.max(Math.abs(low), Math.abs(high), LEAST);
    if (high - low <= NOISE * size) {
      const middle = (low + high) / 2;
      const room = log ? 0.3 : Math.abs(middle) > NOISE * LEAST ? Math.abs(middle) / 2 : 1;
      return [f(middle) - room, f(middle) + room];
    }
    const margin = range ? 0 : MARGIN * (f(high) - f(low));
    return [f(low) - margin, f(high) + margin];
  }

  // Round numbers between two ends with their texts, as many as there is room for.
  function round(low, high, log, most) {
    const found = [];
    if (log && high - low > 1) {
      const factors = high - low < 2.5 && most > 5 ? [1, 2, 5] : [1];
      const stride = Math.max(1, Math.ceil((high - low) / most));
      for (let e = Math.floor(low); e <= high; e += stride) for (const k of factors) found.push(k * 10 ** e);
    } else {
      const [a, b] = log ? [10 ** low, 10 ** high] : [low, high];
      const unit = 10 ** Math.floor(Math.log10((b - a) / most));
      const step = [1, 2, 5, 10].map((k) => k * unit).find((s) => (b - a) / s <= most) || 10 * unit;
      for (let k = Math.ceil(a / step - 1e-9); k * step <= b + 1e-9 * step; k++) found.push(k * step);
    }
    const size = log ? 1 : Math.max(Math.abs(low), Math.abs(high)) / (high - low);
    const digits = Math.ceil(Math.log10(Math.max(1, size))) + 3;
    return found.map((v) => ({ v, text: say(v, digits) }));
  }

  // A number in few digits, with a minus sign that is one.
  function say(value, digits = 5) {
    if (!known(value)) return "none";
    const v = Number((+value).toPrecision(Math.min(digits, 15)));
    const size = Math.abs(v);
    const text = v !== 0 && (size < 1e-3 || size >= 1e6) ? v.toExponential() : String(v);
    return text.replaceAll("-", "−").replace("e+", "e");
  }

  // Long words differ at either end.
  function short(text, letters) {
    const half = Math.max(Math.floor((letters - 1) / 2), 1);
    const signs = [...text];
    if (signs.length <= letters) return text;
    return `${signs.slice(0, half).join("")}…${signs.slice(-half).join("")}`;
  }

  function width(text, font) {
    pen.font = font;
    return pen.measureText(text).width;
  }

  return { extent, known, make, say, short, width };
})();
