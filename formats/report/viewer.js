// The 3D view of a report: one canvas per object, drawn with WebGL, from buffers that stand in the page.
"use strict";
(() => {
  const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const crease = Math.cos((40 * Math.PI) / 180);

  // Positions come in 16 bits of the box with a colour each, triangles as indices with three bytes of facts:
  // bridge, stress before, stress after; stress 0 means that none is known.
  function unpack(data) {
    const box = data.box;
    const packed = new Uint16Array(bytesOf(data.positions).buffer);
    const raw = bytesOf(data.triangles).buffer;
    const index = data.wide ? new Uint32Array(raw) : new Uint16Array(raw);
    const middle = [0, 1, 2].map((k) => (box[k] + box[k + 3]) / 2);
    const radius = Math.hypot(...[0, 1, 2].map((k) => box[k + 3] - box[k])) / 2 || 1;
    const points = new Float32Array(packed.length);
    for (let i = 0; i < packed.length; ++i) {
      const k = i % 3;
      points[i] = (box[k] + (packed[i] / 65535) * (box[k + 3] - box[k]) - middle[k]) / radius;
    }
    return { points, index, tints: bytesOf(data.tints), facts: bytesOf(data.facts), palette: bytesOf(data.palette) };
  }

  // Per corner, the mean of the normals around its vertex that are not across a sharp edge.
  function cornerNormals(mesh) {
    const { points, index } = mesh;
    const count = index.length / 3;
    const facet = new Float32Array(index.length);
    for (let t = 0; t < count; ++t) {
      const [a, b, c] = [0, 1, 2].map((k) => 3 * index[3 * t + k]);
      const u = [0, 1, 2].map((k) => points[b + k] - points[a + k]);
      const v = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
      facet[3 * t] = u[1] * v[2] - u[2] * v[1];
      facet[3 * t + 1] = u[2] * v[0] - u[0] * v[2];
      facet[3 * t + 2] = u[0] * v[1] - u[1] * v[0];
    }
    const first = new Uint32Array(points.length / 3 + 1);
    for (const v of index) ++first[v + 1];
    for (let v = 1; v < first.length; ++v) first[v] += first[v - 1];
    const fill = first.slice();
    const around = new Uint32Array(index.length);
    for (let c = 0; c < index.length; ++c) around[fill[index[c]]++] = (c / 3) | 0;
    const normals = new Float32Array(3 * index.length);
    for (let c = 0; c < index.length; ++c) {
      const t = 3 * ((c / 3) | 0);
      const length = Math.hypot(facet[t], facet[t + 1], facet[t + 2]);
      for (let i = first[index[c]]; i < first[index[c] + 1]; ++i) {
        const o = 3 * around[i];
        const dot = facet[t] * facet[o] + facet[t + 1] * facet[o + 1] + facet[t + 2] * facet[o + 2];
        if (dot < crease * length * Math.hypot(facet[o], facet[o + 1], facet[o + 2])) continue;
        for (let k = 0; k < 3; ++k) normals[3 * c + k] += facet[o + k];
      }
    }
    return normals;
  }

  function corners(mesh) {
    const out = new Float32Array(3 * mesh.index.length);
    for (let c = 0; c < mesh.index.length; ++c)
      for (let k = 0; k < 3; ++k) out[3 * c + k] = mesh.points[3 * mesh.index[c] + k];
    return out;
  }

  // Stress is blended between the triangles around a vertex.
  function colors(mesh, how) {
    const { index, tints, facts, palette } = mesh;
    const out = new Uint8Array(4 * index.length);
    const paint = (c, r, g, b) => out.set([r, g, b, 255], 4 * c);
    const column = how === "before" ? 1 : 2;
    const stress = how === "before" || how === "after";
    const sum = stress ? new Float32Array(mesh.points.length / 3) : null;
    const n = stress ? new Uint16Array(mesh.points.length / 3) : null;
    if (stress)
      for (let c = 0; c < index.length; ++c) {
        const value = facts[3 * ((c / 3) | 0) + column];
        if (value) { sum[index[c]] += value; ++n[index[c]]; }
      }
    for (let c = 0; c < index.length; ++c) {
      const t = 3 * ((c / 3) | 0);
      const v = 3 * index[c];
      if (how === "solid") paint(c, 214, 205, 190);
      else if (how === "pattern") paint(c, tints[v], tints[v + 1], tints[v + 2]);
      else if (how === "bridges") facts[t] ? paint(c, 214, 84, 32) : paint(c, 196, 199, 204);
      else if (!facts[t + column]) paint(c, 150, 150, 150);
      else {
        const p = 3 * Math.round(sum[index[c]] / n[index[c]]);
        paint(c, palette[p], palette[p + 1], palette[p + 2]);
      }
    }
    return out;
  }

  const vertexSource = `
    attribute vec3 place; attribute vec3 normal; attribute vec4 color;
    uniform mat3 turn; uniform vec2 scale; uniform vec2 shift; uniform float distance;
    varying vec3 n; varying vec4 c; varying vec3 eye;
    void main() {
      vec3 p = turn * place;
      n = turn * normal; c = color; eye = vec3(0.0, 0.0, distance) - p;
      float depth = distance - p.z;
      gl_Position = vec4((p.xy + shift * depth) * scale, (depth - distance) * 0.5, depth);
    }`;
  const fragmentSource = `
    precision mediump float;
    varying vec3 n; varying vec4 c; varying vec3 eye;
    void main() {
      vec3 v = normalize(eye);
      vec3 m = normalize(n);
      float back = dot(m, v) < 0.0 ? 1.0 : 0.0;
      if (back > 0.5) m = -m;
      float key = max(0.0, dot(m, normalize(vec3(-0.5, 0.7, 0.8))));
      float light = 0.52 + 0.18 * m.y + 0.5 * key;
      gl_FragColor = vec4(min(vec3(1.0), c.rgb * light * (1.0 - 0.25 * back)), 1.0);
    }`;

  function program(gl) {
    const made = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    return made;
  }

  function start(box) {
    const canvas = box.querySelector("canvas");
    const gl = canvas.getContext("webgl", { antialias: true, alpha: true, premultipliedAlpha: false });
    if (!gl) { box.querySelector(".nogl").hidden = false; canvas.hidden = true; return; }
    const mesh = unpack(JSON.parse(box.querySelector("script").textContent));
    const shader = program(gl);
    gl.useProgram(shader);
    gl.enable(gl.DEPTH_TEST);
    const buffer = (name, size, kind, values) => {
      const made = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, made);
      if (values) gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      const at = gl.getAttribLocation(shader, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, kind, kind === gl.UNSIGNED_BYTE, 0, 0);
      return made;
    };
    buffer("place", 3, gl.FLOAT, corners(mesh));
    buffer("normal", 3, gl.FLOAT, cornerNormals(mesh));
    const colorBuffer = buffer("color", 4, gl.UNSIGNED_BYTE, colors(mesh, "pattern"));

    const home = { around: 0.52, above: 0.3, distance: 2.7, x: 0, y: 0 };
    let view = { ...home };
    let waiting = false;

    function draw() {
      waiting = false;
      const ratio = Math.min(window.devicePixelRatio || 1, 2);
      const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
      const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
      if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
      gl.viewport(0, 0, width, height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const [s, c] = [Math.sin(view.around), Math.cos(view.around)];
      const [t, d] = [Math.sin(view.above), Math.cos(view.above)];
      // Columns of the matrix: where x, y and z of the model go; z is up.
      gl.uniformMatrix3fv(gl.getUniformLocation(shader, "turn"), false, [c, -s * t, s * d, s, c * t, -c * d, 0, d, t]);
      const zoom = 2.7;
      const side = Math.min(width, height);
      gl.uniform2f(gl.getUniformLocation(shader, "scale"), (zoom * side) / width, (zoom * side) / height);
      gl.uniform2f(gl.getUniformLocation(shader, "shift"), view.x, view.y);
      gl.uniform1f(gl.getUniformLocation(shader, "distance"), view.distance);
      gl.drawArrays(gl.TRIANGLES, 0, mesh.index.length);
    }
    const redraw = () => { if (!waiting) { waiting = true; requestAnimationFrame(draw); } };

    function show(how) {
      gl.bindBuffer(gl.ARRAY_BUFFER, colorBuffer);
      gl.bufferData(gl.ARRAY_BUFFER, colors(mesh, how), gl.STATIC_DRAW);
      for (const button of box.querySelectorAll("button[data-show]"))
        button.setAttribute("aria-pressed", String(button.dataset.show === how));
      redraw();
    }
    function move(dx, dy) {
      view.around -= dx * 0.009;
      view.above = Math.min(1.55, Math.max(-1.55, view.above + dy * 0.009));
      redraw();
    }
    function zoomBy(factor) {
      view.distance = Math.min(12, Math.max(1.15, view.distance * factor));
      redraw();
    }
    const reset = () => { view = { ...home }; redraw(); };

    const fingers = new Map();
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
    });
    canvas.addEventListener("pointermove", (e) => {
      const last = fingers.get(e.pointerId);
      if (!last) return;
      const [dx, dy] = [e.clientX - last[0], e.clientY - last[1]];
      const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
      const before = fingers.size === 2 ? spread() : 0;
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
      if (fingers.size === 2) {
        zoomBy(before / Math.max(1, spread()));
        view.x += (0.35 * dx) / canvas.clientHeight;
        view.y -= (0.35 * dy) / canvas.clientHeight;
      } else if (e.shiftKey || e.buttons === 2) {
        view.x += (0.7 * dx) / canvas.clientHeight;
        view.y -= (0.7 * dy) / canvas.clientHeight;
        redraw();
      } else move(dx, dy);
    });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, (e) => fingers.delete(e.pointerId));
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => {
      if (!e.ctrlKey && document.activeElement !== canvas) return;
      e.preventDefault();
      zoomBy(Math.exp(0.0015 * e.deltaY));
    }, { passive: false });
    canvas.addEventListener("dblclick", reset);
    canvas.addEventListener("keydown", (e) => {
      const steps = { ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12] };
      if (steps[e.key]) move(...steps[e.key]);
      else if (e.key === "+" || e.key === "=") zoomBy(0.9);
      else if (e.key === "-") zoomBy(1.1);
      else if (e.key === "0") reset();
      else return;
      e.preventDefault();
    });
    for (const button of box.querySelectorAll("button[data-show]"))
      button.addEventListener("click", () => show(button.dataset.show));
    box.querySelector("[data-zoom=in]").addEventListener("click", () => zoomBy(0.8));
    box.querySelector("[data-zoom=out]").addEventListener("click", () => zoomBy(1.25));
    box.querySelector("[data-reset]").addEventListener("click", reset);
    new ResizeObserver(redraw).observe(canvas);

    // How much of the picture the model fills: tells that the view works at all.
    draw();
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let drawn = 0;
    for (let i = 3; i < pixels.length; i += 4) drawn += pixels[i] ? 1 : 0;
    canvas.dataset.filled = (drawn / (canvas.width * canvas.height)).toFixed(4);
  }

  for (const box of document.querySelectorAll(".viewer")) start(box);
})();
