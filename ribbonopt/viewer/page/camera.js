"use strict";
// The view of the ribbon: orthographic, turned, moved and zoomed; and what it makes of points.
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const unit = (a) => {
  const size = Math.hypot(...a) || 1;
  return a.map((part) => part / size);
};

// `frame` says how the view begins: axes [right, up, towards], and the half extents of all
// that is shown along them, about `centre`.
function makeCamera(frame) {
  const MOST = 60;
  const camera = { width: 1, height: 1 };

  camera.reset = () => {
    Object.assign(camera, { right: frame.axes[0], up: frame.axes[1], towards: frame.axes[2] });
    Object.assign(camera, { zoom: 1, move: [0, 0], centre: frame.centre });
  };

  camera.look = (towards, up) => {
    camera.towards = towards;
    camera.up = up;
    camera.right = cross(up, towards);
  };

  // Turn as a hand that moves by (x, y) radians on a ball in front of it.
  camera.turn = (x, y) => {
    const { right, up, towards } = camera;
    const about = (axis, angle, v) => {
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const across = cross(axis, v);
      return v.map((part, k) => c * part + s * across[k] + (1 - c) * dot(axis, v) * axis[k]);
    };
    const seen = unit(about(right, -y, about(up, -x, towards)));
    const level = unit(about(right, -y, about(up, -x, right)));
    camera.towards = seen;
    camera.up = unit(cross(seen, level));
    camera.right = cross(camera.up, seen);
  };

  // Zoom by a factor so that what is at (x, y), pixels from the middle and down, stays there.
  camera.zoomAt = (factor, x = 0, y = 0) => {
    const before = camera.scale;
    camera.zoom = Math.min(Math.max(camera.zoom * factor, 0.2), MOST);
    const change = 1 / before - 1 / camera.scale;
    camera.move = [camera.move[0] + x * change, camera.move[1] - y * change];
  };

  camera.pan = (x, y) => {
    camera.move = [camera.move[0] - x / camera.scale, camera.move[1] + y / camera.scale];
  };

  // Pixels of a unit of length.
  Object.defineProperty(camera, "scale", {
    get: () => {
      const [x, y] = frame.extent;
      const room = Math.min((0.5 * camera.width - 24) / x, (0.5 * camera.height - 34) / y);
      return camera.zoom * Math.max(room, 1e-3 / Math.max(x, y));
    },
  });

  // Pixels (x to the right, y down) of a point of the lab frame, and its height towards the viewer.
  camera.project = (x, y, z) => {
    const from = [x - camera.centre[0], y - camera.centre[1], z - camera.centre[2]];
    return [
      camera.width / 2 + camera.scale * (dot(from, camera.right) - camera.move[0]),
      camera.height / 2 - camera.scale * (dot(from, camera.up) - camera.move[1]),
      dot(from, camera.towards),
    ];
  };

  // The same as a matrix of OpenGL, column by column.
  camera.matrix = () => {
    const { right, up, towards, centre, move, scale } = camera;
    const [sx, sy, sz] = [(2 * scale) / camera.width, (2 * scale) / camera.height, -1 / frame.depth];
    const found = [0, 1, 2].flatMap((k) => [right[k] * sx, up[k] * sy, towards[k] * sz, 0]);
    const at = [dot(right, centre) + move[0], dot(up, centre) + move[1], dot(towards, centre)];
    return [...found, -at[0] * sx, -at[1] * sy, -at[2] * sz, 1];
  };

  camera.reset();
  return camera;
}
