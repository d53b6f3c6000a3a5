"use strict";
// Draws a ribbon by WebGL 2: a lit surface, and lines as strips of a width in pixels.
// `makeWebgl(canvas)` gives null where there is none. Its pictures are of the view of camera.js.
const SURFACE = [
  `#version 300 es
  in vec3 point; in vec3 normal; in float pale; in float place;
  uniform mat4 matrix;
  out vec3 n; out float light; out float at;
  void main() { gl_Position = matrix * vec4(point, 1.0); n = normal; light = pale; at = place; }`,
  `#version 300 es
  precision highp float;
  in vec3 n; in float light; in float at;
  uniform mat3 axes; uniform vec3 front, back, paper, stops[7]; uniform float field;
  out vec4 result;
  void main() {
    vec3 seen = normalize(n) * axes;
    bool turned = seen.z < 0.0;
    if (turned) seen = -seen;
    vec3 colour = turned ? back : front;
    if (field > 0.5) {
      float k = clamp(at, 0.0, 1.0) * 6.0;
      int i = min(int(k), 5);
      colour = at < -0.01 ? vec3(0.6) : mix(stops[i], stops[i + 1], k - float(i));
    }
    colour = mix(colour, paper, 0.45 * light);
    vec3 lamp = normalize(vec3(-0.45, 0.6, 0.66));
    vec3 half_way = normalize(lamp + vec3(0.0, 0.0, 1.0));
    float diffuse = mix(0.6, 1.0, max(dot(seen, lamp), 0.0));
    float gloss = 0.16 * pow(max(dot(seen, half_way), 0.0), 24.0);
    result = vec4(min(colour * diffuse + gloss, 1.0), 1.0);
  }`,
];
const LINES = [
  `#version 300 es
  in vec3 from; in vec3 to; in float pale;
  uniform mat4 matrix; uniform vec2 size; uniform float width, push;
  out float light;
  void main() {
    vec4 a = matrix * vec4(from, 1.0), b = matrix * vec4(to, 1.0);
    vec2 way = (b.xy - a.xy) * size;
    way = length(way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
    bool last = gl_VertexID > 1;
    float side = gl_VertexID % 2 == 0 ? -1.0 : 1.0;
    vec2 aside = side * vec2(-way.y, way.x) + (last ? 0.5 : -0.5) * way;
    gl_Position = last ? b : a;
    gl_Position.xy += aside * width / size;
    gl_Position.z -= push;
    light = pale;
  }`,
  `#version 300 es
  precision highp float;
  in float light; uniform vec4 colour; out vec4 result;
  void main() { float a = colour.a * (1.0 - 0.45 * light); result = vec4(colour.rgb * a, a); }`,
];

function makeWebgl(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  let [surface, lines, buffers, mesh] = [];

  function program(sources) {
    const made = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((kind, k) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, sources[k]);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    });
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getProgramInfoLog(made) || "shaders cannot be linked");
    }
    const places = new Map();
    return {
      made,
      set: (kind, name, ...values) => {
        if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
        gl[`uniform${kind}`](places.get(name), ...values);
      },
    };
  }

  function prepare() {
    surface = program(SURFACE);
    lines = program(LINES);
    buffers = new Map();
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.LEQUAL);
  }

  function fill(name, data, target = gl.ARRAY_BUFFER) {
    if (!buffers.has(name)) buffers.set(name, gl.createBuffer());
    gl.bindBuffer(target, buffers.get(name));
    if (data) gl.bufferData(target, data, gl.DYNAMIC_DRAW);
  }

  function attribute(made, name, size, stride = 0, offset = 0, each = 0) {
    const place = gl.getAttribLocation(made, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(place, each);
  }

  function drawSurface(camera, look) {
    gl.useProgram(surface.made);
    const axes = [camera.right, camera.up, camera.towards].flat();
    surface.set("Matrix4fv", "matrix", false, camera.matrix());
    surface.set("Matrix3fv", "axes", false, axes);
    for (const name of ["front", "back", "paper"]) surface.set("3fv", name, look[name]);
    surface.set("1f", "field", look.stops ? 1 : 0);
    if (look.stops) surface.set("3fv", "stops", look.stops.flat());
    for (const [name, size] of [["points", 3], ["normals", 3], ["pale", 1], ["places", 1]]) {
      fill(name);
      attribute(surface.made, { points: "point", normals: "normal", places: "place" }[name] || name, size);
    }
    fill("faces", null, gl.ELEMENT_ARRAY_BUFFER);
    gl.drawElements(gl.TRIANGLES, mesh.faces.length, gl.UNSIGNED_INT, 0);
  }

  function drawLines(camera, name, count, style) {
    gl.useProgram(lines.made);
    lines.set("Matrix4fv", "matrix", false, camera.matrix());
    lines.set("2f", "size", camera.width, camera.height);
    lines.set("1f", "width", style.width);
    lines.set("1f", "push", style.push);
    lines.set("4fv", "colour", [...style.colour, style.opacity]);
    fill(name);
    attribute(lines.made, "from", 3, 28, 0, 1);
    attribute(lines.made, "to", 3, 28, 12, 1);
    attribute(lines.made, "pale", 1, 28, 24, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }

  prepare();
  return {
    lost: (before, again) => {
      canvas.addEventListener("webglcontextlost", (event) => (event.preventDefault(), before()));
      canvas.addEventListener("webglcontextrestored", () => (prepare(), again()));
    },
    load: (given) => {
      mesh = given;
      for (const name of ["points", "normals", "pale", "edges", "centre", "across"]) {
        fill(name, mesh[name]);
      }
      fill("faces", mesh.faces, gl.ELEMENT_ARRAY_BUFFER);
    },
    // Places of the points on a scale of colours, from 0 to 1; below 0 there is no number.
    paint: (places) => fill("places", places),
    // `marked` are segments that are drawn strongly, seen through what hides them.
    draw: (camera, look, marked) => {
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      drawSurface(camera, look);
      const styles = { across: [0.8, 0.4], centre: [1, 0.85], edges: [1.1, 0.9] };
      for (const [name, [width, opacity]] of Object.entries(styles)) {
        const style = { width, opacity, colour: look.lines, push: 2e-3 };
        drawLines(camera, name, mesh[name].length / 7, style);
      }
      if (!marked) return;
      fill("marked", marked);
      gl.disable(gl.DEPTH_TEST);
      const style = { width: 2.4, opacity: 0.4, colour: look.mark, push: 0 };
      drawLines(camera, "marked", marked.length / 7, style);
      gl.enable(gl.DEPTH_TEST);
      drawLines(camera, "marked", marked.length / 7, { ...style, opacity: 1, push: 6e-3 });
    },
  };
}
