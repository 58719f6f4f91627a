// Line charts with free x (a strain may turn back): uPlot gives axes, grid and size, the curves are drawn over them.
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
function drawMark(ctx, mark, x, y, size, color) {
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
    ctx.strokeStyle = color; ctx.lineWidth = 2 * devicePixelRatio; ctx.fillStyle = theme.get("card"); ctx.fill(); ctx.stroke();
  } else {
    ctx.fillStyle = color; ctx.fill();
  }
}

/**
 * A chart in `host`. series: [{label, x, y, color (a theme name or a colour), width, dash, mark, size, right, quiet, note}];
 * `right` uses the right axis, `quiet` keeps a series out of the legend and the tooltip,
 * `key: false` out of the legend only. `low` and `high` draw a bar through each point: its interval, which the tooltip names.
 * options: {x, y, right (labels), height, xRange, yRange, xTicks: words at x = 0, 1, ..., equal: one scale for both axes}.
 */
class XYChart {
  constructor(host, options) {
    this.host = h("div", {class: "chart", style: "min-height:" + (options.height || 300) + "px"});
    this.tip = h("div", {class: "tip"});
    this.legend = h("div", {class: "legend"});
    host.append(this.legend, this.host);
    this.options = options;
    this.set(options.series);
    charts.add(this);
    new ResizeObserver(() => {
      if (this.plot && (this.width() !== this.plot.width || this.height() !== this.plot.height)) this.plot.setSize({width: this.width(), height: this.height()});
    }).observe(this.host);
  }

  height() {
    const least = this.options.height || 300;
    if (this.options.equal && this.ranges) {   // 64 and 72 pixels are the axes'
      const [x, y] = this.ranges;
      return Math.round(Math.max(160, Math.min(760, ((this.width() - 64) * (y[1] - y[0])) / (x[1] - x[0]) + 72)));
    }
    return Math.max(least, Math.floor(this.host.clientHeight));
  }
  width() { return Math.max(220, Math.floor(this.host.clientWidth)); }
  color(series) { return /^[a-z]+$/.test(series.color) ? theme.get(series.color) : series.color; }

  set(series) {
    this.series = series.filter((s) => s.x.length > 0);
    this.rebuild();
  }

  rebuild() {
    if (this.plot) this.plot.destroy();
    const left = this.series.filter((s) => !s.right), right = this.series.filter((s) => s.right);
    const o = this.options;
    const x = o.xRange || padded(extent(this.series.map((s) => s.x)));
    const y = o.yRange || padded(extent(left.flatMap((s) => [s.y, s.low || [], s.high || []])));
    this.ranges = [x, y];
    if (o.equal) this.host.style.height = this.height() + "px";
    const r = padded(extent(right.map((s) => s.y)));
    const ink = theme.get("soft"), line = theme.get("line");
    // uPlot scales whole pixels only: "12.5px" would stay small on a dense screen
    const axis = (scale, label, side, grid) => ({
      scale, side, label, stroke: ink, font: "12px system-ui, sans-serif", labelFont: "13px system-ui, sans-serif", labelGap: side === 2 ? 2 : 4,
      labelSize: 22, size: side === 2 ? 34 : 52, gap: 4, grid: {show: grid, stroke: line, width: 1}, ticks: {stroke: line, width: 1, size: 5},
      values: (u, ticks) => ticks.map((t) => (t === null ? "" : String(Number(t.toPrecision(6))).replace("-", "\u2212"))),
    });
    const axes = [axis("x", o.x, 2, true), axis("y", o.y, 3, true)];
    if (o.xTicks) Object.assign(axes[0], {splits: () => o.xTicks.map((_, i) => i), values: () => this.shortened(o.xTicks)});
    const scales = {x: {time: false, range: () => x}, y: {range: () => y}};
    const dummies = [{}, {show: true, scale: "y", points: {show: false}, paths: () => null}];
    const data = [[x[0], x[1]], [null, null]];
    if (right.length) {
      axes.push(axis("right", o.right, 1, false));
      scales.right = {range: () => r};
      dummies.push({show: true, scale: "right", points: {show: false}, paths: () => null});
      data.push([null, null]);
    }
    this.plot = new uPlot({
      width: this.width(), height: this.height(), scales, axes, series: dummies, legend: {show: false}, padding: [8, right.length ? 0 : 12, 0, 0],
      cursor: {drag: {x: false, y: false, setScale: false}, points: {show: false}, x: false, y: false},
      hooks: {draw: [(u) => this.draw(u)], setCursor: [(u) => this.hover(u)]},
    }, data, this.host);
    this.plot.over.append(this.tip);
    this.plot.over.addEventListener("mouseleave", () => { this.tip.style.display = "none"; });
    this.legend.replaceChildren(...this.series.filter((s) => !s.quiet && s.key !== false).map((s) => {
      const color = this.color(s);
      const key = s.mark && !s.width ? h("b", {class: s.mark, style: (s.mark === "ring" ? "border-color:" : "background:") + color})
        : h("b", {class: s.dash ? "dash" : "", style: "border-color:" + color});
      return h("span", {}, key, s.label);
    }));
  }

  /** Words as long as there is room for beside each other. */
  shortened(words) {
    const room = Math.max(3, Math.floor((this.width() - 64) / words.length / 6.6));
    return words.map((word) => (word.length > room ? word.slice(0, room - 1) + "\u2026" : word));
  }

  draw(u) {
    const ctx = u.ctx, dpr = devicePixelRatio;
    ctx.save();
    ctx.strokeStyle = theme.get("soft");   // the zero lines
    ctx.lineWidth = dpr;
    ctx.beginPath();
    for (const [scale, vertical] of this.options.xTicks ? [["y", false]] : [["x", true], ["y", false]]) {
      const at = u.valToPos(0, scale, true);
      if (vertical) { ctx.moveTo(at, u.bbox.top); ctx.lineTo(at, u.bbox.top + u.bbox.height); }
      else { ctx.moveTo(u.bbox.left, at); ctx.lineTo(u.bbox.left + u.bbox.width, at); }
    }
    ctx.stroke();
    ctx.beginPath();
    ctx.rect(u.bbox.left - 6 * dpr, u.bbox.top - 6 * dpr, u.bbox.width + 12 * dpr, u.bbox.height + 12 * dpr);
    ctx.clip();
    for (const s of this.series) {
      const scale = s.right ? "right" : "y", color = this.color(s);
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
        ctx.stroke();
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
          drawMark(ctx, s.mark, u.valToPos(s.x[i], "x", true), u.valToPos(s.y[i], scale, true), (s.size || 4) * dpr, color);
        }
      }
      if (s.note && s.x.length) {
        ctx.font = 11.5 * dpr + "px system-ui, sans-serif";
        ctx.fillStyle = color;
        ctx.textBaseline = "alphabetic";
        ctx.textAlign = s.noteSide || "left";
        ctx.fillText(s.note, u.valToPos(s.x[0], "x", true) + (s.noteSide === "right" ? -4 : 4) * dpr, u.valToPos(s.y[0], scale, true) - 4 * dpr);
      }
    }
    ctx.restore();
  }

  hover(u) {
    const {left, top} = u.cursor;
    let best = null, nearest = 26 * 26;
    if (left >= 0) {
      for (const s of this.series) {
        if (s.quiet) continue;
        for (let i = 0; i < s.x.length; ++i) {
          if (s.x[i] === null || s.y[i] === null) continue;
          const dx = u.valToPos(s.x[i], "x") - left, dy = u.valToPos(s.y[i], s.right ? "right" : "y") - top;
          if (dx * dx + dy * dy < nearest) { nearest = dx * dx + dy * dy; best = [s, i]; }
        }
      }
    }
    this.tip.style.display = best ? "block" : "none";
    if (!best) return;
    const [s, i] = best;
    const at = this.options.xTicks ? this.options.xTicks[Math.round(s.x[i])] : show(s.x[i], 4);
    const interval = s.low && s.low[i] !== null ? "  (" + show(s.low[i], 4) + " to " + show(s.high[i], 4) + ")" : "";
    this.tip.textContent = s.label + "\n" + at + "  |  " + show(s.y[i], 4) + interval;
    const px = u.valToPos(s.x[i], "x"), py = u.valToPos(s.y[i], s.right ? "right" : "y");
    this.tip.style.top = Math.max(0, py - 44) + "px";
    this.tip.style.left = Math.max(0, Math.min(px + 10, u.over.clientWidth - this.tip.offsetWidth)) + "px";
  }
}
