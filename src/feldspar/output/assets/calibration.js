// The page of a calibration: targets in units of their tolerances, unknowns within their ranges, sensitivities, the way there.
"use strict";

const targetColors = ["vb", "vc", "vd", "ve", "vg", "vf", "vh", "vj", "va", "vi"];
const farthestShown = 6;   // tolerances: what is farther stands as an arrow at the edge

function unitWord(unit) { return unit ? "\u00a0" + unit.replace("deg", "\u00b0") : ""; }
function valueText(value, unit, digits = 4) { return value === null ? "\u2013" : show(value, digits) + unitWord(unit); }
function rangeText(low, high, digits = 3) { return low === null || high === null ? "\u2013" : show(low, digits) + " \u2013 " + show(high, digits); }
function inTolerances(t, value) { return value === null ? null : (value - t.wanted) / t.tolerance; }
/** "+0.12", "0", "\u22127.1". */
function signed(value) {
  if (value === null) return "\u2013";
  const text = value.toFixed(Math.abs(value) < 9.95 ? 2 : 1);
  return Number(text) === 0 ? "0" : (value > 0 ? "+" : "") + text.replace("-", "\u2212");
}
function metMark(t) { return t.confirmed.mean === null ? gradeWord("B", "not confirmed") : t.met ? gradeWord("A", "met") : gradeWord("C", "not met"); }
function gradeWord(grade, word) { return h("span", {class: "grade " + grade}, word); }
/** Words of a list: "UCS, DTS and BTS". */
function listed(words) { return words.length < 2 ? words.join("") : words.slice(0, -1).join(", ") + " and " + words[words.length - 1]; }

function writeAnswer() {
  const open = data.targets.filter((t) => !t.met);
  const words = open.length ? (open.length === data.targets.length ? (open.length > 1 ? "No target is" : "The target is not") : (data.targets.length - open.length) + " of " + data.targets.length + " targets are") + " met on fresh packings" + (open.length < data.targets.length ? "; not met: " + listed(open.map((t) => t.name)) : "") + "."
    : (data.targets.length > 1 ? "All " + data.targets.length + " targets are" : "The target is") + " met on fresh packings.";
  page.append(h("p", {class: "verdict strong", style: "margin-top:18px"}, words));
  for (const t of open) if (t.missed) page.append(h("p", {class: "verdict"}, t.missed));
  const wide = data.targets.filter((t) => t.confirmed.low !== null && 0.5 * (t.confirmed.high - t.confirmed.low) > t.tolerance);
  if (wide.length) page.append(h("p", {class: "verdict"}, "The mean of " + listed(wide.map((t) => t.name)) + " is known less well than the tolerance asks (95 % interval on " + plural(data.confirm_seeds.length, "packing") + "): more confirm_seeds would tell."));
  page.append(h("p", {class: "verdict"}, h("a", {href: "calibrated.toml"}, "calibrated.toml"), " beside this page is the job with the best set, ready for ", h("code", {}, "feldspar run calibrated.toml"), "."));
}

/** A mark, and a bar for its interval, at `value` in tolerances; beyond the edge an arrow. */
function rowMarks(kind, value, low, high, edge) {
  if (value === null) return [];
  const at = (v) => 50 + (50 * Math.max(-edge, Math.min(edge, v))) / edge + "%", parts = [];
  if (low !== null && high !== null && low < edge && high > -edge) parts.push(h("i", {class: "span " + kind, style: "left:" + at(low) + ";right:calc(100% - " + at(high) + ")"}));
  if (Math.abs(value) > edge) parts.push(h("i", {class: "beyond " + kind + (value < 0 ? " left" : " right")}, (value < 0 ? "\u25c2 " : "") + show(value, 2) + (value > 0 ? " \u25b8" : "")));
  else parts.push(h("i", {class: "mark " + kind, style: "left:" + at(value)}));
  return parts;
}

function writeTargetChart() {
  const box = h("div", {class: "card", style: "margin:14px 0 18px"}, h("h4", {}, "Distance from what is wanted, in tolerances"));
  const ends = data.targets.flatMap((t) => [t.confirmed.mean, t.confirmed.low, t.confirmed.high, t.predicted].map((v) => inTolerances(t, v))).filter((v) => v !== null).map(Math.abs);
  const edge = Math.min(farthestShown, Math.max(1.5, 0.5 * Math.ceil(2.1 * Math.max(...ends))));
  const step = edge > 3 ? 2 : edge > 2 ? 1 : 0.5, ticks = [];
  for (let v = -Math.floor(edge / step) * step; v <= edge + 1e-9; v += step) ticks.push(v);
  const at = (v) => 50 + (50 * v) / edge + "%";
  const key = (kind, text) => h("span", {}, h("b", {class: kind}), text);
  box.append(h("div", {class: "legend targetkey"}, key("band", "within the tolerance"), key("predicted", "predicted"), key("confirmed", "confirmed on fresh packings"), "bars: 95 % intervals"));
  const rows = h("div", {class: "targetchart"});
  for (const t of data.targets) {
    const c = t.confirmed, p = inTolerances(t, t.predicted), [foreseenLow, foreseenHigh] = t.foreseen.map((v) => inTolerances(t, v));
    const plot = h("div", {class: "plot", title: t.name + "\nwanted " + valueText(t.wanted, t.unit) + " \u00b1 " + valueText(t.tolerance, t.unit, 3) + "\npredicted " + valueText(t.predicted, t.unit) + "\nconfirmed " + valueText(c.mean, t.unit)},
      h("i", {class: "band", style: "left:" + at(-1) + ";right:calc(100% - " + at(1) + ")"}), ticks.map((v) => h("i", {class: "line" + (v === 0 ? " zero" : ""), style: "left:" + at(v)})),
      rowMarks("predicted", p, foreseenLow, foreseenHigh, edge), rowMarks("confirmed", inTolerances(t, c.mean), inTolerances(t, c.low), inTolerances(t, c.high), edge));
    rows.append(h("div", {class: "name"}, t.name), plot);
  }
  rows.append(h("div", {}), h("div", {class: "ticks"}, ticks.map((v) => h("span", {style: "left:" + at(v)}, v === 0 ? "wanted" : (v > 0 ? "+" : "") + String(v).replace("-", "\u2212")))));
  box.append(rows);
  page.append(box);
}

function writeTargets() {
  page.append(h("h2", {}, "Targets"));
  writeTargetChart();
  const rows = data.targets.map((t) => h("tr", {}, h("td", {class: "kind", title: t.label}, t.name), td([valueText(t.wanted, ""), unitText(t.unit)], true, "strong"), td("\u00b1\u00a0" + valueText(t.tolerance, "", 3), true),
    td([valueText(t.predicted, ""), t.foreseen[0] === null ? "" : h("span", {class: "soft"}, " \u00b1\u00a0" + show(0.5 * (t.foreseen[1] - t.foreseen[0]), 2))], true), td(valueText(t.confirmed.mean, ""), true, "strong"), td(rangeText(t.confirmed.low, t.confirmed.high, 4), true), td(String(t.confirmed.n), true), td(gradesText(t.grades), true), td(signed(inTolerances(t, t.confirmed.mean)), true), h("td", {}, metMark(t)),
    td(t.lowest === null ? "the others are never met" : [rangeText(t.lowest, t.highest), unitText(t.unit)], true)));
  page.append(table("evidence", [th("Target"), th("Wanted", true), th("Tolerance", true), th("Predicted", true), th("Confirmed", true), th("95 % interval", true), th("Packings", true), th("A/B/C", true, "grades of the tests that confirm"), th(["Off, in", h("br"), "tolerances"], true), th(""), th(["Within reach while", h("br"), "the others are met"], true)], rows));
  page.append(h("p", {class: "soft small"}, "Predicted: by what was learned from packings " + seedsText(data.seeds) + ", with the 95 % interval of what the mean over the confirming packings was to show. A/B/C: grades of the tests that confirm; those of grade C, failed and unfinished ones are not in the mean. Confirmed: the mean over packings " + seedsText(data.confirm_seeds) + ", from which nothing was learned. A target is met when its confirmed mean lies within the tolerance. " +
    "Within reach: what the given ranges of the unknowns allow, by the prediction."));
}

/** "9/1/0", and what else there was. */
function gradesText(g) { return g.A + "/" + g.B + "/" + g.C + (g.unfinished ? ", " + g.unfinished + " unfinished" : "") + (g.failed ? ", " + g.failed + " failed" : ""); }

/** "1 \u2013 10" for seeds in a row, else each. */
function seedsText(seeds) {
  const row = seeds.length > 2 && seeds.every((seed, i) => i === 0 || seed === seeds[i - 1] + 1);
  return row ? seeds[0] + "\u2013" + seeds[seeds.length - 1] : seeds.join(", ");
}

function determinedWord(share) { return share === null ? "" : share >= 0.8 ? "well" : share >= 0.5 ? "partly" : "hardly"; }

/** A dotted key, which may go on in the next line after a dot. */
function keyCode(key) { return h("code", {}, key.split(".").flatMap((part, i) => (i ? [".", h("wbr"), part] : [part]))); }
function keyText(u) {
  const parts = [keyCode(u.key)];
  if (u.times) parts.push(" is this times ", keyCode(u.times));
  for (const [key, factor] of u.coupled) parts.push(h("br"), keyCode(key), " is " + show(factor) + " times that");
  return h("div", {class: "soft tiny"}, parts);
}

function writeUnknowns() {
  page.append(h("h2", {}, "Unknowns"));
  const share = (v) => 100 * Math.max(0, Math.min(1, v)) + "%";
  const rows = data.unknowns.map((u) => {
    const [low, best, high] = u.at;
    const bar = h("span", {class: "range unknown", title: "best " + valueText(u.best, u.unit) + (low === null ? "" : "\nas good " + rangeText(u.low, u.high) + unitWord(u.unit))}, h("i", {class: "track"}),
      low === null ? "" : h("i", {class: "bar", style: "left:" + share(low) + ";right:calc(100% - " + share(high) + ")"}), h("i", {class: "dot", style: "left:" + share(best)}));
    return h("tr", {}, h("td", {}, h("span", {class: "strong"}, u.name), keyText(u)), td([valueText(u.best, ""), unitText(u.unit)], true, "strong"),
      h("td", {class: "ruler"}, bar, h("span", {class: "ends tiny soft"}, h("span", {}, show(u.range[0])), h("span", {}, u.logarithmic ? "log" : ""), h("span", {}, show(u.range[1])))),
      td(low === null ? "\u2013" : [rangeText(u.low, u.high), unitText(u.unit)], true), td(u.determined === null ? "\u2013" : Math.round(100 * u.determined) + " %", true), td([determinedWord(u.determined), u.at_an_end ? h("div", {}, gradeWord("B", "at an end")) : ""]));
  });
  page.append(table("evidence unknowns", [th("Unknown"), th("Best", true), th("In the given range"), th("As good (90 %)", true), th("Determined", true), th("")], rows));
  page.append(h("p", {class: "soft small"}, "As good: the middle 90 % (5 to 95 %) of all sets that meet the targets as well as can be known; bar: the same within the given range, dot: the best set. " +
    "Determined: 0 % where any value of the range does as well, 100 % where a single one does. log: the range is divided by its logarithm."));
  if (data.unknowns.some((u) => u.at[0] !== null && (u.at[1] < u.at[0] || u.at[1] > u.at[2])) && data.targets.some((t) => !t.met))
    page.append(h("p", {class: "soft small"}, "Some values of the best set lie outside of what is as good: no set meets all targets, and then a little of one target weighs against a little of another."));
}

function writeSensitivity() {
  page.append(h("h2", {}, "What the targets hinge on"));
  const strength = (v) => Math.min(1, Math.abs(v)) * 0.55;   // of the colour: one to one is full
  const rows = data.targets.map((t, i) => h("tr", {}, h("td", {class: "kind", title: t.label}, t.name), data.sensitivity[i].map((v, j) => v === null ? h("td", {class: "number soft", title: "not looked at"}, "\u00b7")
    : h("td", {class: "number heat " + (v < 0 ? "falls" : "rises"), style: "--share:" + strength(v).toFixed(3), title: "1 % more " + data.unknowns[j].name + ": " + t.name + " " + (v < 0 ? "\u2212" : "+") + show(Math.abs(v), 2) + " %"}, signed(v)))));
  page.append(table("evidence sensitivity", [th("Target"), ...data.unknowns.map((u) => th(u.name, true, u.key))], rows));
  page.append(h("p", {class: "soft small"}, "By how many per cent a target changes when an unknown grows by one per cent, at the best set. A dot: not looked at, for elastic constants are found by E and \u03bd alone and the strengths at the constants so found."));
}

function writeFindings() {
  page.append(h("h2", {}, "Findings"));
  if (data.findings.length) page.append(h("ul", {class: "findings"}, data.findings.map((f) => h("li", {}, f.replaceAll("+- ", "\u00b1")))));
  else page.append(h("p", {}, "Every unknown is determined by the targets, none lies at an end of its range, and the targets can be had together."));
}

function fixed(value) { return value === null ? "\u2013" : value.toFixed(2); }

function writeWay() {
  if (!data.way.length) return;
  page.append(h("h2", {}, "The way there"));
  const box = card("The best set so far: its farthest target, as predicted, and the largest doubt"), steps = data.way.filter((w) => w.farthest !== null);
  page.append(h("div", {style: "margin:12px 0"}, box));
  const confirmed = data.targets.map((t) => [Math.abs(inTolerances(t, t.confirmed.mean)), t]).filter(([, t]) => t.confirmed.mean !== null).sort((a, b) => b[0] - a[0])[0];
  const searched = steps.some((w) => !w.elastic) ? steps.filter((w) => !w.elastic) : steps, names = [...new Set(steps.map((w) => w.target))], xEnd = 1.03 * data.runs;
  const series = [{label: "way", quiet: true, x: searched.map((w) => w.runs), y: searched.map((w) => w.farthest), color: "context", width: 1.6},
    {label: "one tolerance", x: [0, xEnd], y: [1, 1], color: "soft", width: 1, dash: true}];
  names.forEach((name) => {
    const own = steps.filter((w) => w.target === name), n = data.targets.findIndex((t) => t.name === name);
    series.push({label: name, x: own.map((w) => w.runs), y: own.map((w) => w.farthest), color: targetColors[n % targetColors.length], mark: "dot", size: 4});
  });
  series.push({label: "largest doubt (standard deviation)", x: searched.map((w) => w.runs), y: searched.map((w) => w.doubt), color: "accent", width: 1.6, mark: "square", size: 2.6});
  if (confirmed) series.push({label: "confirmed: " + confirmed[1].name, x: [data.runs], y: [confirmed[0]], color: "ink", mark: "diamond", size: 4.5});
  const top = Math.max(1.25, ...steps.map((w) => Math.max(w.farthest, w.doubt || 0)), confirmed ? confirmed[0] : 0);
  new XYChart(box, {x: "Runs used", y: "In tolerances", height: 280, xRange: [0, xEnd], yRange: [0, 1.08 * top], series});
  page.append(h("p", {class: "soft small"}, "A prediction may be as wanted long before it can be trusted: the doubt says how far it can. The way ends when the mean over the confirming packings will lie within the tolerance of each target with 95 %, or with the budget; then the set is confirmed."));
  const best = (w) => w.best.map((v, u) => td(w.elastic && !data.unknowns[u].elastic ? "" : show(v, 4), true));
  page.append(h("details", {}, h("summary", {}, "The best set each time"), table("evidence points", [th("Runs", true), th("Farthest"), th("off by", true), th("Most doubtful"), th("deviation", true), th("Least likely"), th("to be met", true), ...data.unknowns.map((u) => th([u.name, h("br"), u.unit.replace("deg", "\u00b0")], true))],
    data.way.map((w) => h("tr", {}, td(String(w.runs), true), td(w.target + (w.elastic ? ", before damage" : ""), false, "name"), td(fixed(w.farthest), true), td(w.doubtful, false, "name"), td(fixed(w.doubt), true), td(w.unlikely, false, "name"), td(Math.round(100 * w.probability) + " %", true), best(w))))));
}

setTheme();
const met = data.targets.filter((t) => t.met).length;
pageHead("calibration", data.name, [plural(data.targets.length, "target") + ", " + met + " met", plural(data.unknowns.length, "unknown"), data.runs + " of at most " + plural(data.budget, "run"), "confirmed on " + plural(data.confirm_seeds.length, "fresh packing"), data.provenance.started.slice(0, 10)]);
writeAnswer();
writeTargets();
writeUnknowns();
writeSensitivity();
writeFindings();
writeWay();
writeSource(data.provenance, null, [["Job file", data.job_file], ["Packings", "learned from seeds " + seedsText(data.seeds) + "; confirmed on seeds " + seedsText(data.confirm_seeds)]]);
if (data.text) page.append(h("details", {}, h("summary", {}, "The calibration's file: " + data.file), h("pre", {}, data.text)));
writeContents();
followTheme();
