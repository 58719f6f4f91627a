// What every page of Feldspar stands on: its data, the theme, tables, pickers and cards.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const page = document.getElementById("page");
const redraw = [];   // what must be drawn again when the theme changes

function setTheme(forced) {
  const dark = forced ? forced === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
}
function redrawAll() {
  for (const chart of [...charts]) {
    if (chart.host.isConnected) chart.rebuild();
    else charts.delete(chart);
  }
  for (const draw of redraw) draw();
}
/** Draws again when the reader changes the theme; on paper in light colours, at the width of a sheet, with everything unfolded. */
function followTheme() {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { setTheme(); redrawAll(); });
  let folded = [];
  addEventListener("beforeprint", () => {
    folded = [...document.querySelectorAll("details:not([open])")];
    for (const d of folded) d.open = true;
    printing = true;
    document.documentElement.dataset.print = "";
    setTheme("light");
    redrawAll();
    for (const box of document.querySelectorAll(".scroll")) {   // a table that is wider than the sheet becomes smaller
      const wide = box.firstElementChild;
      if (wide.offsetWidth > box.clientWidth) wide.style.zoom = String(box.clientWidth / (wide.offsetWidth + 1));
    }
  });
  addEventListener("afterprint", () => {
    for (const d of folded) d.open = false;
    for (const box of document.querySelectorAll(".scroll")) box.firstElementChild.style.zoom = "";
    printing = false;
    delete document.documentElement.dataset.print;
    setTheme();
    redrawAll();
  });
}

/** Links to the page's sections, where there are several: beneath its head, and beneath what is going on in a run under way. */
function writeContents() {
  page.querySelector("nav.contents")?.remove();
  const headings = [...page.querySelectorAll("h2")].filter((heading) => !heading.closest(".live"));
  if (headings.length < 3) return;
  headings.forEach((heading, n) => { heading.id ||= "part-" + (n + 1); });
  const list = h("nav", {class: "contents", "aria-label": "Contents"}, headings.map((heading) => h("a", {href: "#" + heading.id}, heading.textContent)));
  (page.querySelector(".live") || page.querySelector("header")).after(list);
}

function median(values) {
  const list = values.filter((v) => v !== null && Number.isFinite(v)).sort((a, b) => a - b);
  if (!list.length) return null;
  return list.length % 2 ? list[(list.length - 1) / 2] : (list[list.length / 2 - 1] + list[list.length / 2]) / 2;
}
function plural(count, word) { return count + " " + word + (count === 1 ? "" : "s"); }
/** A table; one that is wider than the page scrolls in its box, by keyboard too. */
function table(className, head, rows) {
  return h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Table"}, h("table", {class: className}, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows)));
}
function th(text, number, title) { return h("th", {class: number ? "number" : null, scope: "col", title}, text); }
function td(text, number, className) { return h("td", {class: ((number ? "number " : "") + (className || "")).trim() || null}, text); }

/** Buttons for one of several things. */
function picker(label, names, chosen, choose) {
  if (names.length < 2) return null;
  const buttons = names.map((name, i) => h("button", {type: "button", "aria-pressed": String(i === chosen), onclick: () => {
    buttons.forEach((b, k) => b.setAttribute("aria-pressed", String(k === i)));
    choose(i);
  }}, name));
  return h("div", {class: "pick"}, label, h("div", {class: "buttons", role: "group"}, buttons));
}
/** The same as a list to unfold, where buttons would fill more than a line. */
function chooser(label, names, choose) {
  if (names.join("").length < 90) return picker(label, names, 0, choose);
  const list = h("select", {"aria-label": label || "Choose", onchange: (e) => choose(Number(e.target.value))}, names.map((text, i) => h("option", {value: i}, text)));
  return h("div", {class: "pick"}, label, list);
}
function card(title) {
  const body = h("div", {class: "card"}, h("h4", {}, title));
  return body;
}

/** The page's head: what made it, its title, facts as chips. */
function pageHead(maker, title, facts) {
  page.append(h("header", {}, h("div", {class: "maker"}, "Feldspar \u00b7 " + maker), h("h1", {}, title), h("ul", {class: "facts"}, factChips(facts))));
}
function factChips(facts) { return facts.filter(Boolean).map((fact) => h("li", {}, fact)); }

/** "12.3 \u2013 14.1", or a dash where one packing gives no interval. */
function intervalText(row) { return row.low === null || row.low === undefined ? "\u2013" : show(row.low) + " \u2013 " + show(row.high); }
/** A unit as it is printed. */
function unitWords(unit) { return unit.replace("deg", "\u00b0").replace("MPa_sqrt_m", "MPa\u00a0m\u00bd").replace("J_m2", "J/m\u00b2").replace("GPa_m", "GPa/m"); }

function unitText(unit) { return unit ? h("span", {class: "unit"}, " " + unitWords(unit)) : ""; }
function gradeMark(grade) { return h("span", {class: "grade " + grade}, grade); }
/** "12 A, 1 C" from {A: 12, B: 0, C: 1}. */
function gradesText(grades) {
  const some = Object.entries(grades).filter(([, count]) => count > 0);
  return some.length ? h("span", {class: "marks"}, some.flatMap(([grade, count]) => [gradeMark(grade), " " + count + " "])) : "\u2013";
}
/** What is known of a test method, by its name in files. */
function methodOf(kind) { return data.methods[kind] || {title: kind, sign: 1, strength: "", on_envelope: false, confined: false, pressure: ""}; }
/** The name of the method that measures a strength: "UCS". */
function methodOfStrength(strength) { return Object.keys(data.methods).find((kind) => data.methods[kind].strength === strength); }
function kindText(test, sigma3) {
  return methodOf(test).title + (methodOf(test).pressure && sigma3 !== null ? " at " + Number(sigma3.toPrecision(4)) + " MPa" : "");
}

/** Says that runs are missing, and lists those that failed with their reasons. */
function writeState(missing, failures, host = page) {
  if (missing) host.append(h("p", {class: "notice"}, plural(missing, "run") + (missing === 1 ? " is" : " are") + " still to do. The page holds those that are done; the same command goes on."));
  if (!failures.length) return;
  host.append(h("details", {open: failures.length <= 5}, h("summary", {}, plural(failures.length, "run") + " failed"),
    table("evidence", [failures.some((f) => f.point) ? th("Point") : null, th("Test"), th("Seed", true), th("Reason")],
      failures.map((f) => h("tr", {}, failures.some((g) => g.point) ? td(f.point) : null, td(kindText(f.test, f.sigma3_MPa), false, "kind"), td(String(f.seed), true), td(f.reason))))));
}

/** @param more  further names and values */
function writeSource(p, job, more = [], host = page) {
  const list = h("dl", {}), add = (name, value) => list.append(h("dt", {}, name), h("dd", {}, value));
  host.append(h("h2", {}, "Provenance"), list);
  add("Program", "Feldspar " + p.version + ", commit " + p.commit);
  if (p.command_line) add("Command", p.command_line);
  if (p.started) add("Written", p.started.replace("T", " ").replace("Z", " UTC"));
  if (p.machine) add("Machine", p.machine + "; " + plural(p.threads, "thread"));
  if (job) { add("Job file", job.file); add("Packings", "seeds " + job.seeds.join(", ")); }
  for (const [name, value] of more) add(name, value);
}
