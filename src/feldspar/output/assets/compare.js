// The variants of a job side by side: properties, curves with the growth of damage, failure patterns, envelopes, cost.
"use strict";

const mainProperties = ["E_GPa", "nu", "UCS_MPa", "DTS_MPa", "BTS_MPa", "cohesion_MPa", "friction_angle_deg", "hoek_brown_mi", "UCS_over_BTS", "UCS_over_DTS", "BTS_over_DTS"];
const variantMarks = ["dot", "ring", "diamond", "square"];

function variantColor(i) { return "v" + "abcdefghij"[i % 10]; }
function swatch(i) { return h("b", {class: "swatch", style: "background:var(--" + variantColor(i) + ")"}); }
function variantIndex(test) { return data.variants.findIndex((v) => v.name === test.variant); }
function modelWords(v) {
  return [v.grains.replace("-", " ") + (v.grains === "flexible" ? " grains, E " + show(v.E) + " GPa" : v.grains === "rigid" ? " grains" : ""),
    v.contact === "lobatto3" ? "three-point contacts" : "one-point contacts", v.normal === "edge" ? "normal of the edge" : null, v.law + " law"].filter(Boolean).join(" \u00b7 ");
}

function writeComparedProperties() {
  const rowsOf = data.variants.map((v) => new Map(v.properties.map((p) => [p.name, p])));
  const found = (name) => rowsOf.map((rows) => rows.get(name)).find(Boolean);
  const names = mainProperties.filter(found);
  page.append(h("h3", {}, "Properties"));
  if (!names.length) { page.append(h("p", {class: "soft"}, "No property could be read yet.")); return; }
  const compared = names.some((name) => name in data.laboratory);
  page.append(h("p", {class: "soft"}, "Median over the packings, with the range below it." + (compared ? " Last row: the laboratory." : "")));
  const unit = (name) => found(name).unit.replace("deg", "\u00b0");
  const head = [th("Variant"), ...names.map((name) => th([found(name).symbol, unit(name) ? h("br") : null, unit(name) ? h("span", {class: "unit"}, unit(name)) : null], true, found(name).label))];
  const rows = data.variants.map((v, i) => h("tr", {}, h("td", {}, swatch(i), v.name, h("div", {class: "soft tiny"}, modelWords(v))),
    names.map((name) => {
      const p = rowsOf[i].get(name);
      if (!p) return td("\u2013", true);
      return h("td", {class: "number"}, h("span", {class: "strong"}, show(p.median)), p.packings > 1 ? h("div", {class: "soft tiny"}, show(p.minimum) + " \u2013 " + show(p.maximum)) : null);
    })));
  if (compared) rows.push(h("tr", {class: "laboratory"}, td("Laboratory"), names.map((name) => td(name in data.laboratory ? show(data.laboratory[name]) : "", true))));
  page.append(table("variants", head, rows));
  writeAllProperties(rowsOf);
}

/** Every property of every variant, for those who look for one: folded away. */
function writeAllProperties(rowsOf) {
  const all = new Map();
  for (const v of data.variants) for (const p of v.properties) if (!all.has(p.name)) all.set(p.name, p);
  page.append(h("details", {}, h("summary", {}, "All properties"), table("evidence", [th("Property"), th("Unit"), ...data.variants.map((v) => th(v.name, true))],
    [...all.values()].map((p) => h("tr", {}, td(p.label), td(p.unit.replace("deg", "\u00b0")), rowsOf.map((rows) => {
      const own = rows.get(p.name);
      return td(own ? show(own.median) + (own.packings > 1 ? " (" + show(own.minimum) + " \u2013 " + show(own.maximum) + ")" : "") : "\u2013", true);
    }))))));
}

/** The row of the peak: where the stress is as large as the strength that was read. */
function peakRow(test) {
  const stress = test.history.stress;
  let at = -1;
  for (let i = 0; i < stress.length; ++i) {
    if (stress[i] === null) continue;
    if (at < 0 || Math.abs(stress[i]) > Math.abs(stress[at])) at = i;
    if (test.peak !== null && Math.abs(stress[at]) >= 0.99999 * test.peak) break;
  }
  return at;
}

function comparedSeries(tests, options) {
  const series = [];
  for (const t of tests) {
    const i = variantIndex(t), x = t.history[options.x], color = variantColor(i), peak = peakRow(t);
    if (options.damage) series.push({label: t.variant + ", broken contact area", x, y: t.history.broken, color, width: 1.3, dash: true, right: true, key: false});
    series.push({label: t.variant, x, y: t.history.stress, color, width: 2, key: false});
    if (peak >= 0) series.push({label: t.variant + ", peak", x: [x[peak]], y: [t.history.stress[peak]], color, mark: variantMarks[i % 4], size: 4, key: false});
  }
  return series;
}

/** Buttons for several things at once; onChange gets the set of those that are pressed. */
function chips(names, onChange) {
  const on = new Set(names.map((_, i) => i));
  const buttons = names.map((name, i) => h("button", {type: "button", "aria-pressed": "true", onclick: () => {
    if (on.has(i)) on.delete(i); else on.add(i);
    buttons[i].setAttribute("aria-pressed", String(on.has(i)));
    onChange(on);
  }}, swatch(i), name));
  return h("div", {class: "chips"}, buttons);
}

function writeComparedCurves() {
  const kinds = new Map();
  for (const t of data.tests) {
    if (!kinds.has(titleOf(t))) kinds.set(titleOf(t), []);
    kinds.get(titleOf(t)).push(t);
  }
  page.append(h("h3", {}, "Curves and failure patterns"), h("p", {class: "soft"},
    "Solid: stress. Dashed, right axis: damage, the share of the contact area between the grains that is broken. A mark stands at each peak. Press a name to leave a variant out."));
  if (!kinds.size) { page.append(h("p", {class: "soft"}, "No test has ended yet.")); return; }
  const state = {kind: [...kinds.keys()][0], seed: null, x: "strain", damage: true, shown: new Set(data.variants.map((_, i) => i)), moment: "end"};
  const seedBox = h("div", {}), curves = card("Stress and damage"), patterns = h("div", {class: "patterns"});
  const chosen = () => kinds.get(state.kind).filter((t) => t.seed === state.seed && state.shown.has(variantIndex(t))).sort((a, b) => variantIndex(a) - variantIndex(b));
  let chart = null;
  const update = () => {
    const own = kinds.get(state.kind);
    if (!own.some((t) => t.seed === state.seed)) state.seed = own[0].seed;
    const brazilian = Boolean(own[0].brazilian);
    const labels = {x: state.x === "strain" ? strainLabelOf(own[0]) : (brazilian ? "Approach of the plates (mm)" : "Platen displacement (mm)"),
      y: stressLabelOf(own[0]), right: "Broken contact area (%)", height: 420};
    const series = comparedSeries(chosen(), state);
    if (!chart) chart = new XYChart(curves, {...labels, series});
    else { Object.assign(chart.options, labels); chart.set(series); }
    drawPatterns(patterns, chosen(), state.moment);
  };
  const chooseKind = (kind) => {
    state.kind = kind;
    const seeds = [...new Set(kinds.get(kind).map((t) => t.seed))];
    state.seed = seeds.includes(packing.seed) ? packing.seed : seeds[0];   // not every test runs on every packing
    seedBox.replaceChildren(state.seed === packing.seed ? "" : h("p", {class: "soft small"}, "Not run on packing " + packing.seed + ": packing " + state.seed + " is shown."));
    update();
  };
  const names = [...kinds.keys()];
  page.append(picker("Test", names, 0, (i) => chooseKind(names[i])) || h("p", {class: "small"}, names[0]), seedBox);
  curves.append(chips(data.variants.map((v) => v.name), (on) => { state.shown = on; update(); }));
  page.append(h("div", {class: "pick"}, picker("Horizontal axis", ["strain", "displacement"], 0, (i) => { state.x = i ? "displacement" : "strain"; update(); }),
    picker("Damage", ["shown", "hidden"], 0, (i) => { state.damage = i === 0; update(); })), curves);
  page.append(h("div", {class: "pick"}, picker("Failure patterns", ["at the end", "at the peak"], 0, (i) => { state.moment = i ? "peak" : "end"; update(); }),
    h("div", {class: "legend"}, h("span", {}, h("b", {style: "border-color:var(--tensile)"}), "tensile crack"), h("span", {}, h("b", {style: "border-color:var(--shear)"}), "shear crack"), h("span", {}, "undeformed"))), patterns);
  packing.follow(() => chooseKind(state.kind));
  redraw.push(update);
  let width = patterns.clientWidth;
  new ResizeObserver(() => {   // the height follows from the drawings themselves
    if (patterns.clientWidth === width) return;
    width = patterns.clientWidth;
    drawPatterns(patterns, chosen(), state.moment);
  }).observe(patterns);
}

const patternCache = [];

/** The grains and the cracks of a test: [meta, parts, number among the tests of its packing], or null. */
async function patternOf(test) {
  for (let p = 0; p < data.patterns.length; ++p) {
    const k = data.patterns[p].tests.findIndex((entry) => entry.test === test.index);
    if (k < 0) continue;
    patternCache[p] ||= readFields(data.patterns[p], document.getElementById("pattern-" + p));
    return [data.patterns[p], await patternCache[p], k];
  }
  return null;
}

async function drawPatterns(host, tests, moment) {
  if (typeof DecompressionStream === "undefined") { host.replaceChildren(h("p", {}, "These drawings need a browser of 2023 or later.")); return; }
  const found = await Promise.all(tests.map(patternOf));
  const cards = tests.map((t, n) => {
    if (!found[n]) return null;
    const [meta, parts, k] = found[n], mode = parts["mode" + k], every = meta.tests[k].crack_every || 1, count = moment === "peak" ? Math.min(Math.ceil(meta.tests[k].at_peak / every), mode.length) : mode.length;
    let shear = 0;
    for (let c = 0; c < count; ++c) shear += mode[c];
    const canvas = h("canvas", {role: "img", "aria-label": "Failure pattern of " + t.variant});
    return {canvas, draw: () => paintPattern(canvas, meta, parts, k, count),
      element: h("figure", {}, h("figcaption", {}, swatch(variantIndex(t)), t.variant), canvas, h("div", {class: "soft tiny"}, show(t.peak) + " MPa \u00b7 " + (every > 1 ? "about " : "") + every * (count - shear) + " tensile, " + every * shear + " shear"))};
  }).filter(Boolean);
  host.style.setProperty("--columns", cards.length > 5 ? Math.min(6, Math.ceil(cards.length / 2)) : Math.max(2, cards.length));
  host.replaceChildren(...cards.map((c) => c.element));
  for (const c of cards) c.draw();
}

function paintPattern(canvas, meta, parts, k, count) {
  const {points, begin} = parts, ends = parts["ends" + k], mode = parts["mode" + k];
  let width = 1, height = 1;
  for (let i = 0; i < points.length; i += 2) { width = Math.max(width, points[i]); height = Math.max(height, points[i + 1]); }
  const dpr = printing ? 3 : Math.min(devicePixelRatio, 2), css = Math.max(80, canvas.parentElement.clientWidth), scale = ((css - 4) * dpr) / width;
  canvas.width = Math.round(css * dpr);
  canvas.height = Math.round(height * scale + 4 * dpr);
  canvas.style.height = canvas.height / dpr + "px";
  const ctx = canvas.getContext("2d"), x = (v) => 2 * dpr + v * scale, y = (v) => canvas.height - 2 * dpr - v * scale;
  const at = (from, i) => [x(from[2 * i]), y(from[2 * i + 1])];
  const cracks = Array.from({length: count}, (_, c) => ({mode: mode[c], from: at(ends, 2 * c), to: at(ends, 2 * c + 1)}));
  drawCracked(ctx, begin, (i) => at(points, i), cracks, 0.4 * dpr, Math.min(2.6, Math.max(1.3, css / 130)) * dpr);
}

function writeComparedEnvelopes() {
  if (!data.variants.some((v) => v.envelope.fits.length)) return;
  page.append(h("h3", {}, "Strength envelopes"), h("p", {class: "soft"}, "Each test as a mark; the Mohr-Coulomb line of each variant with the medians of its packings."));
  const reach = Math.max(...data.tests.filter((t) => methodOf(t.kind).on_envelope && methodOf(t.kind).confined).map((t) => t.sigma3)) * 1.1, series = [];
  data.variants.forEach((v, i) => {
    const fits = v.envelope.fits, own = data.tests.filter((t) => t.variant === v.name && methodOf(t.kind).on_envelope && t.peak !== null);
    const c = median(fits.map((f) => f.cohesion)), phi = median(fits.map((f) => f.friction_angle));
    if (c !== null && phi !== null) {
      const s = Math.sin((phi * Math.PI) / 180), n = (1 + s) / (1 - s), ucs = 2 * c * Math.sqrt(n);
      series.push({label: v.name, x: [0, reach], y: [ucs, ucs + n * reach], color: variantColor(i), width: 1.8});
    }
    series.push({label: v.name + ", tests", x: own.map((t) => t.sigma3), y: own.map((t) => t.peak), color: variantColor(i), mark: variantMarks[i % 4], size: 3.5, key: false});
  });
  const chart = card("Strength of each test");
  page.append(chart);
  new XYChart(chart, {x: "Minor principal stress \u03c3\u2083 (MPa, compression positive)", y: "Major principal stress \u03c3\u2081 (MPa)", height: 380, series});
  const fitted = data.variants.filter((v) => v.envelope.fits.length), box = h("div", {style: "margin-top:18px"}), testsOf = (v) => data.tests.filter((t) => t.variant === v.name);
  page.append(chooser("Mohr circles of", fitted.map((v) => v.name), (i) => { circles.set(mohrSeries(testsOf(fitted[i]), fitted[i].envelope.fits)); }) || "", box);
  const circles = writeMohr(box, testsOf(fitted[0]), fitted[0].envelope.fits);
}

function writeCost() {
  const kinds = Object.keys(kindNames).filter((kind) => data.variants.some((v) => kind in v.ms_per_step));
  if (!kinds.length) return;
  const threads = data.provenance.threads, first = data.variants[0];
  page.append(h("h3", {}, "Time of a step"), h("p", {class: "soft"}, "Milliseconds a step with " + plural(threads, "thread") + ", median over the tests of a kind; in brackets as a multiple of " + first.name + "."),
    table("variants", [th("Variant"), ...kinds.map((kind) => th(kindNames[kind], true))], data.variants.map((v, i) => h("tr", {}, h("td", {}, swatch(i), v.name),
      kinds.map((kind) => {
        const cost = v.ms_per_step[kind], base = first.ms_per_step[kind];
        if (cost === undefined) return td("\u2013", true);
        return h("td", {class: "number"}, h("span", {class: "strong"}, show(cost)), base ? h("span", {class: "soft"}, " (" + (cost / base).toFixed(2) + "\u00d7)") : null);
      })))));
}

function writeComparison() {
  page.append(h("h2", {}, "Comparison of the variants"),
    h("p", {class: "soft"}, "The same packings, modelled in " + plural(data.variants.length, "way") + "."));
  writeComparedProperties();
  writeComparedCurves();
  writeComparedEnvelopes();
  writeCost();
}
