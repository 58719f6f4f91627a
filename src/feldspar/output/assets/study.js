// The page of a study: points as a table, any property over any axis as a chart. While the study runs, the live view gives it newer data.
"use strict";

const lineColors = ["va", "vb", "vc", "vd", "ve", "vf", "vg", "vh", "vi", "vj"];
const mostLines = 10;   // in one chart: more cannot be told apart

/** The different values of an axis, in the study's order; numeric ones by size. */
function valuesOf(axis) {
  const found = new Map();
  for (const p of data.points) if (!found.has(p.labels[axis])) found.set(p.labels[axis], p.numbers[axis]);
  const values = [...found].map(([label, number]) => ({label, number}));
  return numeric(axis) ? values.sort((a, b) => a.number - b.number) : values;
}
function numeric(axis) { return data.points.every((p) => p.numbers[axis] !== null) && new Set(data.points.map((p) => p.numbers[axis])).size === new Set(data.points.map((p) => p.labels[axis])).size; }

function select(label, names, chosen, choose) {
  return h("label", {class: "pick"}, label, h("select", {"aria-label": label, onchange: (e) => choose(Number(e.target.value))}, names.map((name, i) => h("option", {value: i, selected: i === chosen}, name))));
}
function propertyName(p) { return p.label + (p.symbol && p.symbol !== p.label ? " (" + p.symbol + ")" : ""); }

const state = {property: null, axis: null, fixed: []};   // name of a property; fixed[a]: number of the value of axis a, or -1 for a line each
/** Place of the chosen property. Until one is chosen: the strength in compression, if there is one yet. */
function propertyPlace() {
  const place = (name) => data.properties.findIndex((p) => p.name === name);
  return Math.max(0, place(state.property) >= 0 ? place(state.property) : place("UCS_MPa"));
}

/** Points that the fixed values leave. */
function chosenPoints() { return data.points.filter((p) => data.axes.every((_, a) => a === state.axis || state.fixed[a] < 0 || p.labels[a] === valuesOf(a)[state.fixed[a]].label)); }

/** One line for each combination of the axes that are not fixed. */
function linesOf() {
  const lines = new Map();
  for (const p of chosenPoints()) {
    const key = data.axes.map((_, a) => a).filter((a) => a !== state.axis && state.fixed[a] < 0).map((a) => (/[a-z]/i.test(p.labels[a]) ? p.labels[a] : data.axes[a] + " " + p.labels[a])).join(", ");
    if (!lines.has(key)) lines.set(key, []);
    lines.get(key).push(p);
  }
  return [...lines];
}

function seriesOf(lines) {
  const words = !numeric(state.axis), values = valuesOf(state.axis), order = values.map((v) => v.label), shown = lines.slice(0, mostLines);
  const chosen = propertyPlace(), numbers = values.map((v) => v.number), step = 0.5 / Math.max(shown.length, 4);   // of words: lines stand side by side
  const series = shown.map(([label, points], k) => {
    const place = (p) => (words ? order.indexOf(p.labels[state.axis]) + step * (k - (shown.length - 1) / 2) : p.numbers[state.axis]);
    const own = points.filter((p) => p.cells[chosen] && p.cells[chosen].mean !== null).sort((a, b) => place(a) - place(b)), cells = own.map((p) => p.cells[chosen]);
    return {label: label || propertyName(data.properties[chosen]), x: own.map(place), y: cells.map((c) => c.mean), low: cells.map((c) => c.low), high: cells.map((c) => c.high), color: lineColors[k % lineColors.length],
      width: words ? 0 : 1.7, mark: "dot", size: 3.6};
  });
  const lab = data.laboratory[data.properties[chosen].name];
  if (lab !== undefined) {
    const ends = words ? [-0.5, order.length - 0.5] : extent([numbers]);
    series.push({label: "laboratory", x: ends, y: [lab, lab], color: "soft", width: 1.4, dash: true});
  }
  return series;
}

/** From the least to the largest interval end with a margin; zero is in sight only if it is near. */
function rangeOf(series) {
  const [low, high] = extent(series.flatMap((s) => [s.y, s.low || [], s.high || []])), span = high - low || Math.abs(high) || 1;
  return [low > 0 && low < 0.6 * span ? 0 : low - 0.08 * span, high < 0 && -high < 0.6 * span ? 0 : high + 0.08 * span];
}

/** @returns what draws the chart again when the data are newer; it shows nothing while no property is known. */
function writeChart() {
  const host = h("section", {}), controls = h("div", {class: "pick"}), box = h("div", {class: "card"}), note = h("p", {class: "soft small"});
  page.append(host);
  let chart = null, offered = "";
  const fill = () => {
    const others = data.axes.map((_, a) => a).filter((a) => a !== state.axis && valuesOf(a).length > 1), names = data.properties.map((p) => p.name), chosen = propertyPlace();
    offered = names.join();
    controls.replaceChildren(select("Property", data.properties.map(propertyName), chosen, (i) => { state.property = names[i]; fill(); }));
    if (data.axes.length > 1) controls.append(select("over", data.axes, state.axis, (i) => { state.axis = i; fitFixed(); fill(); }));
    for (const a of others) controls.append(select(data.axes[a], ["a line each", ...valuesOf(a).map((v) => v.label)], state.fixed[a] + 1, (i) => { state.fixed[a] = i - 1; fill(); }));
    draw();
  };
  const draw = () => {
    const lines = linesOf(), series = seriesOf(lines), words = !numeric(state.axis), values = valuesOf(state.axis), quantity = data.properties[propertyPlace()];
    const [from, to] = extent([values.map((v) => v.number)]), margin = 0.04 * (to - from || Math.abs(to) || 1);
    const options = {x: data.axes[state.axis] + (unitOf(state.axis) ? " (" + unitOf(state.axis) + ")" : ""), y: quantity.symbol + (quantity.unit ? " (" + quantity.unit.replace("deg", "\u00b0") + ")" : ""), height: 400,
      xTicks: words ? values.map((v) => v.label) : undefined, xRange: words ? [-0.5, values.length - 0.5] : [from >= 0 && from < 0.35 * to ? 0 : from - margin, to + margin], yRange: rangeOf(series), series};
    if (chart) { chart.options = options; chart.set(series); }
    else chart = new XYChart(box, options);
    note.textContent = "Mean over the packings with its 95 % interval." + (lines.length > mostLines ? " The first " + mostLines + " of " + lines.length + " lines are drawn: fix an axis to see the others." : "");
  };
  const renew = () => {
    if (!data.axes.length || !data.properties.length) return;
    if (!chart) {
      host.append(h("h2", {}, "Over an axis"), controls, box, note);
      state.axis = Math.max(0, data.axes.findIndex((_, a) => numeric(a) && valuesOf(a).length > 1));
      fitFixed();
    }
    if (data.properties.map((p) => p.name).join() === offered) draw();   // a list that is unfolded stays so
    else fill();
  };
  renew();
  return renew;
}

/** Fixes the longest other axes at their first value until few enough lines are left. */
function fitFixed() {
  state.fixed = data.axes.map(() => -1);
  const others = data.axes.map((_, a) => a).filter((a) => a !== state.axis).sort((a, b) => valuesOf(b).length - valuesOf(a).length);
  for (const a of others) {
    if (linesOf().length <= mostLines) return;
    state.fixed[a] = 0;
  }
}

/** The unit of an axis whose labels all are a number and the same unit. */
function unitOf(axis) {
  const units = new Set(data.points.map((p) => (p.labels[axis].match(/^[-+0-9.eE]+\s+(.*)$/) || ["", ""])[1]));
  return units.size === 1 ? [...units][0] : "";
}

const main = ["E_GPa", "nu", "UCS_MPa", "DTS_MPa", "BTS_MPa", "UCS_over_DTS", "cohesion_MPa", "friction_angle_deg", "hoek_brown_mi"];

/** @returns what writes the table again when the data are newer */
function writeTable() {
  const box = h("div", {}), all = h("input", {type: "checkbox", onchange: () => fill()}), find = h("input", {type: "search", placeholder: "words of a point", "aria-label": "Only points with these words", oninput: () => fill()});
  const count = h("span", {}), details = h("label", {class: "pick"}, all, count);
  page.append(h("section", {}, h("h2", {}, "Points"), h("div", {class: "pick"}, data.points.length > 12 ? h("label", {class: "pick"}, "Show", find) : "", details), box));
  const fill = () => {
    const shown = data.properties.map((p) => main.includes(p.name)), aside = box.querySelector(".scroll")?.scrollLeft || 0;
    if (!shown.some(Boolean)) shown.fill(true, 0, 6);
    details.hidden = data.properties.length === shown.filter(Boolean).length;
    count.textContent = "all " + data.properties.length + " properties";
    const columns = data.properties.map((p, i) => [p, i]).filter(([, i]) => shown[i] || all.checked), wanted = find.value.toLowerCase().split(/\s+/).filter(Boolean);
    const points = data.points.filter((p) => { const text = p.labels.join(" ").toLowerCase(); return wanted.every((word) => text.includes(word)); });
    const open = data.points.some((p) => p.failed || p.missing);
    box.replaceChildren(table("evidence points", [...(data.axes.length ? data.axes.map((a) => th(a)) : [th("Point")]), ...columns.map(([p]) => th([p.symbol || p.name, h("br"), p.unit.replace("deg", "\u00b0")], true, p.label)), th("Runs", true), open ? th("Open", true) : null, th("Grades")],
      points.map((p, r) => h("tr", {}, data.axes.length ? p.labels.map((label, a) => td(r && points[r - 1].labels.slice(0, a + 1).join("|") === p.labels.slice(0, a + 1).join("|") ? h("span", {class: "soft"}, label) : label, false, "kind")) : td("the job"),
        columns.map(([, i]) => cellOf(p.cells[i])), td(String(p.done), true), open ? td([p.failed ? p.failed + " failed " : "", p.missing ? p.missing + " to do" : ""].join(""), true) : null, h("td", {}, gradesText(p.grades))))),
      h("p", {class: "soft small"}, "Mean over the packings and half of its 95 % interval; in brackets the packings where they are fewer than three. Point at a value to see each packing's."));
    box.querySelector(".scroll").scrollLeft = aside;
  };
  fill();
  return fill;
}

function cellOf(cell) {
  if (!cell) return td("", true);
  const half = cell.low === null ? null : 0.5 * (cell.high - cell.low);
  const each = cell.seeds.map((seed, i) => "seed " + seed + ": " + show(cell.values[i], 4)).join("\n");
  return h("td", {class: "number", title: each}, show(cell.mean, 3), half === null ? "" : h("span", {class: "soft"}, " \u00b1\u00a0" + show(half, 2)), cell.n < 3 ? h("span", {class: "soft"}, " (" + cell.n + ")") : "");
}

/** What is done, what is missing and what failed. */
function facts() {
  return factChips([plural(data.points.length, "point"), plural(data.points.reduce((n, p) => n + p.done, 0), "run") + " done", data.axes.length ? plural(data.axes.length, "axis").replace("axiss", "axes") : null, data.written.at.slice(0, 10)]);
}
function writeUnfinished(host) {
  const folded = host.querySelector("details:not([open])") !== null;
  host.replaceChildren();
  writeState(data.points.reduce((n, p) => n + p.missing, 0), data.failures, host);
  if (folded && host.querySelector("details")) host.querySelector("details").open = false;
}
function writeWritten(host) {
  host.replaceChildren();
  writeSource({version: data.written.version, commit: data.written.commit, started: data.written.at}, null, [], host);
}

setTheme();
pageHead("study", data.title, []);
page.append(h("p", {class: "soft small", style: "margin-top:16px"}, "Signs: " + data.signs + "."));
const unfinished = h("section", {class: "unfinished"});
page.append(unfinished);
const parts = [() => page.querySelector("header .facts").replaceChildren(...facts()), () => writeUnfinished(unfinished), writeChart(), writeTable()];
parts[0]();
parts[1]();
const written = h("section", {});
page.append(written);
writeWritten(written);
if (data.text) page.append(h("details", {}, h("summary", {}, "The study's file" + (data.file ? ": " + data.file : "")), h("pre", {}, data.text)));
writeContents();
followTheme();

/** The page with newer data of the same study; what the reader has chosen stays. */
window.renewPage = (newer) => {
  Object.assign(data, newer);
  for (const renew of parts) renew();
  writeWritten(written);
  writeContents();
};
