// The page of a strength envelope: strengths and curves in the plane of principal stresses, Mohr circles, constants with intervals.
"use strict";

/** Points of a curve where it is defined: {x, y}. */
function curvePoints(from, to, f, count = 120) {
  const x = [], y = [];
  for (let i = 0; i <= count; ++i) {
    const s = from + ((to - from) * i) / count, v = f(s);
    if (Number.isFinite(v)) { x.push(s); y.push(v); }
  }
  return {x, y};
}
function parabola(mi, sigmaci) { return (s) => s + sigmaci * Math.sqrt((mi * s) / sigmaci + 1); }
function reach(envelope) {
  const confined = (data.laboratory.confined || []).map((c) => c[0]);
  return Math.max(1, ...envelope.tests.map((t) => t.sigma3_MPa || 0), ...confined) * 1.08;
}

/** The laboratory's own line and parabola, if it has given their constants. */
function laboratoryCurves(to) {
  const lab = data.laboratory, series = [];
  if (lab.cohesion_MPa && lab.friction_angle_deg !== undefined) {
    const sine = Math.sin((lab.friction_angle_deg * Math.PI) / 180), N = (1 + sine) / (1 - sine), c = 2 * lab.cohesion_MPa * Math.sqrt(N);
    series.push({label: "laboratory, Mohr-Coulomb", ...curvePoints(0, to, (s) => c + N * s, 1), color: "vd", width: 1.6, dash: true});
  }
  if (lab.hoek_brown_mi && lab.UCS_MPa) series.push({label: "laboratory, Hoek-Brown", ...curvePoints(0, to, parabola(lab.hoek_brown_mi, lab.UCS_MPa)), color: "ve", width: 1.6, dash: true});
  return series;
}

function laboratoryPoints() {
  const lab = data.laboratory, x = [], y = [];
  if (lab.UCS_MPa) { x.push(0); y.push(lab.UCS_MPa); }
  if (lab.DTS_MPa) { x.push(-lab.DTS_MPa); y.push(0); }
  for (const [s3, s1] of lab.confined || []) { x.push(s3); y.push(s1); }
  const series = [];
  if (x.length) series.push({label: "laboratory", x, y, color: "vd", mark: "diamond", size: 4});
  if (lab.BTS_MPa) series.push({label: "laboratory, Brazilian", x: [-lab.BTS_MPa], y: [3 * lab.BTS_MPa], color: "vd", mark: "diamond", size: 3.2, key: false});
  return series;
}

function envelopeSeries(envelope) {
  const joint = envelope.joint, to = reach(envelope), series = [];
  const measured = envelope.tests.filter((t) => t.peak_reached && t.sigma1_MPa !== null);
  const tests = (label, kinds, color, mark, extra) => {
    const own = measured.filter((t) => kinds.includes(t.test));
    if (own.length) series.push({label, x: own.map((t) => t.sigma3_MPa), y: own.map((t) => t.sigma1_MPa), color, mark, size: 3, ...extra});
  };
  if (joint.mohr_coulomb_N) {
    const line = (s) => joint.UCS_fitted_MPa + joint.mohr_coulomb_N * s, least = -joint.mohr_coulomb_tension_MPa;
    series.push({label: "Mohr-Coulomb line", ...curvePoints(0, to, line, 1), color: "tensile", width: 2});
    series.push({label: "Mohr-Coulomb, beyond the tests", ...curvePoints(Math.max(least, -0.35 * to - 8), 0, line, 1), color: "tensile", width: 1.2, dash: true, quiet: true});
  }
  if (joint.hoek_brown_UCS_MPa && joint.hoek_brown_mi !== null) {
    const f = parabola(joint.hoek_brown_mi, joint.hoek_brown_UCS_MPa), end = -joint.hoek_brown_tension_MPa;
    series.push({label: "Hoek-Brown parabola", ...curvePoints(envelope.with_tension ? end : 0, to, f), color: "shear", width: 2});
    if (!envelope.with_tension) series.push({label: "Hoek-Brown, beyond the tests", ...curvePoints(end, 0, f), color: "shear", width: 1.2, dash: true, quiet: true});
  }
  series.push(...laboratoryCurves(to));
  tests("tests, each packing", Object.keys(data.methods).filter((kind) => methodOf(kind).on_envelope), "context", "dot");
  tests("direct tension", [methodOfStrength("DTS")], "va", "square", {size: 2.6});
  tests("Brazilian, at the disc's centre", [methodOfStrength("BTS")], "va", "ring", {size: 3});
  const mean = envelope.strengths;
  series.push({label: "mean, 95 % interval", x: mean.map((s) => s.sigma3_MPa), y: mean.map((s) => s.mean), low: mean.map((s) => s.low), high: mean.map((s) => s.high), color: "ink", mark: "dot", size: 4});
  return series.concat(laboratoryPoints());
}

/** Half circles of the mean strengths, and the line that should touch them. */
function mohrSeries(envelope) {
  const series = [], joint = envelope.joint, highest = 1.15 * Math.max(...envelope.strengths.map((s) => 0.5 * (s.mean - s.sigma3_MPa)));
  /** A line of slope and intercept from the stress `from` until it leaves the circles behind. */
  const straight = (from, cohesion, slope) => { const to = (highest - cohesion) / (slope || 1); return {x: [from, to], y: [cohesion + slope * from, highest]}; };
  const circle = (s3, s1, label, color, first) => {
    const x = [], y = [], middle = 0.5 * (s1 + s3), radius = 0.5 * (s1 - s3);
    for (let i = 0; i <= 90; ++i) { x.push(middle - radius * Math.cos((Math.PI * i) / 90)); y.push(radius * Math.sin((Math.PI * i) / 90)); }
    series.push({label, x, y, color, width: 1.4, key: first});
  };
  envelope.strengths.forEach((s, i) => circle(s.sigma3_MPa, s.mean, i ? "\u03c3\u2083 = " + show(s.sigma3_MPa) + " MPa" : "mean strengths", "ink", i === 0));
  const tension = envelope.measured.find((m) => m.name === "DTS_MPa");
  if (tension && tension.mean) circle(-tension.mean, 0, "direct tension", "va", false);
  const last = envelope.strengths[envelope.strengths.length - 1];
  if (joint.cohesion_MPa && joint.friction_angle_deg !== null && last) {
    const slope = Math.tan((joint.friction_angle_deg * Math.PI) / 180);
    series.push({label: "\u03c4 = c + \u03c3 tan \u03c6", ...straight(Math.max(-joint.cohesion_MPa / (slope || 1), -0.1 * last.mean), joint.cohesion_MPa, slope), color: "tensile", width: 2});
  }
  const lab = data.laboratory;
  if (lab.cohesion_MPa && lab.friction_angle_deg !== undefined && last) {
    series.push({label: "laboratory", ...straight(0, lab.cohesion_MPa, Math.tan((lab.friction_angle_deg * Math.PI) / 180)), color: "vd", width: 1.6, dash: true});
  }
  return series;
}

function deviation(value, lab) {
  if (lab === undefined || lab === null || !lab || value === null) return "";
  const off = 100 * (value / lab - 1);
  return (off > 0 ? "+" : "") + off.toFixed(Math.abs(off) < 9.95 ? 1 : 0).replace("-", "\u2212") + " %";
}

function writeConstants(host, envelope) {
  const rows = [...envelope.measured.map((m) => ({...m, joint: null, measured: true})), ...envelope.constants];
  const lab = data.laboratory, compared = rows.some((r) => lab[r.name] !== undefined);
  host.append(h("h3", {}, "Constants"), table("", [th("Quantity"), th("", true), th("Mean", true), th("95 % interval", true), th("Packings", true), th("Joint fit", true), compared ? th("Laboratory", true) : null, compared ? th("Difference", true) : null],
    rows.map((r) => h("tr", {}, td(r.label + (r.measured ? ", measured" : "")), td(r.symbol, true, "unit"), td([show(r.mean), unitText(r.unit)], true, "strong"), td(intervalText(r), true), td(String(r.n), true), td(r.measured ? "" : show(r.joint), true),
      compared ? td(lab[r.name] === undefined ? "" : show(lab[r.name]), true) : null, compared ? td(deviation(r.mean, lab[r.name]), true) : null))));
  host.append(h("p", {class: "soft small", style: "margin-top:8px"}, "UCS, measured and fitted, and the tensile strengths, measured and as the curves go on, stand in one table: a curve fitted to compression is not a tension cut-off."));
}

function writeStrengths(host, envelope) {
  const joint = envelope.joint, off = (s, v) => (v === null || s.mean === null ? "\u2013" : (v - s.mean > 0 ? "+" : "") + show(v - s.mean, 2));
  host.append(h("h3", {}, "Strengths and residuals"), table("evidence", [th("\u03c3\u2083 (MPa)", true), th("\u03c3\u2081 (MPa)", true), th("95 % interval", true), th("Packings", true), th("Line", true), th("off by", true), th("Parabola", true), th("off by", true)],
    envelope.strengths.map((s) => h("tr", {}, td(show(s.sigma3_MPa), true), td(show(s.mean, 4), true, "strong"), td(intervalText(s), true), td(String(s.n), true), td(show(s.mohr_coulomb_MPa, 4), true), td(off(s, s.mohr_coulomb_MPa), true), td(show(s.hoek_brown_MPa, 4), true), td(off(s, s.hoek_brown_MPa), true)))));
  const R2 = (v) => (v === null ? "\u2013" : v.toFixed(4));
  host.append(h("p", {class: "small"}, "Joint fit, all strengths together: line rms " + show(joint.mohr_coulomb_rms_MPa) + " MPa, R\u00b2 " + R2(joint.mohr_coulomb_R2) + "; parabola rms " + show(joint.hoek_brown_rms_MPa) + " MPa, R\u00b2 " + R2(joint.hoek_brown_R2) + "."));
}

function writePackings(host, envelope) {
  if (!envelope.packings.length) return;
  const columns = [["c MPa", "cohesion_MPa"], ["\u03c6 \u00b0", "friction_angle_deg"], ["N", "mohr_coulomb_N"], ["UCS fitted MPa", "UCS_fitted_MPa"], ["rms MPa", "mohr_coulomb_rms_MPa"], ["mi", "hoek_brown_mi"], ["\u03c3ci MPa", "hoek_brown_UCS_MPa"], ["\u03c3t H-B MPa", "hoek_brown_tension_MPa"], ["rms MPa", "hoek_brown_rms_MPa"]];
  host.append(h("details", {}, h("summary", {}, "The fits of each packing"), table("evidence", [th("Seed", true), ...columns.map(([label]) => th(label, true))],
    envelope.packings.map((p) => h("tr", {}, td(String(p.seed), true), columns.map(([, key]) => td(show(p[key]), true)))))));
}

function writeTests(host, envelope) {
  const kinds = Object.keys(data.methods), order = [...kinds.filter((kind) => methodOf(kind).on_envelope), ...kinds.filter((kind) => !methodOf(kind).on_envelope)];
  const tests = [...envelope.tests].sort((a, b) => order.indexOf(a.test) - order.indexOf(b.test) || a.sigma3_MPa * methodOf(a.test).confined - b.sigma3_MPa * methodOf(b.test).confined || a.seed - b.seed);
  const body = table("evidence", [th("Test"), th("Seed", true), th("Strength", true), th("Grade"), th("Verdict")], tests.map((t, i) => {
    const kind = kindText(t.test, t.sigma3_MPa), before = i ? kindText(tests[i - 1].test, tests[i - 1].sigma3_MPa) : "";
    return h("tr", {}, td(kind === before ? "" : kind, false, "kind"), td(String(t.seed), true), td((t.peak_reached ? "" : "> ") + show(t.strength_MPa, 4) + " MPa", true), h("td", {}, gradeMark(t.grade)), td(t.verdict, false, "small"));
  }));
  const open = tests.filter((t) => !t.peak_reached).length;
  host.append(h("details", {}, h("summary", {}, ["The tests one by one: ", gradesText(envelope.grades)]), body,
    h("p", {class: "soft small"}, "Grade A: the strength is shown to about 0.5 %; B: to about 2 %; C: not shown. " + (open ? "> : the peak was not reached; such a test is in no fit." : ""))));
}

function writeEnvelope(host, envelope) {
  host.replaceChildren();
  if (!envelope.strengths.length) { host.append(h("p", {class: "soft"}, "No compression test has reached its peak yet.")); writeTests(host, envelope); return; }
  host.append(h("p", {class: "verdict strong"}, envelope.verdict));
  const first = card("Principal stresses at failure"), second = card("Mohr circles of the mean strengths");
  host.append(h("div", {style: "margin-top:14px"}, first));
  new XYChart(first, {x: "Minor principal stress \u03c3\u2083 (MPa, compression positive)", y: "Major principal stress \u03c3\u2081 (MPa)", height: 440, series: envelopeSeries(envelope)});
  host.append(h("div", {style: "margin-top:18px"}, second));
  new XYChart(second, {x: "Normal stress \u03c3 (MPa, compression positive)", y: "Shear stress \u03c4 (MPa)", equal: true, height: 200, series: mohrSeries(envelope)});
  writeConstants(host, envelope);
  writeStrengths(host, envelope);
  writePackings(host, envelope);
  writeTests(host, envelope);
  host.append(h("p", {class: "soft small", style: "margin-top:14px"}, envelope.method),
    h("p", {class: "soft small"}, "Mohr-Coulomb: \u03c3\u2081 = 2c\u221aN + N\u03c3\u2083 with N = (1 + sin \u03c6)/(1 \u2212 sin \u03c6). Hoek-Brown, intact rock: \u03c3\u2081 = \u03c3\u2083 + \u03c3ci (mi \u03c3\u2083/\u03c3ci + 1)^\u00bd; \u03c3ci here is the envelope's uniaxial strength, not crack initiation. Dashed: beyond the fitted tests. " +
      "The Brazilian test is drawn at the stresses of an elastic disc's centre, (\u2212BTS, 3 BTS)."));
}

setTheme();
pageHead("strength envelope", data.job.name, [plural(data.job.seeds.length, "packing"), plural(data.envelopes.reduce((n, e) => n + e.tests.length, 0), "test"), data.envelopes.length > 1 ? plural(data.envelopes.length, "variant") : null, data.provenance.started.slice(0, 10)]);
page.append(h("p", {class: "soft small", style: "margin-top:16px"}, "Signs: " + data.signs + "."));
writeState(data.missing, data.failures);
{
  const host = h("div", {}), open = (i) => writeEnvelope(host, data.envelopes[i]);
  page.append(chooser("Variant", data.envelopes.map((e) => e.variant), open) || "", host);
  open(0);
}
writeSource(data.provenance, data.job);
writeContents();
followTheme();
