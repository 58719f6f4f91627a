// The page of closed forms: what was checked, what was expected, what was found.
"use strict";

function verdictMark(within) { return h("span", {class: "grade " + (within ? "A" : "C")}, within ? "within" : "outside"); }
function valueText(value, unit) { return [show(value, 5), value === null ? "" : unitText(unit)]; }
function errorText(check, error) { return error === null ? "\u2013" : check.bound_is_relative ? show(100 * error, 2) + " %" : [show(error, 2), unitText(check.unit)]; }
function boundText(check) { return check.bound_is_relative ? show(100 * check.bound, 2) + " %" : [show(check.bound, 2), unitText(check.unit)]; }

function checkRows(check) {
  const values = check.values.length ? check.values : [{case: "", expected: null, found: null, error: null, within: false}];
  return values.map((v, i) => h("tr", {},
    i ? null : h("td", {rowspan: values.length, class: "wide"}, h("div", {}, check.sentence), check.formula ? h("code", {class: "small"}, check.formula) : null,
      h("div", {class: "soft small"}, [check.source, check.name].filter(Boolean).join(" \u00b7 ")), check.failure ? h("p", {class: "notice"}, "Failed: " + check.failure) : null),
    td(v.case), td(valueText(v.expected, check.unit), true), td(valueText(v.found, check.unit), true, "strong"), td(errorText(check, v.error), true),
    i ? null : h("td", {rowspan: values.length, class: "number", title: check.reason}, boundText(check)), h("td", {}, verdictMark(v.within))));
}

function writeTopic(topic) {
  page.append(h("h2", {}, topic.title));
  page.append(table("evidence", [th("What is checked"), th("Case"), th("Expected", true), th("Found", true), th("Error", true), th("Bound", true), th("Verdict")], topic.checks.flatMap(checkRows)));
}

setTheme();
const count = data.topics.reduce((sum, topic) => sum + topic.checks.length, 0);
pageHead("closed forms", data.title, [plural(count, "check"), "version " + data.provenance.version, "instructions " + data.instructions]);
page.append(h("p", {class: "verdict strong", style: "margin-top:18px"}, data.tally + "."));
page.append(h("p", {class: "soft small"}, "An error is relative to the expected value where its bound is in per cent, else it is the difference. The pointer over a bound shows its reason. Equations such as (C9) are those of the documentation."));
const outside = data.topics.flatMap((topic) => topic.checks.filter((check) => !check.within));
if (outside.length) page.append(h("p", {class: "notice"}, "Outside: " + outside.map((check) => check.name).join(", ")));
for (const topic of data.topics) writeTopic(topic);
writeSource(data.provenance, null, [["Instructions", data.instructions]]);
writeContents();
followTheme();
