"use strict";
// What a chart does under a pointer and under keys: finds the nearest point, marks it, tells of it.
const pointer = (() => {
  const REACH = 30; // pixels from a point, within which it is meant

  // Whether curves share their places along x, and these only grow.
  function ordered(series) {
    const first = series[0]?.x;
    if (!first || first.length < 2) return false;
    let last = -Infinity;
    for (let i = 0; i < first.length; i++) {
      if (first[i] < last || series.some(({ x }) => x !== first && x[i] !== first[i] && x[i] === x[i]))
        return false;
      if (first[i] > last) last = first[i];
    }
    return series.every(({ x }) => x.length === first.length);
  }

  // The nearest point of all series and the cloud, [index, series]; null if none is in reach.
  function nearest(px, py, box, asked, along) {
    let best = null;
    let least = along ? Infinity : REACH ** 2;
    const look = (x, y, i, k) => {
      const gap = along ? (x - px) ** 2 + 1e-6 * (y - py) ** 2 : (x - px) ** 2 + (y - py) ** 2;
      if (gap < least) [best, least] = [[i, k], gap];
    };
    box.placed.forEach((own, k) => own.forEach(([x, y], i) => look(x, y, i, k)));
    const count = asked.cloud ? asked.cloud.x.length : 0;
    for (let i = 0; i < count; i++) look(...box.spot(i), i, "cloud");
    return best;
  }

  function follow({ svg, stage, tip, said, chart, told, asked, box, along, head }) {
    let here = null;

    function place(event) {
      const frame = svg.getBoundingClientRect();
      const scale = box().width / frame.width;
      const px = (event.clientX - frame.left) * scale - box().left;
      const py = (event.clientY - frame.top) * scale - head;
      return nearest(px, py, box(), asked(), along());
    }

    function go(found) {
      if (!found) return leave();
      if (here && found[0] === here[0] && found[1] === here[1]) return;
      here = found;
      // Along x all curves have a point; where curves go anywhere, one of them.
      chart.mark(here[0], along() ? undefined : here[1]);
      showTip();
      asked().onHover?.(...here);
    }

    function leave() {
      if (!here) return;
      here = null;
      tip.hidden = true;
      chart.mark(null);
      asked().onLeave?.();
    }

    function spot() {
      const { placed, left } = box(),
        [i, k] = here;
      const [px, py] = k === "cloud" ? box().spot(i) : placed[k][i];
      return [px + left, py + head];
    }

    function showTip() {
      tip.hidden = !asked().tip;
      if (tip.hidden) return;
      tip.textContent = told(...here);
      const [px, py] = spot(),
        { width, height } = box();
      const beyond = px + 14 + tip.offsetWidth > width;
      tip.style.left = `${Math.max(beyond ? px - 14 - tip.offsetWidth : px + 14, 0)}px`;
      tip.style.top = `${Math.max(Math.min(py + 10, height - tip.offsetHeight), 0)}px`;
    }

    function key(event) {
      const series = asked().series || [];
      const now = here || [0, series.length ? 0 : "cloud"];
      const count = (k) => (k === "cloud" ? asked().cloud.x.length : series[k].x.length);
      const stride = event.shiftKey ? 10 : 1;
      const moves = { ArrowRight: stride, ArrowLeft: -stride, Home: -Infinity, End: Infinity };
      let [i, k] = now;
      if (event.key in moves) i = here ? i + moves[event.key] : event.key === "End" ? Infinity : 0;
      else if (event.key === "ArrowUp" || event.key === "ArrowDown")
        k = k === "cloud" ? k : k + (event.key === "ArrowUp" ? -1 : 1);
      else if (event.key === "Escape") return leave();
      else if ((event.key === "Enter" || event.key === " ") && here) asked().onClick?.(...here);
      else return;
      event.preventDefault();
      event.stopPropagation();
      if (k !== "cloud") k = Math.min(Math.max(k, 0), series.length - 1);
      if (k !== "cloud" && k < 0) return;
      i = Math.min(Math.max(i, 0), count(k) - 1);
      if (i < 0) return;
      go([i, k]);
      said.textContent = told(i, k);
    }

    stage.onpointermove = stage.onpointerdown = (event) => box() && go(place(event));
    stage.onpointerleave = leave;
    stage.onclick = (event) => {
      const found = box() && place(event);
      if (found) asked().onClick?.(...found);
    };
    svg.onkeydown = (event) => box() && key(event);
    svg.onblur = leave;
  }

  return { ordered, follow };
})();
