"use strict";
// Scatter and table of a batch, linked: a row that is pointed at or chosen in one is seen in both.
//
// const view = batch.build(element, element, data, onChoose?); view.choose(row)
const batch = (() => {
  function build(above, below, data, onChoose) {
    if (!data.rows.length) return { choose() {} };
    let chosen = null;
    const choose = (row) => {
      chosen = row;
      rows.choose(row);
      plot.mark(row);
      onChoose?.(row);
    };
    const back = () => plot.mark(chosen);
    const plot = scatter.build(above, data, { onLeave: back, onChoose: choose });
    const rows = table.build(below, data, {
      onHover: (row) => plot.mark(row),
      onLeave: back,
      onChoose: choose,
    });
    return { choose };
  }

  return { build };
})();
