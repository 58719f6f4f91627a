// The report's page: reads the data beside it and lays out tables, charts and the viewer.
"use strict";

const kindNames = Object.fromEntries(Object.entries(data.methods).map(([kind, method]) => [kind, method.title]));
data.tests.forEach((test, index) => { test.index = index; });

function titleOf(test) {
  return test.title + (test.pressure ? " at " + test.pressure + " = " + Number(test.sigma3.toPrecision(4)) + " MPa" : "");
}

/** The title with the variant before it, if the job has variants. */
function fullTitle(test) { return (test.variant ? test.variant + " \u00b7 " : "") + titleOf(test); }

/** Tests of one variant and kind (and sigma_3) over all packings. */
function groupTests() {
  const groups = new Map();
  const inOrder = data.variants ? data.variants.flatMap((v) => data.tests.filter((t) => t.variant === v.name)) : data.tests;
  inOrder.forEach((test) => {
    const key = fullTitle(test);
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(test);
  });
  return groups;
}

/** The packing that the whole page shows, and who draws again when the reader chooses another. */
const packing = {
  seeds: [...new Set(data.tests.map((t) => t.seed))].sort((a, b) => a - b), seed: null, followers: [],
  /** draw(seed) is called now and whenever another packing is chosen. */
  follow(draw) { this.followers.push(draw); draw(this.seed); },
  choose(seed) { this.seed = seed; for (const draw of this.followers) draw(seed); },
};
// at first the one whose fields are here in most detail: that of the median strength
packing.seed = data.fields.length && data.fields[0].role ? data.tests[data.fields[0].test].seed : packing.seeds[0] ?? null;

/** A bar that stays in sight, where there are several packings. */
function writePackingBar() {
  if (packing.seeds.length < 2) return;
  const first = packing.seeds.indexOf(packing.seed), choose = packing.seeds.length <= 12 ? picker("Packing (seed)", packing.seeds.map(String), first, (i) => packing.choose(packing.seeds[i])) : chooser("Packing (seed)", packing.seeds.map((s) => "seed " + s), (i) => packing.choose(packing.seeds[i]));
  choose.classList.add("packing");
  const list = choose.querySelector("select");
  if (list) list.selectedIndex = first;
  page.append(choose);
}
/** Which of these tests are of the packing shown: its number among them, or 0 where it was not tested so. */
function testOfPacking(tests, seed) { return Math.max(0, tests.findIndex((t) => t.seed === seed)); }

function modelFacts(m) {
  if (data.variants) {
    const each = (key) => [...new Set(data.variants.map((v) => v[key]))].join(", ");
    return [plural(data.variants.length, "variant"), "grains: " + each("grains").replaceAll("-", " "), each("law") + " law", each("numerics") + " numerics"];
  }
  return [(m.grains === "inner-particles" ? "inner particles, " : m.grains + " grains, ") + (m.contact === "lobatto3" ? "three-point" : "one-point") + " contacts", m.law + " law",
    ...(m.grains === "flexible" ? ["plane " + m.plane] : []), m.numerics + " numerics"];
}

/** The tests that ended without a result, and why. */
function writeFailed() {
  if (!data.failed.length) return;
  page.append(h("section", {id: "failed"}, h("h2", {}, "These tests failed"),
    table("evidence", [th("Test"), th("Packing (seed)", true), th("Reason")],
      data.failed.map((f) => h("tr", {}, td(fullTitle(f), false, "kind"), td(String(f.seed), true), td(f.reason.replace(/\s*\n\s*/g, "; ")))))));
}

function writeHeader() {
  const m = data.model, seeds = new Set(data.tests.map((t) => t.seed));
  page.append(h("header", {},
    h("div", {class: "maker"}, "Feldspar \u00b7 laboratory report"),
    h("h1", {}, data.job.name),
    h("ul", {class: "facts"},
      h("li", {}, plural(data.tests.length, "test") + " on " + plural(seeds.size, "packing")),
      modelFacts(m).map((fact) => h("li", {}, fact)),
      h("li", {}, data.provenance.started.slice(0, 10)))));
  if (!data.complete) {
    page.append(h("p", {class: "notice"}, "This run is not complete: " +
      (data.failed.length ? plural(data.failed.length, "test") + " failed" : "it is still going, or it ended early") + ". The report holds the tests that were finished" +
      (data.tests.some((t) => t.interrupted) ? " and one that was interrupted." : ".")));
  }
  writeFailed();
  page.append(h("p", {class: "soft small", style: "margin-top:16px"}, "Signs: " + data.signs + "."));
}

/** Largest deviation from the median that the spread column shows, the same for every row. */
function spreadReach() {
  let reach = 0.02;
  for (const p of data.properties) {
    for (const v of [p.minimum, p.maximum, p.laboratory]) if (v !== null && p.median) reach = Math.max(reach, Math.abs(v / p.median - 1));
  }
  return Math.min(reach, 0.6);
}

/** The range of the packings as a bar, the median as a dot, the laboratory as a mark: all relative to the median. */
function rangeBar(row, reach) {
  if (row.minimum === null || row.maximum === null || !row.median) return "";
  const at = (v) => 50 + 46 * Math.max(-1, Math.min(1, (v / row.median - 1) / reach));
  const low = Math.min(at(row.minimum), at(row.maximum)), high = Math.max(at(row.minimum), at(row.maximum));
  return h("span", {class: "range", "aria-hidden": "true"},
    h("i", {class: "bar", style: "left:" + low + "%;width:" + (high - low) + "%"}),
    row.laboratory === null ? null : h("i", {class: "lab", style: "left:" + at(row.laboratory) + "%"}),
    h("i", {class: "dot", style: "left:50%"}));
}

/** Properties with median, scatter, grades of their tests, and the laboratory's number where there is one. */
function propertyTable(rows, reach) {
  const compared = rows.some((p) => p.laboratory !== null), graded = rows.some((p) => p.grades);
  const head = [th("Property"), th("", true), th("Median", true), th("Range", true), th("Packings", true, "how many packings define it")];
  if (graded) head.push(th("Grades", false, "of the tests that it is read from: A, the strength is shown to about 0.5 % (tension and Brazilian tests 1 %); B to about 2 %; C not shown"));
  if (compared) head.push(th("Laboratory", true), th("Difference", true));
  head.push(th("Spread" + (compared ? " and laboratory" : "")));
  return table("properties", head, rows.map((p) => {
    const cells = [td(p.label), td([p.symbol], true, "unit"),
      td([show(p.median), unitText(p.unit)], true, "strong"),
      td(p.packings < 2 ? "" : show(p.minimum) + " \u2013 " + show(p.maximum), true), td(String(p.packings), true)];
    if (graded) cells.push(td(p.grades ? gradesText(p.grades) : ""));
    if (compared) {
      const known = p.laboratory !== null && p.median !== null && p.laboratory !== 0;
      const off = known ? (100 * (p.median - p.laboratory)) / p.laboratory : null;
      cells.push(td(p.laboratory === null ? "" : show(p.laboratory), true),
        td(known ? (off > 0 ? "+" : "") + off.toFixed(Math.abs(off) < 9.95 ? 1 : 0).replace("-", "\u2212") + " %" : "", true));
    }
    cells.push(td(rangeBar(p, reach)));
    return h("tr", {}, cells);
  }));
}

function writeProperties() {
  page.append(h("h2", {}, "Properties of the rock"));
  if (!data.properties.length) { page.append(h("p", {class: "soft"}, data.complete ? "No test of this job defines a property of the rock, or none that does has reached its peak." : "No property could be read yet.")); return; }
  const compared = data.properties.some((p) => p.laboratory !== null);
  page.append(h("p", {class: "soft"}, "Median and range over the packings" + (compared ? ", beside the laboratory's number" : "") + "." +
    (data.model.grains === "flexible" ? " E and \u03bd hold for plane " + data.model.plane + "." : "")));
  const reach = spreadReach(), main = data.properties.filter((p) => p.main), further = data.properties.filter((p) => !p.main);
  if (main.length) page.append(propertyTable(main, reach));
  if (further.length && main.length) page.append(h("details", {}, h("summary", {}, plural(further.length, "further property").replace("propertys", "properties") + ": other definitions, ratios, crack initiation and damage"), propertyTable(further, reach)));
  else if (further.length) page.append(propertyTable(further, reach));
  page.append(h("p", {class: "soft small", style: "margin-top:8px"}, "Spread, relative to the median (full width \u00b1" + Math.round(100 * reach) + " %). Dot: median; grey bar: range over the packings" +
    (compared ? "; orange mark: laboratory." : ".") + " Grades tell how well the tests show their strength (see the evidence below)."));
}

/** The moments of a Brazilian test, as marks on its curve; each of the same shape and colour everywhere. */
const markLooks = {"first crack": ["#e69f00", "triangle", 5], "first dip": ["#0072b2", "square", 4], "start of the splitting crack": ["#d55e00", "diamond", 4],
  "start of the longest crack": ["#d55e00", "diamond", 4], strength: ["ink", "ring", 7], "largest stress": ["#cc79a7", "dot", 4]};

/** The marks of a test; those that fall together become one with both names. The strength comes first: its ring is drawn around others. */
function marksOf(test) {
  const marks = [];
  for (const m of (test.brazilian && test.brazilian.marks) || []) {
    const same = marks.find((other) => (m.crack >= 0 ? other.crack === m.crack : other.crack < 0 && other.strain === m.strain && other.stress === m.stress));
    if (same) Object.assign(same, {name: same.name + " = " + m.name, look: markLooks[m.name]});
    else marks.push({...m, look: markLooks[m.name]});
  }
  return marks.sort((a, b) => (b.look[1] === "ring") - (a.look[1] === "ring"));
}

function markSeries(test) {
  return marksOf(test).map(({name, strain, stress, look: [color, mark, size]}) => ({label: name, x: [strain], y: [stress], color, mark, size}));
}

/** Where the stress first reaches `level` (a magnitude): its x and y on the curve of `x` over the stress, and the row before it; null if it does not. */
function reading(test, x, level) {
  const stress = test.history.stress, last = peakRow(test);
  if (level === null || level === undefined) return null;
  for (let i = 0; i <= last; ++i) {
    if (stress[i] === null || x[i] === null || Math.abs(stress[i]) < 0.99999 * level) continue;
    if (i === 0 || x[i - 1] === null || stress[i - 1] === null || Math.abs(stress[i]) === Math.abs(stress[i - 1])) return {x: x[i], y: stress[i], row: i - 1};
    const share = Math.min(1, Math.max(0, (level - Math.abs(stress[i - 1])) / (Math.abs(stress[i]) - Math.abs(stress[i - 1]))));
    return {x: x[i - 1] + share * (x[i] - x[i - 1]), y: stress[i - 1] + share * (stress[i] - stress[i - 1]), row: i - 1};
  }
  return null;
}

/** Where numbers are read off a curve of `x` over the stress: first crack, crack initiation and damage, the stretch of the moduli, the strength. */
function readOffSeries(test, x, moduli) {
  const series = [], stress = test.history.stress;
  const mark = (label, level, color, shape, size) => {
    const at = reading(test, x, level);
    if (at) series.push({label, x: [at.x], y: [at.y], color, mark: shape, size});
  };
  if (moduli && test.E !== null && test.peak) {
    const from = reading(test, x, 0.4 * test.peak), to = reading(test, x, 0.6 * test.peak), middle = reading(test, x, 0.5 * test.peak);
    if (from && to && middle) {
      const rows = [...Array(Math.max(0, to.row - from.row)).keys()].map((i) => from.row + 1 + i);
      series.push({label: "E: 40 to 60 % of the strength", x: [from.x, ...rows.map((r) => x[r]), to.x], y: [from.y, ...rows.map((r) => stress[r]), to.y], color: "#009e73", width: 8, glow: true});
      series.push({label: "50 %", x: [middle.x], y: [middle.y], color: "#009e73", mark: "dot", size: 3, key: false});
    }
  }
  if (test.brazilian) return series.concat(markSeries(test));
  const first = test.history.tensile.findIndex((v, i) => v + test.history.shear[i] > 0);   // it may lie behind the strength
  if (first >= 0 && x[first] !== null) series.push({label: "first crack", x: [x[first]], y: [stress[first]], color: "#e69f00", mark: "triangle", size: 5});
  mark("\u03c3ci", test.crack_initiation, "#0072b2", "square", 4);
  mark("\u03c3cd", test.sigma_cd, "#cc79a7", "diamond", 4);
  const peak = peakRow(test);
  if (peak >= 0 && x[peak] !== null && test.peak !== null) series.push({label: test.peak_reached ? "strength" : "largest stress, peak not reached", x: [x[peak]], y: [stress[peak]], color: "ink", mark: "ring", size: 6});
  return series;
}

function strainLabelOf(test, short) {
  const words = short ? test.axes.strain.replace(" from the platens", "").replace("Approach of the plates", "Approach").replace(/, .*/, "") : test.axes.strain;
  return words + " (10\u207b\u00b3)";
}

function stressLabelOf(test) {
  return test.axes.stress + " (MPa)";
}

function stressSeries(tests, chosen) {
  const t = tests[chosen], others = tests.filter((other) => other !== t);
  return [...others.map((o, i) => ({label: i ? "packing " + o.seed : "other packings", x: o.history.strain, y: o.history.stress, color: "context", width: 1.3, quiet: i > 0})),
    {label: "packing " + t.seed, x: t.history.strain, y: t.history.stress, color: "ink", width: 2.2},
    ...(measured.get(titleOf(t)) || []).map((m) => ({...m, color: "#cc79a7", width: 2.2})),
    {label: "its tensile cracks", x: t.history.strain, y: t.history.tensile, color: "tensile", width: 1.5, right: true, step: true},
    {label: "shear cracks", x: t.history.strain, y: t.history.shear, color: "shear", width: 1.5, right: true, step: true},
    ...readOffSeries(t, t.history.strain, true)];
}

function strainSeries(test) {
  const history = test.history;
  const volumetric = history.gauge.map((v, i) => (v === null || history.lateral[i] === null ? null : v + history.lateral[i]));
  const series = [
    {label: "axial", x: history.gauge, y: history.stress, color: "ink", width: 2},
    {label: "lateral", x: history.lateral, y: history.stress, color: "#009e73", width: 2},
    {label: "volumetric", x: volumetric, y: history.stress, color: "#cc79a7", width: 2},
  ];
  const [low, high] = extent(series.map((s) => s.x));
  const peak = peakRow(test);
  if (peak >= 0 && test.peak !== null) for (const s of [...series]) if (s.x[peak] !== null) series.push({label: "strength", x: [s.x[peak]], y: [s.y[peak]], color: s.color, mark: "ring", size: 5, key: false});
  const sign = methodOf(test.kind).sign;   // strengths are magnitudes, the curve of a tension test is negative
  const level = (name, magnitude, color, left) => {
    if (magnitude === null) return;
    const value = sign * magnitude;
    series.push({label: name, x: [left ? low : high, left ? high : low], y: [value, value], color, width: 1, dash: true, quiet: true, note: name, noteSide: left ? "left" : "right"});
  };
  level("\u03c3ci " + show(test.crack_initiation), test.crack_initiation, "soft", true);
  level("\u03c3cd " + show(test.sigma_cd), test.sigma_cd, "soft", false);
  return series;
}

function energySeries(test) {
  const y = test.history;
  const line = (label, key, color, width, dash) => ({label, x: y.strain, y: y[key], color, width, dash});
  return [line("supplied", "supplied", "ink", 2.4), line("elastic, grains", "grains", "#56b4e9", 1.8), line("elastic, contacts", "contacts", "#009e73", 1.8),
    line("fracture", "fracture", "#d55e00", 1.8), line("friction", "friction", "#e69f00", 1.8), line("damping", "damping", "#cc79a7", 1.8),
    line("kinetic", "kinetic", "#999999", 1.8, true), line("not accounted for", "residual", "shear", 1.2, true)];
}

/** What the energy chart leaves out, and how well the balance closes. */
function energyNote(test) {
  const largest = (key) => Math.max(0, ...test.history[key].filter((v) => v !== null).map(Math.abs));
  const moving = largest("loading_motion"), left = largest("residual");
  return "Supplied: work of the fixtures, the pressures and the elastic start" + (moving > 0 ? ", without the kinetic energy of the loading motion, at most " + show(moving, 2) + " J, which is put in and taken out again where the rate changes; kinetic: of the motion beside it" : "") +
    ". Not accounted for: supplied less all the others, at most " + show(left, 2) + " J" + (test.energy_residual !== null ? ", " + show(100 * test.energy_residual, 2) + " % of the supplied energy" : "") + ".";
}

function hasGauges(test) { return test.history.lateral.some((v) => v !== null && v !== 0); }

function writeTests() {
  page.append(h("h2", {}, "Tests"),
    h("p", {class: "soft"}, "Strains in 10\u207b\u00b3, stresses in MPa, compression positive. Cracks are contact points whose bond broke, counted for the chosen packing."));
  const groups = [...groupTests().values()];
  if (!data.variants) { for (const tests of groups) writeTest(page, tests); return; }
  const box = h("div", {}), present = data.variants.filter((v) => data.tests.some((t) => t.variant === v.name));
  const open = (name) => {
    box.replaceChildren();
    for (const tests of groups) if (tests[0].variant === name) writeTest(box, tests);
  };
  if (!present.length) return;
  page.append(chooser("Variant", present.map((v) => v.name), (i) => open(present[i].name)) || "", box);
  open(present[0].name);
}

/** Load over the readings of gauge number g. */
function gaugeSeries(tests, chosen, g) {
  const t = tests[chosen], line = (test, more) => ({x: test.gauges[g].values, y: test.gauges[g].load, ...more});
  return [...tests.filter((other) => other !== t && other.gauges[g]).map((o, i) => line(o, {label: i ? "packing " + o.seed : "other packings", color: "context", width: 1.3, quiet: i > 0})),
    line(t, {label: "packing " + t.seed, color: "ink", width: 2.2}), ...loadMark(t, g)];
}
/** The strength on the curve of a gauge. */
function loadMark(t, g) {
  const row = peakRow(t), gauge = t.gauges[g];
  if (row < 0 || t.peak === null || gauge.values[row] === null) return [];
  return [{label: t.peak_reached ? "strength" : "largest stress, peak not reached", x: [gauge.values[row]], y: [gauge.load[row]], color: "ink", mark: "ring", size: 6}];
}

/** Acoustic emission in words. */
function addEmission(t, add) {
  const a = t.emission;
  add("Acoustic emission", plural(a.events, "event") + " (" + a.other_radii.map((o) => o.events + " within " + o.radius_grains + " grains").join(", ") + "), " + show(100 * a.tensile_share, 2) + " % tensile, " + show(100 * a.shear_share, 2) + " % shear; largest magnitude " + show(a.largest_magnitude));
  if (a.b_value !== null) add("b-value", show(a.b_value) + " \u00b1 " + show(a.b_error, 2) + " of " + a.events_above_it + " events from magnitude " + show(a.completeness_magnitude) + " on; fractal dimension " + show(a.fractal_dimension));
}

/** Events over the strain, before the strength and behind it, with the stress. */
function rateSeries(t) {
  const stress = {label: "stress", x: t.history.strain, y: t.history.stress, color: "ink", width: 1.8};
  if (!t.emission) return [stress];
  const {from, width, before, behind} = t.emission.rate, x = before.map((_, i) => from + i * width), some = (list) => list.some((v) => v > 0);
  if (!(width > 0)) return [stress];
  const bars = [];
  if (some(before)) bars.push({label: "events until the strength", x, y: before, color: "tensile", bar: width, right: true});
  if (some(behind)) bars.push({label: "events behind it", x, y: behind.map((v, i) => v + before[i]), base: before, color: "shear", bar: width, right: true});
  return [...bars, stress];
}

/** How many events have a magnitude of at least M, and the line of the b-value. */
function magnitudeSeries(t) {
  const a = t.emission;
  if (!a || !a.magnitudes.length) return [];
  const x = a.magnitudes.map((m) => m[0]), y = a.magnitudes.map((m) => m[1]), series = [];
  const largest = x[x.length - 1], start = a.completeness_magnitude;
  if (a.b_value !== null) {
    const end = Math.min(largest + 0.3, start + Math.log10(a.events_above_it / 0.7) / a.b_value);
    series.push({label: "b = " + show(a.b_value) + " \u00b1 " + show(a.b_error, 2), x: [start, end], y: [a.events_above_it, a.events_above_it * 10 ** (-a.b_value * (end - start))], color: "shear", width: 2});
    series.push({label: "cut-off magnitude " + show(start), x: [start, start], y: [1, y[0]], color: "soft", width: 1.2, dash: true});
  }
  series.push({label: "events of at least this magnitude", x, y, color: "tensile", mark: "dot", size: 2.6});
  return series;
}

function emissionNote(t) {
  const a = t.emission;
  if (!a) return "No crack, and so no acoustic event.";
  const shares = "Of " + plural(a.events, "event") + " " + show(100 * a.tensile_share, 2) + " % are tensile, " + show(100 * a.shear_share, 2) + " % shear by their moment tensor. ";
  const slope = a.b_value !== null ? "b = " + show(a.b_value) + " \u00b1 " + show(a.b_error, 2) + " (standard error) from " + a.events_above_it + " events of magnitude " + show(a.completeness_magnitude) + " or more. "
    : "Fewer than " + a.fewest_events + " events" + (a.events >= a.fewest_events ? " above the cut-off magnitude" : "") + ": no b. ";
  return shares + slope + (a.fractal_dimension !== null ? "Fractal dimension of their places " + show(a.fractal_dimension) + "." : "Too few for a fractal dimension.");
}

/** Charts of the acoustic emission. */
function writeEmission(grid, tests, updates) {
  if (!tests.some((t) => t.emission)) return;
  const rate = card("Acoustic events and stress"), sizes = card("Magnitudes of the acoustic events");
  grid.append(rate, sizes);
  const counted = (t) => "Events, cracks gathered within " + (t.emission ? show(t.emission.radius_mm, 2) + " mm" : "a few grains") + ", counted in " + (t.emission ? t.emission.rate.before.length : 40) + " equal steps of the strain. Behind the strength the strain may turn back.";
  const one = new XYChart(rate, {x: strainLabelOf(tests[0]), y: stressLabelOf(tests[0]), right: "Acoustic events", whole: true, series: rateSeries(tests[0])}), words = h("p", {class: "soft tiny caption"}, counted(tests[0]));
  rate.append(words);
  const two = new XYChart(sizes, {x: "Magnitude M = 2/3 (log E \u2212 4.8), E in J", y: "Events of magnitude \u2265 M", yLog: true, series: [], ...magnitudeRanges(tests[0])}), note = h("p", {class: "soft tiny caption"});
  sizes.append(note);
  const fill = (i) => {
    one.set(rateSeries(tests[i]));
    words.textContent = counted(tests[i]);
    Object.assign(two.options, magnitudeRanges(tests[i]));
    two.set(magnitudeSeries(tests[i]));
    note.textContent = emissionNote(tests[i]);
  };
  fill(0);
  updates.push(fill);
}
/** Magnitudes need no zero in sight. */
function magnitudeRanges(t) {
  const list = t.emission ? t.emission.magnitudes : [];
  if (!list.length) return {xRange: [-8, -4], yRange: [0.7, 10]};
  return {xRange: [list[0][0] - 0.2, list[list.length - 1][0] + 0.5], yRange: [0.7, 10 ** Math.ceil(Math.log10(list[0][1]) + 0.05)]};
}

/** What the rock came to on this specimen: minerals, draws, joints. */
function addRock(t, add) {
  const r = t.rock, range = (s) => show(s.minimum) + " to " + show(s.maximum) + ", mean " + show(s.mean);
  for (const m of r.minerals || []) add(m.name, show(100 * m.area_share) + " % of the area (" + show(100 * m.wanted_share) + " % wanted), " + plural(m.grains, "grain") +
    (m.sizes_mm ? ", " + range(m.sizes_mm.cells) + " mm, as discs " + range(m.sizes_mm.discs) + " (" + range(m.sizes_mm.wanted) + " wanted)" : ""));
  if (r.crystals) add("Crystals", plural(r.crystals.crystals, "crystal") + " of " + show(r.crystals.grains_per_crystal) + " grains; " + r.crystals.inside_cracks + " of " + plural(r.crystals.cracks, "crack") + " inside them");
  for (const d of r.draws || []) add("Scatter of " + d.quantity, "mean " + show(d.mean) + ", variation " + show(100 * d.variation) + " %, " + show(d.lowest) + " to " + show(d.highest) + " times, " + plural(d.count, d.quantity === "E" ? "grain" : "contact"));
  if (r.initial_cracks) add("Before the test", r.initial_cracks.broken + " broken and " + r.initial_cracks.weakened + " weakened of " + plural(r.initial_cracks.contacts, "contact"));
  for (const j of r.joints || []) add("Joint " + j.name, plural(j.contacts, "contact") + ", " + show(j.length_mm) + " mm of grain edges");
}

/** What a plate with a hole shows, in words. */
function addHole(t, add) {
  const k = t.hole;
  add("Hole", "radius " + show(k.hole_radius) + " mm, " + show(k.hole_radius_over_grain, 2) + " mean grains");
  if (k.hole_side_factor !== null) add("Stress at its edge, elastic", show(k.hole_side_factor) + " times the axial stress at the sides, " + show(k.hole_pole_factor) + " at the poles");
  if (k.hole_pole_crack !== null) add("First tensile crack at a pole", "axial stress " + show(k.hole_pole_crack, 4) + " MPa");
  if (k.hole_side_crack !== null) add("First crack at a side", "axial stress " + show(k.hole_side_crack, 4) + " MPa");
  if (k.hole_breakout !== null) add("Breakout, one grain deep", "axial stress " + show(k.hole_breakout, 4) + " MPa, at the sides " + show(k.hole_breakout_side_stress, 4) + " MPa");
  add("Depth of the breakout", show(k.hole_depth_at_peak, 2) + " mm at the largest stress, " + show(k.hole_depth_at_end, 2) + " mm at the end");
}

/** The charts and numbers of one kind of test. */
function writeTest(host, tests) {
  const peaks = tests.map((t) => t.peak).filter((p) => p !== null);
  const summary = peaks.length ? (tests[0].peak_load !== null ? "Largest stress " : "Strength ") + show(median(peaks)) + " MPa" + (peaks.length > 1 ? ", median of " + peaks.length + " packings (" + show(Math.min(...peaks)) + " to " + show(Math.max(...peaks)) + ")" : "") + "." : "";
  const open = tests.filter((t) => !t.peak_reached).length;
  host.append(h("h3", {}, titleOf(tests[0])), h("p", {class: "soft"}, summary + (open ? " The peak was not reached in " + plural(open, "test") + "." : "")));
  const strainLabel = strainLabelOf(tests[0]);
  const stressLabel = stressLabelOf(tests[0]);
  const updates = [];
  const elsewhere = h("p", {class: "soft small", hidden: ""});
  host.append(elsewhere);
  const grid = h("div", {class: "grid"});
  host.append(grid);
  const first = card("Stress and cracks"), second = card("Axial, lateral and volumetric strain, from the gauges"), third = card("Energy balance");
  grid.append(first);
  const a = new XYChart(first, {x: strainLabel, y: stressLabel, right: "Cracks", whole: true, series: stressSeries(tests, 0)});
  updates.push((i) => a.set(stressSeries(tests, i)));
  if (tests.some(hasGauges)) {
    grid.append(second);
    const b = new XYChart(second, {x: "Strain, middle of the specimen (10\u207b\u00b3)", y: stressLabel, series: strainSeries(tests[0])});
    updates.push((i) => b.set(strainSeries(tests[i])));
  }
  tests[0].gauges.forEach((gauge, g) => {
    const host = card("Load and " + gauge.name);
    grid.append(host);
    const chart = new XYChart(host, {x: gauge.name + (gauge.unit === "1" ? "" : " (" + gauge.unit + ")"), y: "Load (kN)", series: gaugeSeries(tests, 0, g)});
    updates.push((i) => chart.set(gaugeSeries(tests, i, g)));
  });
  grid.append(third);
  const c = new XYChart(third, {x: strainLabel, y: "Energy (J)", series: energySeries(tests[0])}), note = h("p", {class: "soft tiny caption"}, energyNote(tests[0]));
  third.append(note);
  updates.push((i) => { c.set(energySeries(tests[i])); note.textContent = energyNote(tests[i]); });
  writeEmission(grid, tests, updates);
  first.classList.toggle("broad", grid.children.length % 2 === 1);   // the others stand in pairs
  grid.append(testFacts(tests, updates));
  writeCycles(host, tests, updates);
  const redrawCurve = () => a.set(stressSeries(tests, testOfPacking(tests, packing.seed)));
  first.querySelector(".tools").insertBefore(measuredButton(first, tests[0], redrawCurve), first.querySelector(".tools button"));
  let shown = 0;
  packing.follow((seed) => {
    if (!grid.isConnected) return;   // of a variant that is no longer shown
    const i = testOfPacking(tests, seed);
    elsewhere.hidden = tests[i].seed === seed;
    elsewhere.textContent = "Not run on packing " + seed + ": packing " + tests[i].seed + " is shown.";
    if (i !== shown) updates.forEach((update) => update(i));
    shown = i;
  });
}

/** Curves that were measured on the rock itself, of a kind of test: [{label, x, y}]. They live as long as the page is open. */
const measured = new Map();

/** Rows of numbers from a text with commas, semicolons, tabs or blanks between them, and the words above them. With semicolons or tabs a comma may be a decimal point. */
function readTable(text) {
  const lines = text.replace(/^\ufeff/, "").split(/\r?\n/).filter((line) => line.trim() && !line.startsWith("#"));
  const mark = lines.some((l) => l.includes(";")) ? ";" : lines.some((l) => l.includes("\t")) ? "\t" : lines.some((l) => l.includes(",")) ? "," : null;
  const cells = (line) => (mark ? line.split(mark) : line.trim().split(/\s+/)).map((cell) => cell.trim().replace(/^"(.*)"$/, "$1"));
  const number = (cell) => (cell === "" ? NaN : Number(mark === "," ? cell : cell.replace(",", ".")));
  const rows = [], words = [];
  for (const line of lines) {
    const row = cells(line), values = row.map(number);
    if (values.filter(Number.isFinite).length >= 2) rows.push(values);
    else if (!rows.length) words.push(row);
  }
  const columns = Math.max(0, ...rows.map((row) => row.length));
  return {rows, heads: [...Array(columns).keys()].map((i) => words.map((row) => row[i] || "").filter(Boolean).join(" ") || "column " + (i + 1))};
}
const strainUnits = [["1", "without a unit", 1e3], ["%", "%", 10], ["10\u207b\u00b3", "10\u207b\u00b3, mm/m", 1], ["\u00b5", "10\u207b\u2076, \u00b5m/m", 1e-3]];
const stressUnits = [["MPa", "MPa", 1], ["kPa", "kPa", 1e-3], ["Pa", "Pa", 1e-6], ["GPa", "GPa", 1e3], ["psi", "psi", 6.894757e-3]];
function guessedUnit(units, head, fallback) {
  const text = head.toLowerCase(), has = (pattern) => pattern.test(text);
  if (units === strainUnits) return has(/%|percent/) ? 1 : has(/10\^?-3|10\u207b\u00b3|mm\/m|milli/) ? 2 : has(/micro|\u00b5|\u03bc|10\^?-6/) ? 3 : fallback;
  return has(/mpa/) ? 0 : has(/kpa/) ? 1 : has(/gpa/) ? 3 : has(/psi/) ? 4 : has(/\bpa\b/) ? 2 : fallback;
}

/** A button that lays a curve of the reader's own over ours: a file on this machine, which goes nowhere. */
function measuredButton(host, test, draw) {
  const key = titleOf(test), form = h("div", {class: "pick measured", hidden: ""}), file = h("input", {type: "file", accept: ".csv,.txt,.tsv,.dat", hidden: "", onchange: () => { const chosen = file.files[0]; if (chosen) chosen.text().then((text) => { open(chosen.name, text); file.value = ""; }); }});
  const choice = (label, entries, chosen) => { const list = h("select", {"aria-label": label}, entries.map((text, i) => h("option", {value: i}, text))); list.selectedIndex = Math.min(chosen, entries.length - 1); return list; };
  function open(name, text) {
    const {rows, heads} = readTable(text);
    form.hidden = false;
    if (!rows.length) { form.replaceChildren("No two columns of numbers in " + name + "."); return; }
    const find = (pattern, other) => { const i = heads.findIndex((head) => pattern.test(head.toLowerCase())); return i < 0 ? other : i; };
    const x = find(/strain|\u03b5|eps|dehnung/, 0), y = find(/stress|\u03c3|sigma|mpa|spannung/, x === 1 ? 0 : 1), small = Math.max(...rows.map((row) => Math.abs(row[x]) || 0)) < 0.1;
    const strain = choice("Column of the strain", heads, x), stress = choice("Column of the stress", heads, y);
    const strainUnit = choice("Unit of the strain", strainUnits.map((u) => u[1]), guessedUnit(strainUnits, heads[x], small ? 0 : 1)), stressUnit = choice("Unit of the stress", stressUnits.map((u) => u[1]), guessedUnit(stressUnits, heads[y], 0));
    const put = () => {
      const list = rows.map((row) => [row[strain.value] * strainUnits[strainUnit.value][2], row[stress.value] * stressUnits[stressUnit.value][2]]).filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b));
      const most = (k) => list.reduce((best, row) => (Math.abs(row[k]) > Math.abs(best) ? row[k] : best), 0), sign = methodOf(test.kind).sign;
      const turn = [most(0) * sign < 0 ? -1 : 1, most(1) * sign < 0 ? -1 : 1];   // compression is positive here, whatever it is in the file
      measured.set(key, [{label: "measured: " + name, x: list.map((row) => turn[0] * row[0]), y: list.map((row) => turn[1] * row[1])}]);
      draw();
    };
    for (const list of [strain, stress, strainUnit, stressUnit]) list.addEventListener("change", put);
    form.replaceChildren("Strain", strain, strainUnit, "stress", stress, stressUnit, h("button", {type: "button", onclick: () => { measured.delete(key); form.hidden = true; draw(); }}, "Remove"));
    put();
  }
  host.append(form, file);
  return h("button", {type: "button", title: "Lay a curve that was measured over these: a table of strain and stress in a file, which stays on this machine", onclick: () => file.click()}, "Measured\u2026");
}

/** What each cycle of loading and unloading shows, one row a cycle. */
function writeCycles(host, tests, updates) {
  if (!tests.some((t) => t.cycles)) return;
  const box = h("div", {});
  host.append(box);
  const cell = (v, digits) => td(v === null ? "\u2013" : show(v, digits), true);
  const fill = (i) => {
    const cycles = tests[i].cycles || [];
    box.replaceChildren(h("h4", {}, "Cycles, packing " + tests[i].seed), table("evidence",
      [th("Cycle", true), th(["Largest", h("br"), "stress, MPa"], true), th(["E loading", h("br"), "GPa"], true, "slope of the reloading in the middle half of its stress"),
        th(["E unloading", h("br"), "GPa"], true, "slope of the unloading in the middle half of its stress"), th(["Permanent", h("br"), "axial, 10\u207b\u00b3"], true, "strain left when it is unloaded"), th(["lateral", h("br"), "10\u207b\u00b3"], true), th(["volumetric", h("br"), "10\u207b\u00b3"], true),
        th(["Damage \u03c9", h("br"), "10\u207b\u00b3"], true, "sum of the permanent dilation of all cycles (Martin and Chandler 1994)"), th(["First crack", h("br"), "MPa"], true), th(["\u03c3ci", h("br"), "MPa"], true, "crack volumetric strain of this loading"), th(["\u03c3cd", h("br"), "MPa"], true, "reversal of the volumetric strain in this loading"),
        th(["Work", h("br"), "J"], true), th(["Dissipated", h("br"), "J"], true), th("Cracks", true)],
      cycles.map((c, n) => h("tr", {}, td(String(n + 1), true), cell(c.peak, 4), cell(c.reloading), cell(c.unloading), cell(c.axial), cell(c.lateral), cell(c.volumetric), cell(c.omega), cell(c.first_crack), cell(c.sigma_ci), cell(c.sigma_cd), cell(c.work), cell(c.dissipated), td(String(c.cracks), true)))));
  };
  fill(0);
  updates.push(fill);
}

/** What one specimen under rising pressures shows, in words. */
function addMultiStage(t, add) {
  const m = t.multi_stage;
  for (const [sigma3, reversal, strength] of m.points)
    add("At \u03c3\u2083 = " + show(sigma3) + " MPa", "volumetric strain turns at " + show(reversal, 4) + " MPa" + (strength === null ? "" : ", strength " + show(strength, 4) + " MPa" + (sigma3 === m.points[m.points.length - 1][0] ? "" : " (estimated)")));
  if (m.cohesion !== null) add("Mohr-Coulomb", "c = " + show(m.cohesion) + " MPa, \u03c6 = " + show(m.friction_angle) + "\u00b0; deviator at the peak over that at the reversal " + show(m.peak_over_reversal));
}

function testFacts(tests, updates) {
  const body = h("dl", {}), facts = h("div", {class: "card broad numbers"}, h("h4", {}, "The chosen test in numbers"), body);
  const fill = (i) => {
    const t = tests[i], rows = [];
    const whole = (value) => (typeof value === "string" ? value.replace(/(\d) (?=(?:%|MPa|GPa|kN|mm|J)(?![a-z]))/g, "$1\u00a0") : value);   // no line ends between a number and its unit
    const add = (name, value) => rows.push(h("dt", {}, name), h("dd", {}, whole(value)));
    add("Packing", "seed " + t.seed);
    if (t.peak_load !== null) add("Largest load", show(t.peak_load, 4) + " kN");
    add(t.peak_load !== null ? "Largest stress" : "Strength", show(t.peak, 4) + " MPa" + (t.peak_reached ? "" : " (peak not reached)") + (t.peak_load !== null ? ", " + t.axes.stress.replace(/^[A-Z](?=[a-z])/, (c) => c.toLowerCase()) : ""));
    for (const p of t.properties) add(p.label, show(p.value, 4) + (p.unit ? " " + unitWords(p.unit) : ""));
    if (t.multi_stage) addMultiStage(t, add);
    if (t.hole) addHole(t, add);
    for (const gauge of t.gauges) add("Gauge " + gauge.name, gauge.meaning);
    if (t.section_width !== null) add("Section", show(t.section_width) + " mm wide");
    for (const remark of t.remarks) add("Note", remark);
    if (t.brazilian) {
      const b = t.brazilian, at = (radius, angle) => "r/R " + show(radius, 2) + ", " + show(angle, 3) + "\u00b0 from the loading plate";
      if (b.flat_coefficient !== null) add("Flattened disc", "stress k 2P / (\u03c0Dt), k = " + show(b.flat_coefficient));
      add("First dip of 5 %, largest", show(b.first_dip, 4) + " MPa, " + show(b.largest, 4) + " MPa");
      if (b.first_crack_radius !== null) add("First crack at", at(b.first_crack_radius, b.first_crack_angle));
      if (b.splitting_radius !== null) add(b.split ? "Splitting crack began at" : "Longest crack began at", at(b.splitting_radius, b.splitting_angle) + ", " + show(100 * b.splitting_share, 2) + " % of the strength");
      add("Valid by ISRM", b.valid ? "yes: split from the central part" : b.why + (b.split ? ", not from the central part" : ""));
      add("Arc of contact at the strength", show(b.arc_top, 2) + "\u00b0 top, " + show(b.arc_bottom, 2) + "\u00b0 bottom");
    }
    if (t.E !== null) add("E, secant at 50 %", show(t.E) + " GPa");
    if (t.nu !== null) add("Poisson's ratio", show(t.nu));
    add("First crack", show(t.first_crack) + " MPa");
    for (const [method, value] of Object.entries(t.sigma_ci)) if (value !== null) add("\u03c3ci, " + method, show(value) + " MPa" + (t.peak ? " (" + show(value / t.peak, 2) + " of the peak)" : ""));
    if (t.sigma_cd !== null) add("\u03c3cd", show(t.sigma_cd) + " MPa" + (t.peak ? " (" + show(t.sigma_cd / t.peak, 2) + " of the peak)" : ""));
    const branch = t.post_peak;
    if (branch.brittleness !== null) add("Behind the peak", "modulus " + show(branch.modulus) + " GPa, brittleness k1 " + show(branch.brittleness, 2) + (branch.brittleness < 1 ? " (class II)" : " (class I)"));
    if (branch.fracture !== null) add("Energy behind the peak", show(100 * branch.fracture, 2) + " % fracture, " + show(100 * branch.friction, 2) + " % friction, " + show(100 * branch.damping, 2) + " % damping");
    if (t.failure) add("Failure", t.failure.name.replace(/^./, (c) => c.toUpperCase()) + ". " + t.failure.words + ".");
    add("Cracks at the end", t.tensile + " tensile, " + t.shear + " shear");
    if (t.emission) addEmission(t, add);
    if (t.rock) addRock(t, add);
    add("Ended because", t.stop_reason || "\u2013");
    add("Quasi-static", h("span", {}, h("span", {class: "grade " + t.grade}, t.grade), " " + t.verdict));
    add("Cost", t.steps.toLocaleString("en") + " steps, " + show(t.wall_s) + " s");
    body.replaceChildren(...rows);
  };
  fill(0);
  updates.push(fill);
  return facts;
}

function envelopeSeries() {
  const series = [], fits = data.envelope.fits, seeds = (kind) => data.tests.filter((t) => t.kind === kind && t.peak !== null && t.peak_reached);
  const uniaxial = seeds(methodOfStrength("UCS")), biaxial = data.tests.filter((t) => methodOf(t.kind).on_envelope && methodOf(t.kind).confined && t.peak !== null && t.peak_reached), tension = seeds(methodOfStrength("DTS")), brazilian = seeds(methodOfStrength("BTS"));
  const lab = data.laboratory, reach = Math.max(...biaxial.map((t) => t.sigma3), ...uniaxial.map(() => 2), 1) * 1.12;
  const line = (c, degrees) => {
    const s = Math.sin((degrees * Math.PI) / 180), n = (1 + s) / (1 - s), ucs = 2 * c * Math.sqrt(n);
    return {x: [0, reach], y: [ucs, ucs + n * reach]};
  };
  const c = median(fits.map((f) => f.cohesion)), phi = median(fits.map((f) => f.friction_angle)), mi = median(fits.map((f) => f.mi)), sci = median(fits.map((f) => f.hoek_brown_UCS));
  if (lab.cohesion_MPa && lab.friction_angle_deg) {
    series.push(Object.assign({label: "laboratory, Mohr-Coulomb c = " + show(lab.cohesion_MPa) + " MPa, \u03c6 = " + show(lab.friction_angle_deg) + "\u00b0", color: "shear", width: 1.6, dash: true}, line(lab.cohesion_MPa, lab.friction_angle_deg)));
  }
  if (c !== null && phi !== null) series.push(Object.assign({label: "Mohr-Coulomb, medians c = " + show(c) + " MPa, \u03c6 = " + show(phi) + "\u00b0", color: "ink", width: 2}, line(c, phi)));
  if (mi !== null && sci !== null && mi > 0) {
    const x = [...Array(61).keys()].map((i) => -sci / mi + (i / 60) ** 2 * (reach + sci / mi));   // denser where it is steep
    series.push({label: "Hoek-Brown, medians mi = " + show(mi) + ", \u03c3ci = " + show(sci) + " MPa", color: "#009e73", width: 1.6, x, y: x.map((s) => s + sci * Math.sqrt(Math.max(0, (mi * s) / sci + 1)))});
  }
  const marks = (label, tests, x, y, color, mark) => { if (tests.length) series.push({label, x: tests.map(x), y: tests.map(y), color, mark, size: 4}); };
  marks("biaxial tests", biaxial, (t) => t.sigma3, (t) => t.peak, "ink", "dot");
  marks("UCS", uniaxial, () => 0, (t) => t.peak, "tensile", "dot");
  marks("direct tension (\u03c3\u2081 = 0)", tension, (t) => -t.peak, () => 0, "#cc79a7", "square");
  marks("Brazilian (\u03c3\u2081 = 3 BTS at the centre)", brazilian, (t) => -t.peak, (t) => 3 * t.peak, "#cc79a7", "diamond");
  if (lab.UCS_MPa) series.push({label: "laboratory UCS", x: [0], y: [lab.UCS_MPa], color: "shear", mark: "ring", size: 5});
  if (lab.BTS_MPa) series.push({label: "laboratory BTS", x: [-lab.BTS_MPa], y: [3 * lab.BTS_MPa], color: "shear", mark: "diamond", size: 4.5});
  return series;
}

function writeEnvelope() {
  if (!data.envelope.fits.length && !data.tests.some((t) => methodOf(t.kind).on_envelope && methodOf(t.kind).confined)) return;
  page.append(h("h2", {}, "Strength envelope"));
  if (data.envelope.method) page.append(h("p", {class: "soft"}, data.envelope.method));
  const grid = h("div", {class: "grid", style: "align-items:start"}), chart = card("Strength of each test");
  page.append(grid);
  grid.append(chart);
  const strengths = new XYChart(chart, {x: "Minor principal stress \u03c3\u2083 (MPa, compression positive)", y: "Major principal stress \u03c3\u2081 (MPa)", height: 380, series: envelopeSeries()});
  writeMohr(grid, data.tests, data.envelope.fits);
  if (!data.envelope.fits.length) return;
  writeRockMass(grid, strengths);
  const fits = card("Fits, one for each packing");
  fits.classList.add("broad");
  grid.append(fits);
  fits.append(table("evidence", [th("Seed", true), th(["c", h("br"), "MPa"], true), th(["\u03c6", h("br"), "\u00b0"], true), th(["UCS fitted", h("br"), "MPa"], true), th(["UCS measured", h("br"), "MPa"], true), th("mi", true), th(["\u03c3ci H-B", h("br"), "MPa"], true)],
    data.envelope.fits.map((f) => h("tr", {}, td(String(f.seed), true), td(show(f.cohesion), true), td(show(f.friction_angle), true), td(show(f.UCS_fitted), true), td(show(f.UCS_measured), true), td(show(f.mi), true), td(show(f.hoek_brown_UCS), true)))),
    h("p", {class: "soft small"}, "Mohr-Coulomb: \u03c3\u2081 = 2c\u221aN + N\u03c3\u2083 with N = (1 + sin \u03c6)/(1 \u2212 sin \u03c6). Hoek-Brown, intact rock: \u03c3\u2081 = \u03c3\u2083 + \u03c3ci (mi \u03c3\u2083/\u03c3ci + 1)^\u00bd."));
}

/** The rock mass by Hoek-Brown 2002 from the intact rock of these tests, for a GSI and a disturbance that the reader gives. */
function rockMass(mi, sci, gsi, d) {
  const mb = mi * Math.exp((gsi - 100) / (28 - 14 * d)), s = Math.exp((gsi - 100) / (9 - 3 * d)), a = 0.5 + (Math.exp(-gsi / 15) - Math.exp(-20 / 3)) / 6;
  return {mb, s, a, uniaxial: sci * s ** a, tensile: (s * sci) / mb, global: (sci * (mb + 4 * s - a * (mb - 8 * s)) * (mb / 4 + s) ** (a - 1)) / (2 * (1 + a) * (2 + a)), sigma1: (s3) => s3 + sci * Math.max(0, (mb * s3) / sci + s) ** a};
}
function writeRockMass(grid, chart) {
  const fits = data.envelope.fits, mi = median(fits.map((f) => f.mi)), sci = median(fits.map((f) => f.hoek_brown_UCS));
  if (!(mi > 0) || !(sci > 0)) return;
  const box = card("Rock mass, Hoek-Brown 2002"), body = h("dl", {}), input = (label, value, min, max, step) => h("input", {type: "number", "aria-label": label, value, min, max, step});
  const gsi = input("GSI", 60, 0, 100, 5), d = input("D", 0, 0, 1, 0.1), shown = h("input", {type: "checkbox", "aria-label": "Draw its envelope"});
  const fill = () => {
    const g = Math.min(100, Math.max(0, Number(gsi.value) || 0)), k = Math.min(1, Math.max(0, Number(d.value) || 0)), mass = rockMass(mi, sci, g, k), rows = [];
    const add = (name, value) => rows.push(h("dt", {}, name), h("dd", {}, value));
    add("mb", show(mass.mb));
    add("s", show(mass.s));
    add("a", show(mass.a));
    add("Uniaxial strength of the mass", show(mass.uniaxial) + " MPa");
    add("Tensile strength of the mass", show(mass.tensile) + " MPa");
    add("Global strength of the mass", show(mass.global) + " MPa");
    body.replaceChildren(...rows);
    const own = envelopeSeries(), reach = Math.max(...own.flatMap((s) => s.x.filter((v) => v !== null))), x = [...Array(61).keys()].map((i) => -mass.tensile + (i / 60) ** 2 * (reach + mass.tensile));
    if (shown.checked) own.push({label: "rock mass, GSI " + g + ", D " + k, x, y: x.map(mass.sigma1), color: "#009e73", width: 1.8, dash: true});
    chart.set(own);
  };
  for (const control of [gsi, d, shown]) control.addEventListener("input", fill);
  box.append(h("div", {class: "pick"}, h("label", {}, "GSI ", gsi), h("label", {}, "D ", d), h("label", {}, shown, " draw its envelope")), body,
    h("p", {class: "soft small"}, "From the medians mi = " + show(mi) + ", \u03c3ci = " + show(sci) + " MPa of the intact rock: mb = mi exp((GSI \u2212 100)/(28 \u2212 14D)), s = exp((GSI \u2212 100)/(9 \u2212 3D)), a = \u00bd + (exp(\u2212GSI/15) \u2212 exp(\u221220/3))/6 (Hoek, Carranza-Torres and Corkum 2002). GSI and D are the reader's; the tests say nothing of them."));
  grid.append(box);
  fill();
}

/** Half circles of the strengths, medians over the packings, and the line that should touch them. */
function mohrSeries(tests, fits) {
  const groups = new Map(), series = [];
  for (const t of tests) {
    if (!methodOf(t.kind).on_envelope || t.peak === null || !t.peak_reached) continue;
    if (!groups.has(t.sigma3)) groups.set(t.sigma3, []);
    groups.get(t.sigma3).push(t.peak);
  }
  const pressures = [...groups.keys()].sort((a, b) => a - b);
  if (pressures.length < 2) return [];
  const circle = (from, to, more) => {
    const turn = [...Array(91).keys()].map((i) => (Math.PI * i) / 90), middle = 0.5 * (from + to), radius = 0.5 * (to - from);
    series.push({x: turn.map((a) => middle - radius * Math.cos(a)), y: turn.map((a) => radius * Math.sin(a)), width: 1.6, ...more});
  };
  pressures.forEach((s3, i) => circle(s3, median(groups.get(s3)), {label: "\u03c3\u2083 = " + Number(s3.toPrecision(4)) + " MPa: \u03c3\u2081 = " + show(median(groups.get(s3))) + " MPa", color: variantColor(i)}));
  const tension = tests.filter((t) => t.kind === methodOfStrength("DTS") && t.peak !== null && t.peak_reached).map((t) => t.peak);
  if (tension.length) circle(-median(tension), 0, {label: "direct tension", color: "#cc79a7"});
  const highest = 1.12 * Math.max(...pressures.map((s3) => 0.5 * (median(groups.get(s3)) - s3)));
  const line = (label, c, phi, more) => {
    const slope = Math.tan((phi * Math.PI) / 180), from = Math.max(-c / (slope || 1), -0.08 * highest);
    series.push({label: label + " c = " + show(c) + " MPa, \u03c6 = " + show(phi) + "\u00b0", x: [from, (highest - c) / (slope || 1)], y: [c + slope * from, highest], ...more});
  };
  const c = median(fits.map((f) => f.cohesion)), phi = median(fits.map((f) => f.friction_angle)), lab = data.laboratory;
  if (c !== null && phi !== null && phi > 0) line("\u03c4 = c + \u03c3 tan \u03c6, medians", c, phi, {color: "ink", width: 2.2});
  if (lab.cohesion_MPa && lab.friction_angle_deg) line("laboratory", lab.cohesion_MPa, lab.friction_angle_deg, {color: "shear", width: 1.6, dash: true});
  return series;
}

/** Mohr circles, where there are several pressures. */
function writeMohr(host, tests, fits) {
  const series = mohrSeries(tests, fits);
  if (!series.length) return null;
  const box = card("Mohr circles");
  host.append(box);
  return new XYChart(box, {x: "Normal stress \u03c3 (MPa, compression positive)", y: "Shear stress \u03c4 (MPa)", equal: true, height: 200, series});
}

/** Where crystals of several cells break: the share of the cracks that run inside crystals, over the pressure. */
function writeCrystals() {
  const tests = data.tests.filter((t) => t.rock && t.rock.crystals && t.rock.crystals.cracks > 0 && methodOf(t.kind).on_envelope);
  if (new Set(tests.map((t) => t.sigma3)).size < 2) return;
  const share = (t) => t.rock.crystals.inside_cracks / t.rock.crystals.cracks, series = [];
  const variants = [...new Set(tests.map((t) => t.variant || ""))];
  variants.forEach((variant, i) => {
    const own = tests.filter((t) => (t.variant || "") === variant), pressures = [...new Set(own.map((t) => t.sigma3))].sort((a, b) => a - b);
    const mean = (s3) => { const list = own.filter((t) => t.sigma3 === s3).map(share); return list.reduce((sum, v) => sum + v, 0) / list.length; };
    series.push({label: variant ? variant + ", mean" : "mean of the packings", x: pressures, y: pressures.map(mean), color: variants.length > 1 ? variantColor(i) : "ink", width: 2});
    series.push({label: variant ? variant + ", packings" : "each packing", x: own.map((t) => t.sigma3), y: own.map(share), color: variants.length > 1 ? variantColor(i) : "tensile", mark: variantMarks[i % 4], size: 4, key: variants.length === 1});
  });
  const box = card("Share of the cracks inside crystals");
  page.append(h("h2", {}, "Cracks inside crystals"), h("p", {class: "soft"}, "Cracks between two cells of one crystal over all cracks, at the end of each test in compression."), h("div", {class: "grid"}, box));
  new XYChart(box, {x: "Minor principal stress \u03c3\u2083 (MPa)", y: "Share of the cracks", yRange: [0, 1], series});
}

/** Shear strengths over normal stresses, with the lines through their medians. */
function writeShearEnvelope() {
  const fits = data.shear_envelope;
  if (!fits.length) return;
  const points = fits.flatMap((f) => f.points), reach = 1.12 * Math.max(...points.map((p) => p[0])), series = [];
  const line = (label, c, phi, color) => {
    if (c !== null && phi !== null) series.push({label: label + " c = " + show(c) + " MPa, \u03c6 = " + show(phi) + "\u00b0", x: [0, reach], y: [c, c + reach * Math.tan((phi * Math.PI) / 180)], color, width: 2});
  };
  line("strengths, medians", median(fits.map((f) => f.cohesion)), median(fits.map((f) => f.friction_angle)), "ink");
  line("residual, medians", median(fits.map((f) => f.residual_cohesion)), median(fits.map((f) => f.residual_friction_angle)), "shear");
  series.push({label: "shear strengths", x: points.map((p) => p[0]), y: points.map((p) => p[1]), color: "ink", mark: "dot", size: 4});
  const residual = points.filter((p) => p[2] !== null);
  if (residual.length) series.push({label: "residual strengths", x: residual.map((p) => p[0]), y: residual.map((p) => p[2]), color: "shear", mark: "ring", size: 4});
  page.append(h("h2", {}, "Shear strength envelope"), h("p", {class: "soft"}, "Direct shear: stresses on the plane that is left, straight lines by least squares on the tests of each packing (P63)."));
  const grid = h("div", {class: "grid", style: "align-items:start"}), chart = card("Strength of each test"), table_of_fits = card("Fits, one for each packing");
  page.append(grid);
  grid.append(chart, table_of_fits);
  new XYChart(chart, {x: "Normal stress (MPa)", y: "Shear stress (MPa)", height: 340, series});
  table_of_fits.append(table("evidence", [th("Seed", true), th(["c", h("br"), "MPa"], true), th(["\u03c6", h("br"), "\u00b0"], true), th(["c residual", h("br"), "MPa"], true), th(["\u03c6 residual", h("br"), "\u00b0"], true)],
    fits.map((f) => h("tr", {}, td(String(f.seed), true), td(show(f.cohesion), true), td(show(f.friction_angle), true), td(show(f.residual_cohesion), true), td(show(f.residual_friction_angle), true)))));
}

function writePattern() {
  if (!data.fields.length) return;
  page.append(h("h2", {}, "Failure pattern"), h("p", {class: "soft"},
    (data.fields.some((f) => f.role) ? "Of each kind of test the packings of the median, the smallest and the largest strength, as far as there is room. " : "One packing of each kind of test. ") +
    "Drag to move, buttons or Ctrl + wheel to zoom, double click to fit. The full fields of every test are in the .h5 files; feldspar export makes files for ParaView of them."));
  const canvas = h("canvas", {tabindex: "0", role: "img", "aria-label": "Failure pattern"}), readout = h("div", {class: "readout"}), stage = h("div", {class: "stage"}, canvas);
  const left = h("div", {class: "card"}), right = h("div", {}), box = h("div", {class: "viewer"}, left, right);
  const moment = h("div", {class: "small"}), slider = h("input", {type: "range", min: 0, value: 0, step: 0.1, "aria-label": "Moment of the test"});
  const bar = h("canvas", {}), low = h("span", {}), high = h("span", {}), scale = h("div", {class: "scale"}), crackKey = h("div", {class: "legend"});
  const rosette = h("canvas", {}), rosetteCard = h("div", {class: "card rosette"}, h("h4", {}, "Crack rosette"), h("div", {class: "soft small"}, "Direction of the cracks at the moment shown, weighted by length"), h("div", {}, rosette));
  const curveCard = h("div", {class: "card", style: "margin:14px 0"}, h("h4", {}, "Moments on the curve")), settings = h("div", {class: "card"});
  let curve = null, playing = null, current = 0, specimen = null;
  const cache = [];

  const viewer = new Viewer(canvas, readout, () => showMoment(), (test) => marksOf(data.tests[test]).filter((m) => m.crack >= 0));
  const last = () => specimen.meta.snapshots.length - 1;
  const go = (n) => { viewer.goTo(n); slider.value = n; showMoment(); viewer.draw(); };
  slider.addEventListener("input", () => go(Number(slider.value)));
  const play = h("button", {type: "button", onclick: () => {
    if (playing) { clearInterval(playing); playing = null; play.textContent = "Play"; return; }
    play.textContent = "Stop";
    if (viewer.moment >= last()) go(0);
    playing = setInterval(() => {
      if (viewer.moment >= last()) play.click();
      else go(Math.min(last(), Math.round(10 * viewer.moment + 1) / 10));
    }, 80);
  }}, "Play");
  const words = () => { const s = specimen.state(viewer.moment); return "strain " + show(s.strain) + "\u00b710\u207b\u00b3, stress " + show(s.stress) + " MPa, " + plural(s.cracks, "crack"); };
  const titleNow = () => { const t = data.tests[specimen.meta.test]; return fullTitle(t) + ", packing " + t.seed; };
  const picture = h("button", {type: "button", title: "Save the picture", onclick: () => { viewer.paint(); viewer.sheet(titleNow(), words()).toBlob((blob) => saveAs(blob, fileName(titleNow(), ".png"))); }}, "PNG");
  const film = h("button", {type: "button", title: "Save a film of the test, from its start to its end, some seconds long", onclick: () => record()}, "Film");
  async function record() {
    const kind = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"].find((k) => MediaRecorder.isTypeSupported(k)), before = viewer.moment, pause = (ms) => new Promise((done) => setTimeout(done, ms));
    if (playing) play.click();
    if (!kind || film.disabled) return;
    film.disabled = true;
    film.textContent = "Filming\u2026";
    const sheet = viewer.sheet(titleNow(), words()), recorder = new MediaRecorder(sheet.captureStream(25), {mimeType: kind, videoBitsPerSecond: 6e6}), parts = [];
    recorder.ondataavailable = (e) => parts.push(e.data);
    const stopped = new Promise((done) => { recorder.onstop = done; });
    recorder.start();
    for (let n = 0; n <= 10 * last(); ++n) {
      go(n / 10);
      viewer.paint();
      viewer.sheet(titleNow(), words(), sheet);
      await pause(n === 0 ? 500 : 45);
    }
    await pause(700);   // the end stands for a while
    recorder.stop();
    await stopped;
    saveAs(new Blob(parts, {type: kind}), fileName(titleNow(), kind.startsWith("video/mp4") ? ".mp4" : ".webm"));
    film.disabled = false;
    film.textContent = "Film";
    go(before);
  }
  const choice = (label, entries, set) => [h("label", {}, label), h("select", {"aria-label": label, onchange: (e) => { set(e.target.value); showScale(); viewer.draw(); }}, entries.map(([value, text]) => h("option", {value}, text)))];
  settings.append(h("div", {class: "controls"},
    choice("Colour of the grains", Object.entries(fieldKinds).map(([k, v]) => [k, v.label]), (v) => { viewer.field = v; }),
    choice("Colour of the cracks", [["mode", "mode: tensile or shear"], ["time", "time: axial strain at the break"], ["opening", "opening"], ["plain", "plain"], ["none", "no cracks"]], (v) => { viewer.cracks = v; }),
    choice("Displacements", [["1", "as they are"], ["0", "undeformed"], ["2", "enlarged"], ["3", "enlarged more"]], (v) => { viewer.enlarge(Number(v)); })),
    scale, crackKey);

  function showScale() {
    const kind = fieldKinds[viewer.field];
    scale.replaceChildren();
    if (kind.scale) {
      const [from, to] = viewer.limits(), colors = palette(kind.scale);
      bar.width = 256; bar.height = 1;
      const ctx = bar.getContext("2d"), image = ctx.createImageData(256, 1);
      new Uint32Array(image.data.buffer).set(colors);
      ctx.putImageData(image, 0, 0);
      low.textContent = show(from);
      high.textContent = show(to) + " " + kind.unit;
      scale.append(low, bar, high, kind.around ? h("span", {}, kind.words) : "");
    }
    const key = (color, text) => h("span", {}, h("b", {style: "border-color:" + color}), text);
    crackKey.replaceChildren();
    if (specimen && viewer.field === "grain") for (const m of specimen.meta.minerals || []) crackKey.append(key(m.colour, m.name));
    if (specimen && viewer.field === "fragments") {
      const piece = specimen.parts["fragment" + viewer.snapshot];
      crackKey.append(h("span", {}, !piece ? "The pieces are not known." : piece.some((p) => p > 0) ? plural(1 + piece.reduce((most, p) => Math.max(most, p), 0), "piece") + ", the largest without colour" : "all in one piece"));
    }
    if (specimen && specimen.meta.squares) {
      const {squares: {side, grains}, crack_every: every} = specimen.meta;
      crackKey.append(h("span", {}, "Drawn in squares of " + show(side) + " mm: means over about " + show(grains, 2) + " grains each" + (every > 1 ? "; one crack in " + every + " is drawn" : "") + "."));
    }
    if (specimen && specimen.parts.joint_ends) crackKey.append(key("var(--ink)", "joint before the test, dashed"));
    if (viewer.cracks === "mode") crackKey.append(key("var(--tensile)", "tensile crack"), key("var(--shear)", "shear crack"));
    if (viewer.cracks === "time") {
      const [first, end] = viewer.crackTimes(), colors = palette("viridis");
      crackKey.append(key(css(colors[0]), "first crack, strain " + show(first) + "\u00b710\u207b\u00b3"), key(css(colors[128]), "midway"), key(css(colors[255]), "last crack, " + show(end) + "\u00b710\u207b\u00b3"));
    }
    if (viewer.cracks === "opening" && specimen && specimen.meta.squares) crackKey.append(h("span", {}, "How far single cracks are open is not known in squares."));
    else if (viewer.cracks === "opening" && specimen) {
      const colors = palette("viridis"), wide = specimen.wideOpening();
      crackKey.append(key(css(colors[0]), "closed"), key(css(colors[128]), "open by " + show(wide / 2, 2) + " mm"), key(css(colors[255]), show(wide, 2) + " mm or more"));
    }
    if (specimen) for (const m of viewer.marksOf(specimen.meta.test)) crackKey.append(h("span", {}, h("b", {class: m.look[1], style: "background:" + m.look[0]}), m.name));
  }
  function showMoment() {
    const s = specimen.state(viewer.moment), test = data.tests[specimen.meta.test];
    moment.replaceChildren(h("strong", {}, s.label.replaceAll("-", " ")), s.share > 0 ? "" : " (" + (s.n + 1) + " of " + specimen.meta.snapshots.length + ")", "  \u00b7  strain " + show(s.strain) + "\u00b710\u207b\u00b3  \u00b7  stress " + show(s.stress) + " MPa  \u00b7  " +
      s.tensile + " tensile, " + (s.cracks - s.tensile) + " shear cracks");
    if (viewer.field === "fragments") showScale();
    drawRosette(rosette, specimen, viewer.moment);
    const all = specimen.meta.snapshots;
    const series = [{label: "stress", x: test.history.strain, y: test.history.stress, color: "context", width: 1.8},
      {label: "moments kept", x: all.map((k) => k.strain), y: all.map((k) => k.stress), color: "soft", mark: "dot", size: 3},
      {label: "shown", x: [s.strain], y: [s.stress], color: "shear", mark: "ring", size: 5},
      ...markSeries(test).map((m) => ({...m, size: m.size - 1}))];
    const x = strainLabelOf(test, true);
    if (curve && curve.options.x === x) curve.grow(series);
    else if (curve) { curve.options.x = x; curve.set(series); }
    else curve = new XYChart(curveCard, {x, y: "Stress (MPa)", height: 190, series});
  }
  /** The factors that suit this specimen: its farthest node moves by 6 and by 20 % of its size. */
  function showEnlargements() {
    const list = settings.querySelector("select[aria-label='Displacements']"), kind = list.selectedIndex, factors = [...new Set([0.06, 0.2].map((share) => specimen.enlargement(share)))].filter((f) => f > 1);
    list.replaceChildren(...[[1, "as they are"], [0, "undeformed"], ...factors.map((f) => [f, "times " + f])].map(([value, text]) => h("option", {value}, text)));
    list.selectedIndex = Math.min(Math.max(kind, 0), list.options.length - 1);
    viewer.magnify = Number(list.value);
  }
  async function open(i) {
    current = i;
    if (playing) play.click();
    cache[i] ||= readFields(data.fields[i], document.getElementById("fields-" + i)).then((parts) => new Specimen(data.fields[i], parts));
    const ready = await cache[i];
    if (current !== i) return;
    specimen = ready;
    slider.max = specimen.meta.snapshots.length - 1;
    for (const control of [play, slider, film]) control.hidden = last() < 1;
    showEnlargements();
    viewer.show(specimen);
    slider.value = viewer.snapshot;
    showScale();
  }

  // kinds of tests, and of each the packings that are here
  const groups = new Map(), roles = h("div", {});
  data.fields.forEach((f, i) => { const name = fullTitle(data.tests[f.test]); if (!groups.has(name)) groups.set(name, []); groups.get(name).push(i); });
  let kind = [...groups.keys()][0];
  const seedOf = (i) => data.tests[data.fields[i].test].seed;
  function openKind() {
    const list = groups.get(kind), own = list.findIndex((i) => seedOf(i) === packing.seed), chosen = own >= 0 ? own : 0;
    roles.replaceChildren(picker("Packing", list.map((i) => (data.fields[i].role ? data.fields[i].role + ": " : "") + "seed " + seedOf(i)), chosen, (n) => open(list[n])) || h("p", {class: "soft small"}, "packing " + seedOf(list[0])));
    open(list[chosen]);
  }
  const kinds = [...groups.keys()], shortName = (name) => name.replace(" compression at \u03c3\u2083 =", ",");
  page.append(chooser("Test", kinds.map(shortName), (i) => { kind = kinds[i]; openKind(); }) || h("p", {class: "small"}, shortName(kind)), roles, box);
  const zoom = h("div", {class: "zoom"}, h("button", {type: "button", "aria-label": "Zoom in", onclick: () => viewer.zoom(1.5)}, "+"),
    h("button", {type: "button", "aria-label": "Zoom out", onclick: () => viewer.zoom(1 / 1.5)}, "\u2212"), h("button", {type: "button", onclick: () => viewer.reset()}, "Fit"));
  left.append(moment, h("div", {class: "slider"}, play, slider, zoom), stage, h("div", {class: "tools"}, h("span", {class: "at readout"}), picture, typeof MediaRecorder === "undefined" || !canvas.captureStream ? "" : film));
  left.querySelector(".at").replaceWith(readout);
  right.append(settings, curveCard, rosetteCard);
  redraw.push(() => { if (specimen) { viewer.resize(); viewer.draw(); drawRosette(rosette, specimen, viewer.moment); } });
  if (typeof DecompressionStream === "undefined") left.replaceChildren(h("p", {}, "This view needs a browser of 2023 or later. The same fields are in the .h5 files; feldspar export makes files for ParaView of them."));
  else packing.follow((seed) => { if (!specimen && current === 0 || groups.get(kind).some((i) => seedOf(i) === seed)) openKind(); });
}

function writeEvidence() {
  page.append(h("h2", {}, "Evidence that the tests are quasi-static"), h("p", {class: "soft"},
    "Grade A: the strength is shown to about 0.5 % (tension and Brazilian tests: 1 %); B: to about 2 %; C: not shown. The estimated error follows from what the typical grain leaves unbalanced and from how fast the load rises, from 0.9 of the peak on; " +
    "after a repeat at a third of the rate, from the change of the strength. The two platens must agree, too. The other columns are shown, not judged; the mean R* counts from half of the peak on. R* is the sum of the unbalanced forces over the platen force; the median grain's R* leaves the few grains beside a crack out. " +
    "Damping is a numerical aid: compare what it dissipates with what fracture dissipates."));
  const percent = (v) => (v === null ? "\u2013" : show(100 * v, 2) + " %");
  const speedAtPeak = (t) => {
    const y = t.history;
    let at = -1;
    y.stress.forEach((s, i) => { if (s !== null && (at < 0 || Math.abs(s) > Math.abs(y.stress[at]))) at = i; });
    return at < 0 || y.speed[at] === null ? "\u2013" : show(y.speed[at], 2) + (t.numerics === "dynamic" ? " m/s" : " m/step");
  };
  const confirmed = data.tests.some((t) => t.change_at_third !== null), all = [...groupTests().values()].flat();
  const before = (i) => i > 0 && all[i].variant === all[i - 1].variant;
  const names = (t, i) => [data.variants ? td(before(i) ? "" : t.variant, false, "strong") : null, td(before(i) && titleOf(t) === titleOf(all[i - 1]) ? "" : titleOf(t), false, "kind"), td(String(t.seed), true)];
  const heads = () => [data.variants ? th("Variant") : null, th("Test"), th("Seed", true)];
  page.append(table("evidence",
    [...heads(), th("Strength", true), th("Grade"), th(["Estimated", h("br"), "error"], true), th(["nine of ten", h("br"), "within"], true, "twice the estimate: 59 of 64 measured errors were smaller"), th(["Platens", h("br"), "differ by"], true, "difference of the two reactions over their mean; mean from 0.9 of the peak to the peak"),
      th(["Energy", h("br"), "residual"], true), confirmed ? th(["Peak at a", h("br"), "third of the rate"], true) : null],
    all.map((t, i) => h("tr", {}, names(t, i), td(show(t.peak) + " MPa", true), h("td", {}, h("span", {class: "grade " + t.grade}, t.grade)), td(percent(t.error_estimate), true), td(percent(t.error_bound), true), td(percent(t.imbalance_mean), true),
      td(percent(t.energy_residual), true), confirmed ? td(t.change_at_third === null ? "\u2013" : percent(t.change_at_third), true) : null))));
  page.append(h("details", {}, h("summary", {}, "What else was measured near the strength"), table("evidence",
    [...heads(), th(["R* of the", h("br"), "median grain"], true, "times the number of grains; mean from 0.9 of the peak to the peak"), th(["Load growth per", h("br"), "travel time"], true, "growth of the platen displacement while a wave travels the height; mean from 0.9 of the peak to the peak"),
      th(["R*", h("br"), "mean"], true), th(["R* at", h("br"), "peak"], true), th(["Kinetic /", h("br"), "strain energy"], true), th(["Damping /", h("br"), "fracture"], true), th(["Platen speed", h("br"), "at peak"], true)],
    all.map((t, i) => h("tr", {}, names(t, i), td(show(t.residual_median, 2), true), td(percent(t.load_per_travel_time), true), td(show(t.residual_mean, 2), true), td(show(t.residual_at_peak, 2), true), td(show(t.kinetic_over_strain, 2), true), td(percent(t.damping_over_fracture), true), td(speedAtPeak(t), true))))));
  // the verdicts in words, each once
  const verdicts = new Map();
  for (const t of data.tests) {
    const key = t.grade + "|" + t.verdict;
    if (!verdicts.has(key)) verdicts.set(key, []);
    verdicts.get(key).push(t);
  }
  const list = h("details", {}, h("summary", {}, "The verdicts in words"));
  list.open = verdicts.size <= 4;
  page.append(list);
  const testsInWords = (tests) => [...new Set(tests.map(fullTitle))].map((title) => title + ", seed" + (tests.filter((t) => fullTitle(t) === title).length > 1 ? "s " : " ") + tests.filter((t) => fullTitle(t) === title).map((t) => t.seed).join(", ")).join("; ");
  for (const tests of [...verdicts.values()].sort((a, b) => (a[0].grade < b[0].grade ? -1 : 1))) {
    list.append(h("p", {class: "verdict"}, h("span", {class: "grade " + tests[0].grade}, tests[0].grade), " " + tests[0].verdict + " ", h("span", {class: "soft small"}, "(" + testsInWords(tests) + ")")));
  }
}

function writeProvenance() {
  const p = data.provenance, list = h("dl", {});
  const add = (name, value) => list.append(h("dt", {}, name), h("dd", {}, value));
  page.append(h("h2", {}, "Specimens and provenance"));
  if (data.specimens.length) {
    page.append(table("evidence", [th("Specimen"), th("Shape"), th(["Thickness", h("br"), "mm"], true), th("Grains", true), th("Contacts", true), th("Nodes", true), th("Triangles", true), th(["Merged", h("br"), "edges"], true), th("Grain size (mm)", false, "circles of the cells' areas: mean, smallest to largest; D50: half of the area is in smaller grains; in brackets the mean of the discs that were asked for"), th(["Width /", h("br"), "largest grain"], true)],
      data.specimens.map((s) => h("tr", {}, td("for " + s.for), td(s.shape.replace(" x ", " \u00d7 ")), td(show(s.thickness), true), ...["grains", "contacts", "nodes", "triangles", "merged_edges"].map((k) => td(s[k].toLocaleString("en"), true)), td(show(s.grain_mean) + ", " + show(s.grain_minimum) + " to " + show(s.grain_maximum) + "; D50 " + show(s.grain_D50) + " (" + show(s.disc_mean) + ")"), td(show(s.width_over_largest_grain), true)))));
    for (const warning of new Set(data.specimens.flatMap((s) => s.warnings))) page.append(h("p", {class: "notice"}, warning));
  }
  add("Program", "Feldspar " + p.version + ", commit " + p.commit);
  add("Started", p.started.replace("T", " ").replace("Z", " UTC"));
  add("Command", p.command_line);
  add("Machine", p.machine + "; " + plural(p.threads, "thread"));
  add("Compiler", p.compiler);
  add("Job file", data.job.file);
  add("Seeds", data.job.seeds.join(", "));
  page.append(list, h("details", {}, h("summary", {}, "The job with every default written out"), h("pre", {}, data.job.resolved)));
}

setTheme();
writeHeader();
writePackingBar();
if (data.variants) writeComparison();
else writeProperties();
writeTests();
writePattern();
if (!data.variants) writeEnvelope();
writeCrystals();
writeShearEnvelope();
writeEvidence();
writeProvenance();
writeContents();
followTheme();
