// Line charts with free x (a strain may turn back): uPlot gives axes, grid, cursor and zoom, the curves are drawn over them.
"use strict";

const theme = {
  get(name) { return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim(); },
};

/** Makes an element: h("p", {class: "soft"}, "text", child). Text is always text, never markup. */
function h(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value);
  }
  for (const child of children.flat()) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}

/** A number for reading: `digits` significant ones, a true minus sign, thin exponents. */
function show(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text;
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(Math.max(digits - 2, 0)).split("e");
    const raised = [...String(Number(exponent))].map((c) => (c === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c])).join("");
    text = mantissa + "\u00b710" + raised;
  } else {
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    text = value.toFixed(Math.min(decimals, 6));
  }
  return text.replace("-", "\u2212");
}

const charts = new Set();

function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const list of values) {
    for (const v of list) {
      if (v === null || !Number.isFinite(v)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  }
  return low > high ? [0, 1] : [low, high];
}

/** Zero stays in sight, the rest gets a margin. */
function padded([low, high]) {
  low = Math.min(low, 0);
  high = Math.max(high, 0);
  const margin = 0.05 * (high - low || 1);
  return [low < 0 ? low - margin : low, high > 0 ? high + margin : high];
}

/** Draws `mark` ("dot", "ring", "diamond", "square", "triangle") at canvas position (x, y). */
function drawMark(ctx, mark, x, y, size, color, dpr = devicePixelRatio) {
  ctx.beginPath();
  if (mark === "diamond") {
    ctx.moveTo(x, y - size * 1.25); ctx.lineTo(x + size * 1.25, y); ctx.lineTo(x, y + size * 1.25); ctx.lineTo(x - size * 1.25, y); ctx.closePath();
  } else if (mark === "triangle") {
    ctx.moveTo(x, y - size * 1.2); ctx.lineTo(x + size * 1.1, y + size * 0.8); ctx.lineTo(x - size * 1.1, y + size * 0.8); ctx.closePath();
  } else if (mark === "square") {
    ctx.rect(x - size, y - size, 2 * size, 2 * size);
  } else {
    ctx.arc(x, y, size, 0, 2 * Math.PI);
  }
  if (mark === "ring") {
    ctx.strokeStyle = color; ctx.lineWidth = 2 * dpr; ctx.fillStyle = theme.get("card"); ctx.fill(); ctx.stroke();
  } else {
    ctx.fillStyle = color; ctx.fill();
  }
}

let printing = false;   // charts are then drawn finer than the screen: a sheet has more dots

/** The unit in the last brackets of an axis's words: "MPa" of "Stress (MPa)"; of "(MPa, compression positive)" what is before the comma. */
function unitOfLabel(label) {
  const found = /\(([^()]*)\)\s*$/.exec(label || "");
  return found ? found[1].split(",")[0] : "";
}
/** A value with its unit for reading; powers of ten are a factor. */
function withUnit(value, label) {
  const unit = unitOfLabel(label);
  return show(value, 4) + (/^10[\u207b\u2070-\u2079\u00b9\u00b2\u00b3]+$/.test(unit) ? "\u00b7" + unit : unit ? "\u00a0" + unit : "");
}

/** The words of an axis, shortened to so many pixels of the canvas: the quantity and its unit stay as long as they can. */
function fitted(ctx, label, room) {
  const fits = (text) => ctx.measureText(text).width <= room;
  if (!label || fits(label)) return label;
  const unit = unitOfLabel(label), words = label.replace(/\s*\([^()]*\)\s*$/, "").split(" "), tail = unit ? " (" + unit + ")" : "";
  for (let n = words.length; n > 0; --n) {
    const text = words.slice(0, n).join(" ").replace(/,$/, "") + (n < words.length ? "\u2026" : "") + tail;
    if (fits(text)) return text;
  }
  return tail.trim() || label;
}

/** Grains and the cracks between them, in the colours of the theme. Grain g has the corners begin[g] ... begin[g + 1] - 1; corner(i): where one lies on the canvas.
    cracks: of each its mode (0 tensile, 1 shear) and both ends on the canvas. */
function drawCracked(ctx, begin, corner, cracks, edgeWidth, crackWidth) {
  ctx.beginPath();
  for (let g = 0; g + 1 < begin.length; ++g) {
    for (let i = begin[g]; i < begin[g + 1]; ++i) {
      if (i === begin[g]) ctx.moveTo(...corner(i));
      else ctx.lineTo(...corner(i));
    }
    ctx.closePath();
  }
  ctx.fillStyle = theme.get("grain");
  ctx.fill();
  ctx.strokeStyle = theme.get("edge");
  ctx.lineWidth = edgeWidth;
  ctx.stroke();
  ctx.lineCap = "round";
  ctx.lineWidth = crackWidth;
  for (const mode of [0, 1]) {
    ctx.beginPath();
    for (const crack of cracks) {
      if (crack.mode !== mode) continue;
      ctx.moveTo(...crack.from);
      ctx.lineTo(...crack.to);
    }
    ctx.strokeStyle = theme.get(mode ? "shear" : "tensile");
    ctx.stroke();
  }
}

/** Hands `blob` to the reader as a file. */
function saveAs(blob, name) {
  const link = h("a", {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
function fileName(title, ending) { return (title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "chart") + ending; }
/** Text that a spreadsheet would take for a formula gets an apostrophe, as in the program's own tables; a number with its unit does not. */
function csvCell(text) {
  if (/^[=+\-@\t]/.test(text) && !/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?([ %a-z\u0080-\uffff][ %/.a-z0-9\u0080-\uffff]*)?$/i.test(text)) text = "'" + text;
  return /[",\n]/.test(text) ? '"' + text.replaceAll('"', '""') + '"' : text;
}

/**
 * A chart in `host`. series: [{label, x, y, color (a theme name or a colour), width, dash, mark, size, right, quiet, note}];
 * `right` uses the right axis, `quiet` keeps a series out of the legend and the tooltip,
 * `key: false` out of the legend only. `low` and `high` draw a bar through each point: its interval, which the tooltip names.
 * `bar` draws columns of this width (in x) from `base` (zero without) up to y, x being their left edge; `off: true` starts hidden; `glow` draws a broad faint line.
 * options: {x, y, right (labels), height, xRange, yRange, xTicks: words at x = 0, 1, ..., equal: one scale for both axes, yLog: a logarithmic y axis, whole: the right axis counts}.
 *
 * A reader zooms by dragging a box, goes back by a double click, hides series in the legend, reads values off under the cursor, and saves picture or numbers.
 */
class XYChart {
  constructor(host, options) {
    this.host = h("div", {class: "chart", style: "min-height:" + (options.height || 300) + "px"});
    this.tip = h("div", {class: "tip"});
    this.legend = h("div", {class: "legend"});
    this.at = h("span", {class: "at"});
    this.whole = h("button", {type: "button", hidden: "", onclick: () => this.rebuild()}, "Whole chart");
    this.tools = h("div", {class: "tools"}, this.at, this.whole, h("button", {type: "button", title: "Save the chart as a picture", onclick: () => this.savePicture()}, "PNG"),
      h("button", {type: "button", title: "Save the numbers of the chart as a table", onclick: () => this.saveTable()}, "CSV"));
    this.hidden = new Set((options.series || []).filter((s) => s.off).map((s) => s.label));
    host.append(this.legend, this.host, this.tools);
    this.options = options;
    this.set(options.series);
    charts.add(this);
    new ResizeObserver(() => {
      if (printing || !this.plot || (this.width() === this.drawn[0] && this.height() === this.drawn[1])) return;
      if (this.zoomed) { this.drawn = [this.width(), this.height()]; this.plot.setSize({width: this.drawn[0], height: this.drawn[1]}); }
      else this.rebuild();
    }).observe(this.host);
  }

  height() {
    const least = this.options.height || 300;
    if (this.options.equal && this.ranges) {   // 64 and 72 pixels are the axes'
      const [x, y] = this.ranges;
      return Math.round(Math.max(160, Math.min(760, ((this.width() - 64 - 22) * (y[1] - y[0])) / (x[1] - x[0]) + 72)));
    }
    return printing ? Math.min(least, 250) : Math.max(least, Math.floor(this.host.clientHeight));
  }
  width() { return Math.max(180, Math.floor(this.host.clientWidth)); }
  title() {
    const heading = this.host.parentElement && this.host.parentElement.querySelector("h4");
    return heading ? heading.textContent : this.options.y || "chart";
  }
  color(series) { return /^[a-z]+$/.test(series.color) ? theme.get(series.color) : series.color; }
  visible() { return this.series.filter((s) => !this.hidden.has(s.label)); }

  set(series) {
    this.series = series.filter((s) => s.x.length > 0);
    this.rebuild();
  }

  /** The same series with more points: the chart stays as the reader has it, zoomed or under the cursor. */
  grow(series) {
    const before = this.series.map((s) => s.label).join("\n"), next = series.filter((s) => s.x.length > 0);
    if (!this.plot || printing || next.map((s) => s.label).join("\n") !== before) { this.set(series); return; }
    this.series = next;
    if (!this.zoomed) {
      const shown = this.visible();
      this.ranges = [padded(extent(shown.map((s) => s.x))), padded(extent(shown.filter((s) => !s.right).map((s) => s.y)))];
      this.rightRange = padded(extent(this.series.filter((s) => s.right).map((s) => s.y)));
      this.plot.setData([this.ranges[0], ...this.plot.data.slice(1)]);
    } else this.plot.redraw(false, true);
  }

  rebuild() {
    if (this.plot) this.plot.destroy();
    const shown = this.visible(), left = shown.filter((s) => !s.right), right = this.series.filter((s) => s.right);
    const o = this.options, k = this.fine = printing ? 3 : 1;
    const edges = (s) => (s.bar ? [...s.x, s.x[s.x.length - 1] + s.bar] : s.x);
    const x = o.xRange || padded(extent(shown.map(edges)));
    let y = o.yRange || padded(extent(left.flatMap((s) => [s.y, s.low || [], s.high || []])));
    if (o.yLog && !o.yRange) {
      const [low, high] = extent(left.map((s) => s.y.filter((v) => v > 0)));
      y = [10 ** Math.floor(Math.log10(low) - 1e-9), 10 ** Math.ceil(Math.log10(high) + 0.05)];
    }
    this.ranges = [x, y];
    this.host.style.height = o.equal || printing ? this.height() + "px" : "";
    this.rightRange = padded(extent(right.map((s) => s.y)));
    const ink = theme.get("soft"), line = theme.get("line");
    const write = (t) => (t === null ? "" : String(Number(t.toPrecision(6))).replace("-", "\u2212"));
    // Sizes of fonts in whole pixels: uPlot scales nothing else. An axis is as wide as its longest number.
    const axis = (scale, label, side, grid) => ({
      scale, side, label: (u) => fitted(u.ctx, label, side === 2 ? u.bbox.width : u.bbox.height), stroke: ink, font: Math.round((printing ? 11 : 12) * k) + "px system-ui, sans-serif", labelFont: Math.round((printing ? 11 : 13) * k) + "px system-ui, sans-serif", labelGap: (side === 2 ? 2 : 4) * k,
      labelSize: 22 * k, gap: 4 * k, grid: {show: grid, stroke: line, width: k}, ticks: {stroke: line, width: k, size: 5 * k}, border: {show: false}, space: (side === 2 ? 56 : 32) * k,
      size: side === 2 ? 34 * k : (u, values, at, cycle) => (o.equal ? 42 * k : cycle > 1 ? u.axes[at]._size : Math.max(24, 13 + 7 * Math.max(1, ...(values || [""]).map((v) => String(v).length))) * k),
      values: (u, ticks) => ticks.map(write),
    });
    const axes = [axis("x", o.x, 2, true), axis("y", o.y, 3, true)];
    if (o.xTicks) Object.assign(axes[0], {splits: () => o.xTicks.map((_, i) => i), values: () => this.shortened(o.xTicks)});
    if (o.yLog) axes[1].splits = (u, at, low, high) => {   // powers of ten; within one of them 2 and 5, too
      const list = [];
      for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); ++e) for (const f of high / low < 100 ? [1, 2, 5] : [1]) if (f * 10 ** e >= low && f * 10 ** e <= high) list.push(f * 10 ** e);
      return list;
    };
    const scales = {x: {time: false, range: (u, from, to) => (from === null ? this.ranges[0] : [from, to])}, y: {range: () => this.ranges[1], distr: o.yLog ? 3 : 1}};
    const dummies = [{}, {show: true, scale: "y", points: {show: false}, paths: () => null}];
    const data = [[x[0], x[1]], [null, null]];
    if (right.length) {
      axes.push({...axis("right", o.right, 1, false), ...(o.whole ? {incrs: [1, 2, 5].flatMap((f) => [0, 1, 2, 3, 4, 5, 6, 7, 8].map((e) => f * 10 ** e)).sort((a, b) => a - b)} : {})});
      scales.right = {range: () => this.rightRange};
      dummies.push({show: true, scale: "right", points: {show: false}, paths: () => null});
      data.push([null, null]);
    }
    this.drawn = [this.width(), this.height()];
    this.zoomed = false;
    this.whole.hidden = true;
    this.at.textContent = "";
    const free = !o.equal && !printing;
    this.plot = new uPlot({
      width: this.drawn[0] * k, height: this.drawn[1] * k, scales, axes, series: dummies, legend: {show: false}, padding: [8 * k, right.length ? 0 : 22 * k, 0, 0],
      cursor: {drag: {x: free && !o.xTicks, y: free, setScale: free, uni: 24, dist: 6}, points: {show: false}, x: true, y: true,
        bind: {dblclick: () => () => { this.rebuild(); }}},
      hooks: {draw: [(u) => this.draw(u)], setCursor: [(u) => this.hover(u)], setSelect: [(u) => { if (u.select.width > 0 || u.select.height > 0) { this.zoomed = true; this.whole.hidden = false; } }]},
    }, data, this.host);
    if (k !== 1) this.plot.root.style.zoom = String(1 / k);
    this.plot.over.append(this.tip);
    this.plot.over.addEventListener("mouseleave", () => { this.tip.style.display = "none"; this.at.textContent = ""; });
    this.writeLegend();
  }

  writeLegend() {
    const keys = this.series.filter((s) => !s.quiet && s.key !== false);
    this.legend.replaceChildren(...keys.map((s) => {
      const color = this.color(s);
      const key = s.bar ? h("b", {class: "square", style: "background:" + color}) : s.mark && !s.width ? h("b", {class: s.mark, style: (s.mark === "ring" ? "border-color:" : "background:") + color})
        : h("b", {class: s.dash ? "dash" : s.glow ? "glow" : "", style: "border-color:" + color});
      return h("button", {type: "button", "aria-pressed": String(!this.hidden.has(s.label)), title: "Show or hide", onclick: (e) => {
        if (!this.hidden.delete(s.label)) this.hidden.add(s.label);
        this.rebuild();
        const again = [...this.legend.children].find((b) => b.textContent === s.label);
        if (again && e.detail === 0) again.focus();   // by keyboard
      }}, key, s.label);
    }));
  }

  /** Words as long as there is room for beside each other. */
  shortened(words) {
    const room = Math.max(3, Math.floor((this.width() - 64) / words.length / 6.6));
    return words.map((word) => (word.length > room ? word.slice(0, room - 1) + "\u2026" : word));
  }

  draw(u) {
    const ctx = u.ctx, dpr = devicePixelRatio * this.fine, slack = this.zoomed ? 0 : 6 * dpr;
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left - slack, u.bbox.top - slack, u.bbox.width + 2 * slack, u.bbox.height + 2 * slack);
    ctx.clip();
    ctx.strokeStyle = theme.get("soft");   // the zero lines
    ctx.lineWidth = dpr;
    ctx.beginPath();
    for (const [scale, vertical] of [["x", true], ["y", false]]) {
      if ((vertical && this.options.xTicks) || (!vertical && this.options.yLog)) continue;
      const at = u.valToPos(0, scale, true);
      if (vertical) { ctx.moveTo(at, u.bbox.top); ctx.lineTo(at, u.bbox.top + u.bbox.height); }
      else { ctx.moveTo(u.bbox.left, at); ctx.lineTo(u.bbox.left + u.bbox.width, at); }
    }
    ctx.stroke();
    if (this.options.yLog) { ctx.beginPath(); ctx.moveTo(u.bbox.left, u.bbox.top + u.bbox.height); ctx.lineTo(u.bbox.left + u.bbox.width, u.bbox.top + u.bbox.height); ctx.stroke(); }
    const notes = [];
    for (const s of this.visible()) {
      const scale = s.right ? "right" : "y", color = this.color(s);
      if (s.bar) {
        ctx.fillStyle = color;
        ctx.globalAlpha = 0.75;
        const floor = u.bbox.top + u.bbox.height;
        for (let i = 0; i < s.x.length; ++i) {
          const base = s.base ? s.base[i] : 0;
          if (!(s.y[i] > base)) continue;
          const from = u.valToPos(s.x[i], "x", true), to = u.valToPos(s.x[i] + s.bar, "x", true), top = u.valToPos(s.y[i], scale, true), foot = this.options.yLog ? floor : u.valToPos(base, scale, true);
          ctx.fillRect(from, top, Math.max(dpr, to - from - dpr), foot - top);
        }
        ctx.globalAlpha = 1;
      }
      if (s.width) {
        ctx.beginPath();
        let pen = false, before = 0;
        for (let i = 0; i < s.x.length; ++i) {
          if (s.x[i] === null || s.y[i] === null) { pen = false; continue; }
          const px = u.valToPos(s.x[i], "x", true), py = u.valToPos(s.y[i], scale, true);
          if (!pen) ctx.moveTo(px, py);
          else {
            if (s.step) ctx.lineTo(px, before);
            ctx.lineTo(px, py);
          }
          before = py;
          pen = true;
        }
        ctx.setLineDash(s.dash ? [6 * dpr, 4 * dpr] : []);
        ctx.strokeStyle = color;
        ctx.lineWidth = s.width * dpr;
        ctx.lineJoin = "round";
        ctx.globalAlpha = s.glow ? 0.35 : 1;
        ctx.stroke();
        ctx.globalAlpha = 1;
        ctx.setLineDash([]);
      }
      if (s.low) {
        ctx.beginPath();
        for (let i = 0; i < s.x.length; ++i) {
          if (s.low[i] === null || s.high[i] === null || s.low[i] === undefined) continue;
          const px = u.valToPos(s.x[i], "x", true), from = u.valToPos(s.low[i], scale, true), to = u.valToPos(s.high[i], scale, true), cap = 3.5 * dpr;
          ctx.moveTo(px, from); ctx.lineTo(px, to);
          for (const end of [from, to]) { ctx.moveTo(px - cap, end); ctx.lineTo(px + cap, end); }
        }
        ctx.strokeStyle = color;
        ctx.lineWidth = 1.4 * dpr;
        ctx.stroke();
      }
      if (s.mark) {
        for (let i = 0; i < s.x.length; ++i) {
          if (s.x[i] === null || s.y[i] === null) continue;
          drawMark(ctx, s.mark, u.valToPos(s.x[i], "x", true), u.valToPos(s.y[i], scale, true), (s.size || 4) * dpr, color, dpr);
        }
      }
      if (s.note && s.x.length) notes.push([s, u.valToPos(s.x[0], "x", true), u.valToPos(s.y[0], scale, true), color]);
    }
    this.drawNotes(ctx, u.bbox, notes, dpr);
    ctx.restore();
  }

  /** Words beside lines: inside the chart, and none over another. */
  drawNotes(ctx, box, notes, dpr) {
    ctx.font = Math.round(12 * dpr) + "px system-ui, sans-serif";
    ctx.textBaseline = "alphabetic";
    ctx.textAlign = "left";
    const taken = [], height = 14 * dpr;
    for (const [s, x, y, color] of notes) {
      const width = ctx.measureText(s.note).width;
      const left = Math.max(box.left + 2 * dpr, Math.min(s.noteSide === "right" ? x - width - 4 * dpr : x + 4 * dpr, box.left + box.width - width - 2 * dpr));
      const clear = (at) => at - height >= box.top && at <= box.top + box.height && !taken.some((t) => left < t[0] + t[2] && t[0] < left + width && Math.abs(at - t[1]) < height);
      const at = [y - 4 * dpr, y + 13 * dpr, y - 18 * dpr, y + 27 * dpr, y - 32 * dpr].find(clear);
      if (at === undefined) continue;
      taken.push([left, at, width]);
      ctx.fillStyle = theme.get("halo");
      ctx.fillRect(left - dpr, at - 11 * dpr, width + 2 * dpr, height);
      ctx.fillStyle = color;
      ctx.fillText(s.note, left, at);
    }
  }

  hover(u) {
    const {left, top} = u.cursor, o = this.options;
    let best = null, nearest = 26 * 26;
    if (left >= 0) {
      for (const s of this.visible()) {
        if (s.quiet) continue;
        for (let i = 0; i < s.x.length; ++i) {
          if (s.x[i] === null || s.y[i] === null) continue;
          const dx = u.valToPos(s.x[i] + (s.bar || 0) / 2, "x") - left, dy = u.valToPos(s.y[i], s.right ? "right" : "y") - top;
          if (dx * dx + dy * dy < nearest) { nearest = dx * dx + dy * dy; best = [s, i]; }
        }
      }
      const short = (label) => (label || "").replace(/\s*\([^()]*\)\s*$/, "").split(/[,:]/)[0];
      const readings = o.xTicks ? [] : [short(o.x) + " " + withUnit(u.posToVal(left, "x"), o.x)];
      readings.push(short(o.y) + " " + withUnit(u.posToVal(top, "y"), o.y));
      if (u.scales.right) readings.push(short(o.right) + " " + withUnit(u.posToVal(top, "right"), o.right));
      this.at.textContent = readings.join("  \u00b7  ");
    } else this.at.textContent = "";
    this.tip.style.display = best ? "block" : "none";
    if (!best) return;
    const [s, i] = best;
    const at = o.xTicks ? o.xTicks[Math.round(s.x[i])] : s.bar ? show(s.x[i], 4) + " to " + withUnit(s.x[i] + s.bar, o.x) : withUnit(s.x[i], o.x);
    const interval = s.low && s.low[i] !== null ? "  (" + show(s.low[i], 4) + " to " + show(s.high[i], 4) + ")" : "";
    this.tip.textContent = s.label + "\n" + at + "  |  " + withUnit(s.y[i] - (s.base ? s.base[i] : 0), s.right ? o.right : o.y) + interval;
    const px = u.valToPos(s.x[i], "x"), py = u.valToPos(s.y[i], s.right ? "right" : "y");
    this.tip.style.top = Math.max(0, py - 44) + "px";
    this.tip.style.left = Math.max(0, Math.min(px + 10, u.over.clientWidth - this.tip.offsetWidth)) + "px";
  }

  /** The chart with its title and legend as a picture, as fine as the screen. */
  savePicture() {
    const source = this.plot.ctx.canvas, dpr = devicePixelRatio, keys = this.visible().filter((s) => !s.quiet && s.key !== false);
    const canvas = h("canvas", {}), ctx = canvas.getContext("2d"), small = Math.round(12 * dpr) + "px system-ui, sans-serif", pad = 12 * dpr, rows = [[]];
    ctx.font = small;
    let x = pad;
    for (const s of keys) {
      const width = ctx.measureText(s.label).width + 34 * dpr;
      if (x + width > source.width && rows[rows.length - 1].length) { rows.push([]); x = pad; }
      rows[rows.length - 1].push([s, x]);
      x += width;
    }
    const head = (30 + 18 * rows.length) * dpr;
    canvas.width = source.width + 2 * pad;
    canvas.height = source.height + head + pad;
    ctx.fillStyle = theme.get("card");
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.fillStyle = theme.get("ink");
    ctx.font = "600 " + Math.round(14 * dpr) + "px system-ui, sans-serif";
    ctx.fillText(this.title(), pad, 20 * dpr);
    ctx.font = small;
    rows.forEach((row, n) => row.forEach(([s, at]) => {
      const y = (38 + 18 * n) * dpr;
      ctx.fillStyle = ctx.strokeStyle = this.color(s);
      if (s.mark && !s.width) drawMark(ctx, s.mark, at + 9 * dpr, y - 4 * dpr, 4 * dpr, this.color(s), dpr);
      else { ctx.lineWidth = (s.bar ? 8 : 2) * dpr; ctx.setLineDash(s.dash ? [4 * dpr, 3 * dpr] : []); ctx.beginPath(); ctx.moveTo(at, y - 4 * dpr); ctx.lineTo(at + 18 * dpr, y - 4 * dpr); ctx.stroke(); ctx.setLineDash([]); }
      ctx.fillStyle = theme.get("soft");
      ctx.fillText(s.label, at + 23 * dpr, y);
    }));
    ctx.drawImage(source, pad, head);
    canvas.toBlob((blob) => saveAs(blob, fileName(this.title(), ".png")));
  }

  /** What is shown as a table: two columns a series. */
  saveTable() {
    const shown = this.visible().filter((s) => s.key !== false || !s.quiet), o = this.options, columns = [];
    for (const s of shown) {
      columns.push([s.label + ": " + (o.x || "x"), o.xTicks ? s.x.map((v) => o.xTicks[Math.round(v)]) : s.bar ? s.x.map((v) => Number(v.toPrecision(6))) : s.x], [s.label + ": " + (s.right ? o.right : o.y), s.y.map((v, i) => (s.base && v !== null ? v - s.base[i] : v))]);
      if (s.low) columns.push([s.label + ": from", s.low], [s.label + ": to", s.high]);
    }
    const rows = Math.max(0, ...columns.map(([, values]) => values.length)), lines = [columns.map(([name]) => csvCell(name)).join(",")];
    for (let r = 0; r < rows; ++r) lines.push(columns.map(([, values]) => (values[r] === null || values[r] === undefined ? "" : csvCell(String(values[r])))).join(","));
    saveAs(new Blob(["\ufeff" + lines.join("\n") + "\n"], {type: "text/csv"}), fileName(this.title(), ".csv"));
  }
}
