"use strict";
// What a hand does to a view: drag turns, with Shift or two fingers it moves, wheel and pinch zoom,
// a double click or Home begins anew; arrow keys turn, + and - zoom, x, y and z look along an axis.
function followHand(canvas, camera, { draw, hover }) {
  const PER_PIXEL = 0.008;
  const fingers = new Map();
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const middle = ([x, y]) => [x - camera.width / 2, y - camera.height / 2];

  canvas.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
    hover(-1e6, -1e6);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("pointerleave", () => hover(-1e6, -1e6));
  canvas.addEventListener("pointermove", (event) => {
    const now = place(event);
    const before = fingers.get(event.pointerId);
    if (!before) return hover(...now);
    const [x, y] = [now[0] - before[0], now[1] - before[1]];
    fingers.set(event.pointerId, now);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
      const apart = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]) || 1;
      camera.zoomAt(apart(now) / apart(before), ...middle([0, 1].map((k) => (now[k] + other[k]) / 2)));
      camera.pan(x / 2, y / 2);
    } else if (event.shiftKey || event.buttons === 2) {
      camera.pan(x, y);
    } else {
      camera.turn(x * PER_PIXEL, y * PER_PIXEL);
    }
    draw();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * [1, 30, 400][event.deltaMode];
      camera.zoomAt(Math.exp(-0.0015 * pixels), ...middle(place(event)));
      draw();
    },
    { passive: false },
  );
  const again = () => {
    const { centre } = camera;
    camera.reset();
    camera.centre = centre;
    draw();
  };
  canvas.addEventListener("dblclick", again);

  const keys = {
    ArrowLeft: () => camera.turn(-0.1, 0),
    ArrowRight: () => camera.turn(0.1, 0),
    ArrowUp: () => camera.turn(0, -0.1),
    ArrowDown: () => camera.turn(0, 0.1),
    "+": () => camera.zoomAt(1.2),
    "=": () => camera.zoomAt(1.2),
    "-": () => camera.zoomAt(1 / 1.2),
    x: () => camera.look([1, 0, 0], [0, 0, 1]),
    y: () => camera.look([0, 1, 0], [0, 0, 1]),
    z: () => camera.look([0, 0, 1], [0, 1, 0]),
    Home: again,
    0: again,
  };
  canvas.addEventListener("keydown", (event) => {
    if (!(event.key in keys) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
    draw();
  });
  return again;
}
