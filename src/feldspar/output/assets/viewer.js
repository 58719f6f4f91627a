// The failure pattern: triangles drawn into a buffer of triangle numbers, then coloured; cracks as lines over it. And the
// rosette of crack directions.
"use strict";

const stops = {   // colours that stay in order in grey and for the colour-blind
  viridis: ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"],
  earth: ["#f6f1e7", "#e8d3ae", "#d4a373", "#a9714b", "#6f4a3a", "#3b2a2e"],
  cividis: ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"],
  puor: ["#542788", "#8073ac", "#b2abd2", "#d8daeb", "#f7f7f7", "#fee0b6", "#fdb863", "#e08214", "#b35806"],
};

function rgb(hex) { return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)); }

/** 256 colours as packed pixels. */
function palette(name) {
  const list = stops[name].map(rgb), table = new Uint32Array(256);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (list.length - 1), k = Math.min(Math.floor(at), list.length - 2), t = at - k;
    const [r, g, b] = [0, 1, 2].map((c) => Math.round(list[k][c] + t * (list[k + 1][c] - list[k][c])));
    table[i] = (255 << 24) | (b << 16) | (g << 8) | r;
  }
  return table;
}

function css(pixel) { return "rgb(" + (pixel & 255) + "," + ((pixel >> 8) & 255) + "," + ((pixel >> 16) & 255) + ")"; }

/** The parts of a block (layout: report_fields.cpp). */
async function readFields(meta, element) {
  const packed = Uint8Array.from(atob(element.textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const buffer = await new Response(stream).arrayBuffer();
  const types = {float32: Float32Array, int32: Int32Array, uint16: Uint16Array, int16: Int16Array, uint8: Uint8Array};
  const parts = {};
  for (const [name, part] of Object.entries(meta.parts)) parts[name] = new types[part.type](buffer, part.at, part.count);
  return parts;
}

class Specimen {
  constructor(meta, parts) {
    Object.assign(this, {meta, parts});
    const count = parts.corners.length / 3;
    this.corners = new Int32Array(parts.corners.length);
    this.grain = new Int32Array(count);
    for (let g = 0; g + 1 < parts.triangle_begin.length; ++g) {
      for (let t = parts.triangle_begin[g]; t < parts.triangle_begin[g + 1]; ++t) {
        this.grain[t] = g;
        for (let k = 0; k < 3; ++k) this.corners[3 * t + k] = parts.node_begin[g] + parts.corners[3 * t + k];
      }
    }
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let n = 0; n < parts.nodes.length; n += 2) {
      x0 = Math.min(x0, parts.nodes[n]); x1 = Math.max(x1, parts.nodes[n]);
      y0 = Math.min(y0, parts.nodes[n + 1]); y1 = Math.max(y1, parts.nodes[n + 1]);
    }
    Object.assign(this, {x0, x1, y0, y1});
    this.moves = [];
  }

  /** Displacement of each node at snapshot n, mm: all x, then all y. */
  displacement(n) {
    if (!this.moves[n]) {
      const steps = this.parts["u" + n], scale = this.meta.snapshots[n].scale, nodes = steps.length / 2;
      const u = new Float32Array(steps.length);
      for (let axis = 0; axis < 2; ++axis) {
        let sum = 0;
        for (let i = 0; i < nodes; ++i) {
          sum = ((sum + steps[axis * nodes + i]) << 16) >> 16;   // 16-bit, as it was written
          u[axis * nodes + i] = sum * scale;
        }
      }
      this.moves[n] = u;
    }
    return this.moves[n];
  }

  /** The same at a moment that may lie between two snapshots: between their displacements in proportion. */
  displacementAt(moment) {
    const n = Math.floor(moment), share = moment - n;
    if (!(share > 0) || n + 1 >= this.meta.snapshots.length) return this.displacement(Math.min(n, this.meta.snapshots.length - 1));
    const from = this.displacement(n), to = this.displacement(n + 1), u = new Float32Array(from.length);
    for (let i = 0; i < u.length; ++i) u[i] = from[i] + share * (to[i] - from[i]);
    return u;
  }

  /** Cracks, strain and stress at such a moment. */
  state(moment) {
    const n = Math.floor(moment), share = moment - n, all = this.meta.snapshots, a = all[n], b = all[Math.min(n + 1, all.length - 1)];
    const mix = (key) => a[key] + share * (b[key] - a[key]);
    const cracks = Math.round(mix("cracks"));
    return {n, share, cracks, drawn: Math.ceil(cracks / (this.meta.crack_every || 1)), tensile: Math.min(cracks, Math.round(mix("tensile"))), strain: mix("strain"), stress: mix("stress"), label: share > 0 ? "between " + a.label + " and " + b.label : a.label};
  }

  /** Positions at a moment with displacements times `magnify`, mm: x, y of each node. */
  positions(moment, magnify) {
    const u = this.displacementAt(moment), nodes = u.length / 2, p = new Float32Array(2 * nodes);
    for (let i = 0; i < nodes; ++i) {
      p[2 * i] = this.parts.nodes[2 * i] + magnify * u[i];
      p[2 * i + 1] = this.parts.nodes[2 * i + 1] + magnify * u[nodes + i];
    }
    return p;
  }

  /** The factor of displacements that moves the farthest node by `share` of the specimen's size, rounded down to 1, 2 or 5 times a power of ten; at least 1. */
  enlargement(share) {
    if (this.farthest === undefined) {
      let squared = 0;
      for (let n = 0; n < this.meta.snapshots.length; ++n) {
        const u = this.displacement(n), nodes = u.length / 2;
        for (let i = 0; i < nodes; ++i) squared = Math.max(squared, u[i] * u[i] + u[nodes + i] * u[nodes + i]);
      }
      this.farthest = Math.sqrt(squared);
    }
    if (!(this.farthest > 0)) return 1;
    const wanted = (share * Math.max(this.x1 - this.x0, this.y1 - this.y0)) / this.farthest, power = 10 ** Math.floor(Math.log10(wanted));
    return Math.max(1, [5, 2, 1].map((k) => k * power).find((f) => f <= wanted) || power);
  }

  /** What the specimen takes up over all its moments with displacements times `magnify`, mm: [x0, x1, y0, y1]. */
  bounds(magnify) {
    let [x0, x1, y0, y1] = [this.x0, this.x1, this.y0, this.y1];
    if (magnify > 0) {
      for (let n = 0; n < this.meta.snapshots.length; ++n) {
        const p = this.positions(n, magnify);
        for (let i = 0; i < p.length; i += 2) {
          x0 = Math.min(x0, p[i]); x1 = Math.max(x1, p[i]);
          y0 = Math.min(y0, p[i + 1]); y1 = Math.max(y1, p[i + 1]);
        }
      }
    }
    return [x0, x1, y0, y1];
  }

  /** A field that follows from what is stored, a value a triangle at snapshot n. */
  derived(field, n) {
    this.fields ||= {};
    if (this.fields[field + n]) return this.fields[field + n];
    const count = this.grain.length, values = new Float32Array(count);
    if (field === "mean" || field === "deviatoric") {
      const [low1, high1] = this.meta.sigma1, [low3, high3] = this.meta.sigma3, one = this.parts["sigma1_" + n], three = this.parts["sigma3_" + n];
      for (let t = 0; t < count; ++t) {
        const s1 = low1 + (one[t] / 255) * (high1 - low1), s3 = low3 + (three[t] / 255) * (high3 - low3);
        values[t] = field === "mean" ? 0.5 * (s1 + s3) : s1 - s3;
      }
    } else if (field === "displacement") {
      const u = this.displacement(n), nodes = u.length / 2;
      for (let t = 0; t < count; ++t) {
        let x = 0, y = 0;
        for (let k = 0; k < 3; ++k) { x += u[this.corners[3 * t + k]] / 3; y += u[nodes + this.corners[3 * t + k]] / 3; }
        values[t] = Math.hypot(x, y);
      }
    } else if (field === "rotation") {
      const turns = this.rotations(n);
      for (let t = 0; t < count; ++t) values[t] = turns[this.grain[t]];
    }
    return (this.fields[field + n] = values);
  }

  /** Rotation of each grain at snapshot n, 10^-3 rad, anticlockwise: that of the rigid motion which fits its corners best. */
  rotations(n) {
    const u = this.displacement(n), nodes = u.length / 2, {node_begin: begin, vertex_count: corners, nodes: at} = this.parts, turns = new Float32Array(corners.length);
    for (let g = 0; g < corners.length; ++g) {
      let x = 0, y = 0, ux = 0, uy = 0, turn = 0, size = 0;
      for (let i = begin[g]; i < begin[g] + corners[g]; ++i) { x += at[2 * i] / corners[g]; y += at[2 * i + 1] / corners[g]; ux += u[i] / corners[g]; uy += u[nodes + i] / corners[g]; }
      for (let i = begin[g]; i < begin[g] + corners[g]; ++i) {
        const dx = at[2 * i] - x, dy = at[2 * i + 1] - y;
        turn += dx * (u[nodes + i] - uy) - dy * (u[i] - ux);
        size += dx * dx + dy * dy;
      }
      turns[g] = size > 0 ? (1e3 * turn) / size : 0;
    }
    return turns;
  }

  /** The range of such a field over all snapshots, without its outermost hundredths. */
  range(field) {
    this.ranges ||= {};
    if (!this.ranges[field]) {
      const all = [];
      for (let n = 0; n < this.meta.snapshots.length; ++n) { const v = this.derived(field, n); for (let t = 0; t < v.length; t += 3) all.push(v[t]); }
      const list = Float32Array.from(all).sort();
      this.ranges[field] = [list[Math.floor(0.01 * (list.length - 1))], list[Math.ceil(0.99 * (list.length - 1))]];
    }
    return this.ranges[field];
  }

  /** How far crack c is open at a moment, mm: of its faces, across it. Not known for a few cracks: NaN. */
  opening(c, u) {
    const {crack_ends: ends, crack_nodes: faces, nodes, node_begin: begin, vertex_count: corners} = this.parts, count = u.length / 2;
    const [a0, a1, b0, b1] = [0, 1, 2, 3].map((k) => faces[4 * c + k]);
    if (a0 < 0 || b0 < 0) return NaN;
    if (!this.nodeGrain) {
      this.nodeGrain = new Int32Array(count);
      for (let g = 0; g + 1 < begin.length; ++g) this.nodeGrain.fill(g, begin[g], begin[g + 1]);
    }
    const middle = (g, k) => { let sum = 0; for (let i = begin[g]; i < begin[g] + corners[g]; ++i) sum += nodes[2 * i + k] / corners[g]; return sum; };
    const ga = this.nodeGrain[a0], gb = this.nodeGrain[b0], dx = ends[4 * c + 2] - ends[4 * c], dy = ends[4 * c + 3] - ends[4 * c + 1], length = Math.hypot(dx, dy) || 1;
    let nx = -dy / length, ny = dx / length;
    if (nx * (middle(gb, 0) - middle(ga, 0)) + ny * (middle(gb, 1) - middle(ga, 1)) < 0) { nx = -nx; ny = -ny; }
    const x = (ends[4 * c] + ends[4 * c + 2]) / 2, y = (ends[4 * c + 1] + ends[4 * c + 3]) / 2;
    const moved = (p, q) => {   // of the place on a face
      const ex = nodes[2 * q] - nodes[2 * p], ey = nodes[2 * q + 1] - nodes[2 * p + 1], t = Math.min(1, Math.max(0, ((x - nodes[2 * p]) * ex + (y - nodes[2 * p + 1]) * ey) / (ex * ex + ey * ey || 1)));
      return [u[p] + t * (u[q] - u[p]), u[count + p] + t * (u[count + q] - u[count + p])];
    };
    const [ax, ay] = moved(a0, a1), [bx, by] = moved(b0, b1);
    return (bx - ax) * nx + (by - ay) * ny;
  }
  /** The opening that few cracks exceed at the end, mm. */
  wideOpening() {
    if (this.wide === undefined) {
      const last = this.meta.snapshots.length - 1, u = this.displacement(last), list = [];
      for (let c = 0; c < this.state(last).drawn; ++c) { const w = this.opening(c, u); if (w > 0) list.push(w); }
      list.sort((a, b) => a - b);
      this.wide = list.length ? list[Math.floor(0.9 * (list.length - 1))] : 0;
    }
    return this.wide;
  }

  /** Ends of crack c, midway between its faces, mm. */
  crack(c, positions) {
    const {crack_ends: ends, crack_nodes: faces, crack_square: squares, nodes} = this.parts, out = [0, 0, 0, 0];
    if (squares) {   // moves as its square does
      let ux = 0, uy = 0;
      const q = squares[c];
      for (let i = 4 * q; q >= 0 && i < 4 * q + 4; ++i) { ux += (positions[2 * i] - nodes[2 * i]) / 4; uy += (positions[2 * i + 1] - nodes[2 * i + 1]) / 4; }
      return [ends[4 * c] + ux, ends[4 * c + 1] + uy, ends[4 * c + 2] + ux, ends[4 * c + 3] + uy];
    }
    for (let end = 0; end < 2; ++end) {
      const x = ends[4 * c + 2 * end], y = ends[4 * c + 2 * end + 1];
      let found = 0;
      for (let side = 0; side < 2; ++side) {
        const a = faces[4 * c + 2 * side], b = faces[4 * c + 2 * side + 1];
        if (a < 0 || b < 0) continue;
        const ex = nodes[2 * b] - nodes[2 * a], ey = nodes[2 * b + 1] - nodes[2 * a + 1];
        const t = Math.min(1, Math.max(0, ((x - nodes[2 * a]) * ex + (y - nodes[2 * a + 1]) * ey) / (ex * ex + ey * ey || 1)));
        out[2 * end] += positions[2 * a] + t * (positions[2 * b] - positions[2 * a]);
        out[2 * end + 1] += positions[2 * a + 1] + t * (positions[2 * b + 1] - positions[2 * a + 1]);
        ++found;
      }
      if (found) { out[2 * end] /= found; out[2 * end + 1] /= found; }
      else { out[2 * end] = x; out[2 * end + 1] = y; }
    }
    return out;
  }
}

/** Fills `ids` (width x height) with the number of the triangle at each pixel's centre, -1 where there is none. */
function rasterise(ids, width, height, px, py, corners) {
  ids.fill(-1);
  for (let t = 0; t < corners.length / 3; ++t) {
    const a = corners[3 * t], b = corners[3 * t + 1], c = corners[3 * t + 2];
    const xs = [px[a], px[b], px[c]], ys = [py[a], py[b], py[c]];
    const top = Math.max(0, Math.ceil(Math.min(ys[0], ys[1], ys[2]) - 0.5)), bottom = Math.min(height - 1, Math.floor(Math.max(ys[0], ys[1], ys[2]) - 0.5));
    for (let row = top; row <= bottom; ++row) {
      const y = row + 0.5;
      let from = Infinity, to = -Infinity;
      for (let k = 0; k < 3; ++k) {
        const x0 = xs[k], y0 = ys[k], x1 = xs[(k + 1) % 3], y1 = ys[(k + 1) % 3];
        if ((y0 <= y) === (y1 <= y)) continue;
        const x = x0 + ((y - y0) / (y1 - y0)) * (x1 - x0);
        if (x < from) from = x;
        if (x > to) to = x;
      }
      const first = Math.max(0, Math.ceil(from - 0.5)), last = Math.min(width - 1, Math.floor(to - 0.5));
      for (let column = first; column <= last; ++column) ids[row * width + column] = t;
    }
  }
}

const fieldKinds = {
  grain: {label: "grains", scale: null},
  damage: {label: "damage of the grain edges", scale: "earth", unit: ""},
  sigma1: {label: "major principal stress \u03c3\u2081", scale: "cividis", unit: "MPa"},
  sigma3: {label: "minor principal stress \u03c3\u2083", scale: "puor", unit: "MPa", around: true, words: "violet tension, orange compression"},
  mean: {label: "mean stress (\u03c3\u2081 + \u03c3\u2083)/2", scale: "puor", unit: "MPa", around: true, derived: true, words: "violet tension, orange compression"},
  deviatoric: {label: "deviatoric stress \u03c3\u2081 \u2212 \u03c3\u2083", scale: "cividis", unit: "MPa", derived: true},
  displacement: {label: "displacement", scale: "viridis", unit: "mm", derived: true},
  rotation: {label: "rotation of the grains", scale: "puor", unit: "10\u207b\u00b3 rad", around: true, derived: true, words: "violet clockwise, orange anticlockwise"},
  fragments: {label: "fragments", scale: null},
};
/** Colours of the pieces behind the largest, which keeps the grains' own. */
const pieceColours = ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#0072b2", "#d55e00", "#999999"];

class Viewer {
  /** onSnapshot(n) is called when another moment is shown; marksOf(test) are cracks to point at: {name, crack, look: [colour, mark, size]}. */
  constructor(canvas, readout, onSnapshot, marksOf) {
    Object.assign(this, {canvas, readout, onSnapshot, marksOf, field: "grain", cracks: "mode", magnify: 1, snapshot: 0, moment: 0, specimen: null, ids: null});
    canvas.addEventListener("pointerdown", (e) => { this.drag = [e.offsetX, e.offsetY]; canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener("pointerup", () => { this.drag = null; });
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerleave", () => { readout.textContent = ""; });
    canvas.addEventListener("dblclick", () => this.reset());
    canvas.addEventListener("wheel", (e) => {
      if (!e.ctrlKey && !e.metaKey && !e.shiftKey) return;   // the plain wheel scrolls the page
      e.preventDefault();
      this.zoom(Math.exp(-(e.deltaY || e.deltaX) * 0.0025), e.offsetX, e.offsetY);
    }, {passive: false});
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  show(specimen) {
    this.specimen = specimen;
    this.moment = this.snapshot = Math.max(0, specimen.meta.snapshots.length - 1);
    this.resize();
    this.reset();
    this.onSnapshot(this.snapshot);
  }
  /** Shows a moment, which may lie between two snapshots: cracks and displacements are then between theirs, the colours those of the one before. */
  goTo(moment) {
    this.moment = moment;
    this.snapshot = Math.floor(moment);
  }

  /** Displacements times so much; the specimen stays in view. */
  enlarge(factor) {
    this.magnify = factor;
    this.reset();
  }

  resize() {
    if (!this.specimen) return;
    const dpr = printing ? 3 : Math.min(devicePixelRatio, 2), css = this.canvas.parentElement.clientWidth;
    const {x0, x1, y0, y1} = this.specimen;
    const high = Math.round(Math.min(Math.max(css * 1.08 * (y1 - y0) / (x1 - x0), 260), printing ? 430 : 720));
    if (this.cssWidth === css && this.cssHeight === high && this.dpr === dpr && this.ids) return;
    const first = !this.ids;
    Object.assign(this, {cssWidth: css, cssHeight: high, dpr});
    this.canvas.style.height = high + "px";
    this.canvas.width = Math.max(1, Math.round(css * dpr));
    this.canvas.height = Math.round(high * dpr);
    this.ids = new Int32Array(this.canvas.width * this.canvas.height);
    if (first || this.fitted) this.fit();
    this.paint();   // at once: a canvas of another size is blank
  }

  /** The whole specimen in view. */
  reset() {
    this.fit();
    this.draw();
  }

  fit() {
    if (!this.specimen || !this.ids) return;
    const [x0, x1, y0, y1] = this.specimen.bounds(this.magnify);
    this.fitted = true;
    this.scale = 0.93 * Math.min(this.canvas.width / (x1 - x0), this.canvas.height / (y1 - y0));   // pixels a mm
    this.cx = (x0 + x1) / 2;
    this.cy = (y0 + y1) / 2;
  }

  zoom(factor, atX = this.cssWidth / 2, atY = this.cssHeight / 2) {
    const dx = (atX * this.dpr - this.canvas.width / 2) / this.scale, dy = -(atY * this.dpr - this.canvas.height / 2) / this.scale;
    this.scale *= factor;
    this.cx += dx - dx / factor;
    this.cy += dy - dy / factor;
    this.fitted = false;
    this.draw();
  }

  move(e) {
    if (this.drag) {
      this.cx -= ((e.offsetX - this.drag[0]) * this.dpr) / this.scale;
      this.cy += ((e.offsetY - this.drag[1]) * this.dpr) / this.scale;
      this.drag = [e.offsetX, e.offsetY];
      this.fitted = false;
      this.draw();
      return;
    }
    const t = this.ids ? this.ids[Math.floor(e.offsetY * this.dpr) * this.canvas.width + Math.floor(e.offsetX * this.dpr)] : -1;
    if (t === undefined || t < 0) { this.readout.textContent = ""; return; }
    const s = this.specimen, n = this.snapshot, kind = fieldKinds[this.field], piece = s.parts["fragment" + n];
    const value = (field) => { const [low, high] = s.meta[field]; return low + (s.parts[field + "_" + n][t] / 255) * (high - low); };
    this.readout.textContent = (s.meta.squares ? "square of " + show(s.meta.squares.side) + " mm" : "grain " + s.grain[t]) + (s.meta.minerals ? ", " + s.meta.minerals[s.parts.phase[s.grain[t]]].name : "") + "  \u00b7  \u03c3\u2081 \u2248 " + show(value("sigma1")) + " MPa  \u00b7  \u03c3\u2083 \u2248 " +
      show(value("sigma3")) + " MPa  \u00b7  damage " + show(s.parts["damage" + n][t] / 255, 2) + (kind.derived ? "  \u00b7  " + kind.label.replace(/ [(\u03c3].*/, "") + " " + show(s.derived(this.field, n)[t]) + " " + kind.unit : "") +
      (this.field === "fragments" && piece ? "  \u00b7  piece " + (piece[s.grain[t]] + 1) : "");
  }

  /** Limits of the field's colours: around zero for a field whose sign matters. */
  limits() {
    if (this.field === "damage") return [0, 1];
    const [low, high] = fieldKinds[this.field].derived ? this.specimen.range(this.field) : this.specimen.meta[this.field];
    if (!fieldKinds[this.field].around) return [low, high];
    const reach = (this.field === "rotation" ? Math.max(Math.abs(low), Math.abs(high)) : Math.max(Math.abs(low), Math.min(Math.abs(high), 3 * Math.abs(low)))) || 1;
    return [-reach, reach];
  }

  draw() {
    if (!this.specimen || !this.ids) return;
    if (printing) { this.paint(); return; }   // paper does not wait for a frame
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.paint(); });
  }

  paint() {
    const {canvas, specimen: s} = this, ctx = canvas.getContext("2d"), width = canvas.width, height = canvas.height;
    const p = s.positions(this.moment, this.magnify), count = p.length / 2, px = new Float32Array(count), py = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      px[i] = width / 2 + (p[2 * i] - this.cx) * this.scale;
      py[i] = height / 2 - (p[2 * i + 1] - this.cy) * this.scale;
    }
    rasterise(this.ids, width, height, px, py, s.corners);
    const image = ctx.createImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    const colors = this.triangleColors();
    for (let i = 0; i < pixels.length; ++i) if (this.ids[i] >= 0) pixels[i] = colors[this.ids[i]];
    ctx.clearRect(0, 0, width, height);
    ctx.putImageData(image, 0, 0);
    this.paintGrainEdges(ctx, px, py);
    this.paintJoints(ctx);
    this.paintCracks(ctx, p);
    this.paintMarks(ctx, p);
    this.paintRuler(ctx);
  }

  triangleColors() {
    const s = this.specimen, n = this.snapshot, count = s.grain.length, colors = new Uint32Array(count);
    if (this.field === "grain" || this.field === "fragments") {
      const piece = this.field === "fragments" ? s.parts["fragment" + n] : null, pieces = pieceColours.map(rgb);
      const minerals = (s.meta.minerals || []).map((m) => rgb(m.colour)), plain = rgb(theme.get("grain"));
      for (let t = 0; t < count; ++t) {
        const number = piece ? piece[s.grain[t]] : 0;
        const [r, g, b] = number > 0 ? pieces[(number - 1) % pieces.length] : minerals.length && !piece ? minerals[s.parts.phase[s.grain[t]]] : plain;
        if (s.meta.squares) { colors[t] = (255 << 24) | (b << 16) | (g << 8) | r; continue; }
        const unit = s.parts.crystal ? s.parts.crystal[s.grain[t]] : s.grain[t];
        const shade = 1 - (s.parts.crystal ? 0.15 : 0.075) * (((unit * 2654435761) >>> 0) / 4294967296);   // neighbours differ a little
        colors[t] = (255 << 24) | (Math.round(b * shade) << 16) | (Math.round(g * shade) << 8) | Math.round(r * shade);
      }
      return colors;
    }
    const table = palette(fieldKinds[this.field].scale);
    const derived = fieldKinds[this.field].derived ? s.derived(this.field, n) : null, levels = s.parts[this.field + (this.field === "damage" ? "" : "_") + n];
    const [low, high] = this.field === "damage" || derived ? [0, 1] : s.meta[this.field], [from, to] = this.limits();
    for (let t = 0; t < count; ++t) {
      const value = derived ? derived[t] : low + (levels[t] / 255) * (high - low);
      colors[t] = table[Math.min(255, Math.max(0, Math.round((255 * (value - from)) / (to - from || 1))))];
    }
    return colors;
  }

  paintGrainEdges(ctx, px, py) {
    if (this.specimen.meta.squares) return;
    const {node_begin: begin, vertex_count: corners} = this.specimen.parts;
    ctx.beginPath();
    for (let g = 0; g < corners.length; ++g) {
      for (let k = 0; k <= corners[g]; ++k) {
        const node = begin[g] + (k % corners[g]);
        if (k === 0) ctx.moveTo(px[node], py[node]);
        else ctx.lineTo(px[node], py[node]);
      }
    }
    ctx.strokeStyle = theme.get("edge");
    ctx.lineWidth = Math.min(1, 0.45 * this.dpr);
    ctx.stroke();
  }

  /** Joints where they were before the test, dashed. */
  paintJoints(ctx) {
    const ends = this.specimen.parts.joint_ends;
    if (!ends) return;
    ctx.beginPath();
    for (let i = 0; i < ends.length; i += 4) {
      ctx.moveTo(ctx.canvas.width / 2 + (ends[i] - this.cx) * this.scale, ctx.canvas.height / 2 - (ends[i + 1] - this.cy) * this.scale);
      ctx.lineTo(ctx.canvas.width / 2 + (ends[i + 2] - this.cx) * this.scale, ctx.canvas.height / 2 - (ends[i + 3] - this.cy) * this.scale);
    }
    ctx.strokeStyle = theme.get("ink");
    ctx.lineWidth = 1.4 * this.dpr;
    ctx.setLineDash([4 * this.dpr, 3 * this.dpr]);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  paintCracks(ctx, positions) {
    if (this.cracks === "none") return;
    const s = this.specimen, {crack_mode: mode, crack_strain: strain} = s.parts, count = s.state(this.moment).drawn;
    const u = this.cracks === "opening" ? s.displacementAt(this.moment) : null, wide = u ? s.wideOpening() || 1 : 1;
    const groups = new Map();   // colour -> lines
    const table = palette("viridis"), [first, last] = this.crackTimes();
    for (let c = 0; c < count; ++c) {
      let color = theme.get("ink");
      if (this.cracks === "mode") color = mode[c] ? "shear" : "tensile";
      else if (this.cracks === "time") color = css(table[Math.round((15 * (strain[c] - first)) / (last - first || 1)) * 17]);
      else if (u) { const w = s.opening(c, u); color = Number.isFinite(w) ? css(table[Math.round(15 * Math.min(1, Math.max(0, w / wide))) * 17]) : theme.get("context"); }
      if (!groups.has(color)) groups.set(color, []);
      groups.get(color).push(s.crack(c, positions));
    }
    const line = Math.min(4.5, Math.max(1.5, 0.16 * this.scale / this.dpr)) * this.dpr;
    const trace = (lines) => {
      ctx.beginPath();
      for (const [x0, y0, x1, y1] of lines) {
        ctx.moveTo(ctx.canvas.width / 2 + (x0 - this.cx) * this.scale, ctx.canvas.height / 2 - (y0 - this.cy) * this.scale);
        ctx.lineTo(ctx.canvas.width / 2 + (x1 - this.cx) * this.scale, ctx.canvas.height / 2 - (y1 - this.cy) * this.scale);
      }
      ctx.stroke();
    };
    ctx.lineCap = "round";
    if (this.field !== "grain") {   // a halo keeps the lines readable on any colour
      ctx.strokeStyle = theme.get("halo");
      ctx.lineWidth = line + 2.2 * this.dpr;
      for (const lines of groups.values()) trace(lines);
    }
    ctx.lineWidth = line;
    for (const [color, lines] of groups) {
      ctx.strokeStyle = /^[a-z]+$/.test(color) ? theme.get(color) : color;
      trace(lines);
    }
  }

  /** Points at cracks with a name, once they are there. */
  paintMarks(ctx, positions) {
    const s = this.specimen, count = s.state(this.moment).cracks;
    const every = s.meta.crack_every || 1;
    for (const {crack, look: [color, mark, size]} of this.marksOf(s.meta.test)) {
      if (crack >= count || crack % every) continue;
      const [x0, y0, x1, y1] = s.crack(crack / every, positions);
      const x = this.canvas.width / 2 + ((x0 + x1) / 2 - this.cx) * this.scale, y = this.canvas.height / 2 - ((y0 + y1) / 2 - this.cy) * this.scale;
      drawMark(ctx, mark, x, y, (size + 3.5) * this.dpr, theme.get("halo"));
      drawMark(ctx, mark, x, y, (size + 1.5) * this.dpr, color);
    }
  }

  /** What is shown on a sheet with two lines of words above it. `canvas`: drawn over, or new. */
  sheet(title, words, canvas = h("canvas", {})) {
    const {width, height} = this.canvas, k = this.dpr, head = 48 * k;
    if (canvas.width !== width || canvas.height !== height + head) { canvas.width = width; canvas.height = height + head; }
    const ctx = canvas.getContext("2d");
    ctx.fillStyle = theme.get("card");
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.fillStyle = theme.get("ink");
    ctx.font = "600 " + 14 * k + "px system-ui, sans-serif";
    ctx.fillText(fitted(ctx, title, width - 20 * k), 10 * k, 19 * k);
    ctx.fillStyle = theme.get("soft");
    ctx.font = 12 * k + "px system-ui, sans-serif";
    ctx.fillText(fitted(ctx, words, width - 20 * k), 10 * k, 38 * k);
    ctx.drawImage(this.canvas, 0, head);
    return canvas;
  }

  crackTimes() {
    const {crack_strain: strain} = this.specimen.parts;
    return strain.length ? [strain[0], strain[strain.length - 1]] : [0, 1];
  }

  /** A scale bar of a round length. */
  paintRuler(ctx) {
    const wanted = 90 * this.dpr / this.scale, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((k) => k * power).find((l) => l <= wanted) || power;
    const x = 10 * this.dpr, y = ctx.canvas.height - 10 * this.dpr, to = x + length * this.scale;
    ctx.strokeStyle = ctx.fillStyle = theme.get("ink");
    ctx.lineWidth = 1.5 * this.dpr;
    ctx.beginPath();
    ctx.moveTo(x, y - 4 * this.dpr); ctx.lineTo(x, y); ctx.lineTo(to, y); ctx.lineTo(to, y - 4 * this.dpr);
    ctx.stroke();
    ctx.font = 12 * this.dpr + "px system-ui, sans-serif";
    ctx.textAlign = "left";
    ctx.fillText(length < 1000 ? show(length, 1) + " mm" : show(length / 1000, 1) + " m", x + 4 * this.dpr, y - 6 * this.dpr);
    if (this.magnify === 1) return;
    ctx.textAlign = "right";
    ctx.fillText(this.magnify > 1 ? "displacements \u00d7 " + this.magnify : "undeformed", ctx.canvas.width - 10 * this.dpr, y - 2 * this.dpr);
  }
}

/** Directions of the cracks that exist at a moment, weighted by length, from the loading axis; both halves alike. */
function drawRosette(canvas, specimen, moment) {
  const bins = 18, length = [new Float64Array(bins), new Float64Array(bins)];
  const {crack_ends: ends, crack_mode: mode} = specimen.parts;
  for (let c = 0; c < specimen.state(moment).drawn; ++c) {
    const dx = ends[4 * c + 2] - ends[4 * c], dy = ends[4 * c + 3] - ends[4 * c + 1];
    const angle = (Math.atan2(dx, dy) + 2 * Math.PI) % Math.PI;   // clockwise from the loading axis, 0 ... pi
    length[mode[c]][Math.min(bins - 1, Math.floor((angle / Math.PI) * bins))] += Math.hypot(dx, dy);
  }
  let longest = 0;
  for (let b = 0; b < bins; ++b) longest = Math.max(longest, length[0][b] + length[1][b]);
  const dpr = printing ? 3 : Math.min(devicePixelRatio, 2), size = Math.max(180, Math.min(printing ? 230 : 330, canvas.parentElement.clientWidth));
  canvas.width = canvas.height = Math.round(size * dpr);
  canvas.style.height = size + "px";
  canvas.style.width = size + "px";
  const ctx = canvas.getContext("2d"), middle = canvas.width / 2, radius = middle - 30 * dpr;
  ctx.clearRect(0, 0, canvas.width, canvas.height);
  ctx.font = 11.5 * dpr + "px system-ui, sans-serif";
  ctx.strokeStyle = theme.get("line");
  ctx.lineWidth = dpr;
  for (const share of [1 / 3, 2 / 3, 1]) {
    ctx.beginPath();
    ctx.arc(middle, middle, radius * share, 0, 2 * Math.PI);
    ctx.stroke();
  }
  for (let d = 0; d < 180; d += 30) {
    const a = (d * Math.PI) / 180;
    ctx.beginPath();
    ctx.moveTo(middle - radius * Math.sin(a), middle + radius * Math.cos(a));
    ctx.lineTo(middle + radius * Math.sin(a), middle - radius * Math.cos(a));
    ctx.stroke();
  }
  const wedge = (b, inner, outer, color) => {
    if (outer <= inner) return;
    for (const turn of [0, Math.PI]) {
      const a0 = (b * Math.PI) / bins - Math.PI / 2 + turn, a1 = ((b + 1) * Math.PI) / bins - Math.PI / 2 + turn;
      ctx.beginPath();
      ctx.arc(middle, middle, outer * radius, a0, a1);
      ctx.arc(middle, middle, inner * radius, a1, a0, true);
      ctx.closePath();
      ctx.fillStyle = color;
      ctx.fill();
      ctx.strokeStyle = theme.get("card");
      ctx.lineWidth = 0.8 * dpr;
      ctx.stroke();
    }
  };
  if (longest > 0) {
    for (let b = 0; b < bins; ++b) {
      wedge(b, 0, length[0][b] / longest, theme.get("tensile"));
      wedge(b, length[0][b] / longest, (length[0][b] + length[1][b]) / longest, theme.get("shear"));
    }
  }
  ctx.fillStyle = theme.get("soft");
  ctx.textBaseline = "alphabetic";
  ctx.textAlign = "center";
  ctx.fillText("0\u00b0 loading axis", middle, 15 * dpr);
  ctx.fillText("90\u00b0", canvas.width - 15 * dpr, middle + 4 * dpr);
  ctx.fillText(longest > 0 ? "outer ring: " + show(longest, 3) + " mm in 10\u00b0" : "no cracks yet", middle, canvas.height - 8 * dpr);
}
