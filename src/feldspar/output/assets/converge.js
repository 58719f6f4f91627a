// The page of a convergence study: a verdict for each axis, changes against the job as it is, means with intervals.
"use strict";

const marks = {independent: "A", undecided: "B", depends: "C"}, words = {independent: "independent", undecided: "undecided", depends: "depends"};
const lineColors = ["va", "vb", "vc", "vd", "ve", "vf", "vg", "vh", "vi", "vj"];
function verdictMark(dependence) { return h("span", {class: "grade " + marks[dependence]}, words[dependence]); }
/** A verdict's words without the one that its mark says already. */
function restOf(verdict) { return pretty(verdict.words.replace(new RegExp("^(" + verdict.dependence + "|(not )?enough packings):? ?"), "")); }
function pretty(text) { return text.replaceAll("+- ", "\u00b1").replaceAll("sigma_1", "\u03c3\u2081"); }
function percentText(value, sign) { return value === null || value === undefined ? "\u2013" : (sign && value > 0 ? "+" : "") + show(value, Math.abs(value) < 10 ? 2 : 3) + " %"; }
function title(name) { return name.charAt(0).toUpperCase() + name.slice(1); }

function writeOverview() {
  page.append(h("p", {class: "verdict strong", style: "margin-top:18px"}, pretty(data.overall)));
  const rows = data.axes.map((axis) => [axis.name, axis.verdict]);
  rows.push(["packings", data.packings.verdict]);
  page.append(table("evidence", [th("Varied"), th("Answer"), th("In words")], rows.map(([name, verdict]) => h("tr", {}, td(title(name), false, "kind"),
    h("td", {}, name === "packings" ? h("span", {class: "grade " + marks[verdict.dependence]}, verdict.dependence === "independent" ? "enough" : "not enough") : verdictMark(verdict.dependence)), td(restOf(verdict))))));
  for (const remark of data.remarks) page.append(h("p", {class: "soft small"}, remark));
  page.append(h("p", {class: "soft small"}, pretty(data.method)));
}

/** Changes in per cent of all properties over the values of the axis, side by side around each value. */
function changeSeries(axis) {
  const count = axis.properties.length, series = [];
  axis.properties.forEach((p, k) => {
    const shift = count > 1 ? 0.36 * (k / (count - 1) - 0.5) : 0, others = p.values.map((v, i) => [v, i]).filter(([v]) => v.change && v.change.mean_percent !== null);
    series.push({label: p.symbol || p.name, x: others.map(([, i]) => i + shift), y: others.map(([v]) => v.change.mean_percent), low: others.map(([v]) => v.change.low_percent), high: others.map(([v]) => v.change.high_percent),
      color: lineColors[k % lineColors.length], mark: "dot", size: 3.6});
  });
  return series;
}

/** The range in which a change does not matter, as two lines. */
function limitSeries(axis) {
  const ends = [-0.5, axis.properties[0].values.length - 0.5];
  return [1, -1].map((sign) => ({label: "\u00b1" + data.within_percent + " %", x: ends, y: [sign * data.within_percent, sign * data.within_percent], color: "soft", width: 1, dash: true, quiet: sign < 0}));
}

function writeAxis(axis) {
  page.append(h("h2", {}, title(axis.name)), h("p", {}, verdictMark(axis.verdict.dependence), " ", restOf(axis.verdict)));
  if (!axis.properties.length) return;
  const labels = axis.properties[0].values.map((v) => v.label + (v.base ? " (job)" : ""));
  const box = card("Change against the job as it is, 95 % interval");
  page.append(h("div", {style: "margin:12px 0"}, box));
  new XYChart(box, {x: title(axis.name), y: "Change (%)", height: 270, xTicks: labels, xRange: [-0.5, labels.length - 0.5], series: [...limitSeries(axis), ...changeSeries(axis)]});
  const head = [th("Property"), th(title(axis.name)), th("Mean", true), th("95 % interval", true), th("n", true), th("Change", true), th("95 % interval", true), th("Verdict")];
  const rows = [];
  for (const p of axis.properties) {
    p.values.forEach((v, i) => rows.push(h("tr", {}, i ? td("") : td([p.symbol || p.label, unitText(p.unit)], false, "kind"), td(v.label + (v.base ? " (job)" : ""), false, "name"), td(show(v.mean, 4), true, "strong"), td(intervalText(v), true), td(String(v.n), true),
      td(v.base ? "" : percentText(v.change.mean_percent, true), true), td(v.base || v.change.low_percent === null ? "" : percentText(v.change.low_percent, true) + " \u2026 " + percentText(v.change.high_percent, true), true),
      i ? null : h("td", {rowspan: p.values.length, class: "small wide"}, verdictMark(p.verdict.dependence), " ", restOf(p.verdict)))));
  }
  page.append(table("evidence", head, rows));
  page.append(h("p", {class: "soft small"}, axis.same_packings ? "The packings are the same at all values: changes are formed on each packing." : "Every value has packings of its own: changes are differences of means, relative to the job's."));
}

function writePackings() {
  const list = data.packings.properties;
  page.append(h("h2", {}, "Number of packings"), h("p", {}, pretty(data.packings.verdict.words) + "."));
  const with_interval = list.filter((p) => p.subsamples.length);
  if (!with_interval.length) return;
  const box = card("Half of the 95 % interval of the mean, if only so many of the packings had been tested");
  page.append(h("div", {style: "margin:12px 0"}, box));
  const most = Math.max(...with_interval.map((p) => p.subsamples[p.subsamples.length - 1].n));
  new XYChart(box, {x: "Packings", y: "\u00b1 % of the mean", height: 270, xRange: [1.5, most + 0.5], xTicks: undefined, series: [
    ...with_interval.map((p, k) => ({label: p.symbol || p.name, x: p.subsamples.map((s) => s.n), y: p.subsamples.map((s) => s.half_width_percent), color: lineColors[k % lineColors.length], width: 1.8, mark: "dot", size: 3})),
    {label: "\u00b1" + data.within_percent + " %", x: [1.5, most + 0.5], y: [data.within_percent, data.within_percent], color: "soft", width: 1, dash: true}]});
  page.append(table("evidence", [th("Property"), th("Mean", true), th("95 % interval", true), th("Packings", true), th("Scatter", true), th("Means of subsets of two", true), th("Verdict")], list.map((p) => h("tr", {}, td([p.symbol || p.label, unitText(p.unit)], false, "kind"), td(show(p.mean, 4), true, "strong"), td(intervalText(p), true), td(String(p.n), true),
    td(p.deviation === null ? "\u2013" : percentText((100 * p.deviation) / Math.abs(p.mean)), true), td(p.subsamples.length ? percentText(p.subsamples[0].lowest_percent, true) + " \u2026 " + percentText(p.subsamples[0].highest_percent, true) : "\u2013", true), td(pretty(p.verdict.words))))));
}

setTheme();
pageHead("convergence", data.job.name, [plural(data.job.seeds.length, "packing"), plural(Object.values(data.grades).reduce((a, b) => a + b, 0), "test"), h("span", {}, "grades ", gradesText(data.grades)), data.provenance.started.slice(0, 10)]);
writeState(data.missing, data.failures);
writeOverview();
for (const axis of data.axes) writeAxis(axis);
writePackings();
writeSource(data.provenance, data.job);
writeContents();
followTheme();
