#!/usr/bin/env python3
"""Opens report.html in a headless browser at several widths and densities of the screen, in print and in the dark, and fails on what a reader would not like.

usage: report_looks.py RESULTS_DIRECTORY|PAGE.html [PICTURE_DIRECTORY]

Held: the page is never wider than the window; words in charts are at least 10 pixels high, inside their chart and not over each other; cards hold what is in
them; a specimen with enlarged displacements stays in view; zoom, readout, legend, picture and table of a chart work; on paper no table, chart or picture is wider
than the sheet or higher than a page; no console error and no request. Exit code 0: fine; 1: something is wrong (said in words); 77: no browser is installed (skipped).
"""
import base64
import pathlib
import sys

from report_opens import opened_browser, problems

WIDTHS, DENSITIES = (390, 1000, 1600), (1, 2)
SHEET = (8.27, 11.69)      # inches, A4
MARGIN = 12 / 25.4         # inches, of @page in report.css

# Remembers the words that are on each canvas: box of the text in CSS pixels of the canvas, its size, since the canvas was last cleared.
LISTEN = """(() => {
  const proto = CanvasRenderingContext2D.prototype, {fillText, clearRect} = proto;
  proto.clearRect = function (x, y, w, h) {
    if (w >= this.canvas.width && h >= this.canvas.height) this.canvas.words = [];
    return clearRect.call(this, x, y, w, h);
  };
  proto.fillText = function (text, x, y, ...rest) {
    const m = this.measureText(text), t = this.getTransform(), corners = [];
    for (const dx of [-m.actualBoundingBoxLeft, m.actualBoundingBoxRight]) for (const dy of [-m.actualBoundingBoxAscent, m.actualBoundingBoxDescent]) corners.push(t.transformPoint(new DOMPoint(x + dx, y + dy)));
    const xs = corners.map((c) => c.x), ys = corners.map((c) => c.y);
    if (String(text).trim()) (this.canvas.words ||= []).push({text: String(text), box: [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)], size: Number(/([0-9.]+)px/.exec(this.font)[1]), turned: Math.abs(t.b) > 0.5});
    return fillText.call(this, text, x, y, ...rest);
  };
})()"""

DRAWN = "document.readyState === 'complete' && [...document.querySelectorAll('.chart canvas, .rosette canvas')].every((canvas) => (canvas.words || []).length)"

CHECK = """(() => {
  const wrong = [], seen = document.documentElement.clientWidth, wide = document.documentElement.scrollWidth;
  if (wide > seen + 1) {
    const far = [...document.querySelectorAll("main *")].filter((e) => e.getBoundingClientRect().right > seen + 1 && !e.closest(".scroll, .uplot, pre"));
    wrong.push("the page is " + wide + " pixels wide in a window of " + seen + ": " + far.slice(0, 3).map((e) => e.tagName + "." + e.className).join(", "));
  }
  const charts = [...document.querySelectorAll(".chart canvas, .rosette canvas")];
  for (const canvas of charts) {
    const card = canvas.closest(".card"), name = card && card.querySelector("h4") ? card.querySelector("h4").textContent : "a chart";
    const shown = canvas.getBoundingClientRect(), k = canvas.width / shown.width, words = canvas.words || [];
    if (!words.length) wrong.push(name + ": no words on it");
    for (const w of words) {
      if (w.size / k < 10) wrong.push(name + ": '" + w.text + "' is " + (w.size / k).toFixed(1) + " pixels high");
      if (w.box[0] < -k || w.box[1] < -k || w.box[2] > canvas.width + k || w.box[3] > canvas.height + k) wrong.push(name + ": '" + w.text + "' is cut");
    }
    for (let i = 0; i < words.length; ++i) for (let j = 0; j < i; ++j) {
      const a = words[i].box, b = words[j].box, slack = k;
      if (a[0] < b[2] - slack && b[0] < a[2] - slack && a[1] < b[3] - slack && b[1] < a[3] - slack) wrong.push(name + ": '" + words[i].text + "' and '" + words[j].text + "' overlap");
    }
  }
  for (const card of document.querySelectorAll(".card")) {
    const own = card.getBoundingClientRect();
    for (const part of card.querySelectorAll("h4, .legend button, .legend span, .tools, .chart, canvas, dl, select, p")) {
      const r = part.getBoundingClientRect();
      if (r.width && (r.right > own.right + 1 || r.left < own.left - 1) && !part.closest(".scroll")) wrong.push("'" + (part.textContent || part.tagName).slice(0, 40) + "' sticks out of its card");
    }
    const keys = [...card.querySelectorAll(".legend button, .legend span")].map((e) => e.getBoundingClientRect());
    keys.forEach((a, i) => keys.slice(0, i).forEach((b) => { if (a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1) wrong.push("legend entries overlap in '" + card.textContent.slice(0, 30) + "'"); }));
  }
  return [wrong, charts.length];
})()"""

# Each choice of the displacements: nothing of the specimen on the outermost pixels of its canvas.
VIEWER = """(async () => {
  const wrong = [], pause = (ms) => new Promise((done) => setTimeout(done, ms)), canvas = document.querySelector(".stage canvas"), list = document.querySelector("select[aria-label='Displacements']");
  if (!canvas || !list) return wrong;
  const slider = document.querySelector(".slider input[type=range]");
  for (const option of list.options) {
    list.value = option.value;
    list.dispatchEvent(new Event("change"));
    for (const n of [0, Number(slider.max)]) {
      slider.value = n;
      slider.dispatchEvent(new Event("input"));
      await pause(150);
      const {width, height} = canvas, copy = Object.assign(document.createElement("canvas"), {width, height}), ctx = copy.getContext("2d", {willReadFrequently: true});
      ctx.drawImage(canvas, 0, 0);
      const edges = [[0, 0, width, 1], [0, height - 1, width, 1], [0, 0, 1, height], [width - 1, 0, 1, height]];
      if (edges.some((e) => ctx.getImageData(...e).data.some((v, i) => i % 4 === 3 && v > 0))) wrong.push("displacements '" + option.textContent + "' leave the picture at moment " + n);
      if (!ctx.getImageData(0, 0, width, height).data.some((v) => v > 0)) wrong.push("displacements '" + option.textContent + "': nothing is drawn");
    }
  }
  return wrong;
})()"""

# The first chart with a legend: readout under the cursor, legend, picture, table. `saveAs` is the page's own function that hands files to the reader.
CHART = """(async () => {
  const wrong = [], pause = (ms) => new Promise((done) => setTimeout(done, ms)), key = document.querySelector(".card .legend button[aria-pressed]"), saved = [];
  if (!key) return wrong;
  window.saveAs = (blob, name) => saved.push([blob, name]);
  const card = key.closest(".card"), label = key.textContent;
  key.click();
  const again = [...card.querySelectorAll(".legend button")].find((b) => b.textContent === label);
  if (again.getAttribute("aria-pressed") !== "false") wrong.push("the legend does not hide a series");
  for (const name of ["CSV", "PNG"]) [...card.querySelectorAll(".tools button")].find((b) => b.textContent === name).click();
  await pause(800);
  const table = saved.find(([, name]) => name.endsWith(".csv")), picture = saved.find(([, name]) => name.endsWith(".png"));
  if (!table) wrong.push("no table is saved");
  else {
    const lines = (await table[0].text()).trim().split("\\n");
    if (lines.length < 3 || !lines[0].includes("(")) wrong.push("the saved table has no numbers, or no units: " + lines[0]);
    if (lines[0].includes(label + ":")) wrong.push("the saved table holds a hidden series");
  }
  if (!picture || picture[0].size < 2000) wrong.push("no picture is saved");
  again.click();
  return wrong;
})()"""

PRINT = """(() => {
  const wrong = [], wide = %(width)d, high = %(height)d;
  for (const e of document.querySelectorAll("main table, main canvas, .card, pre, dl, figure, .viewer")) {
    const r = e.getBoundingClientRect(), name = e.tagName.toLowerCase() + " '" + (e.textContent || "").slice(0, 30).trim() + "'";
    if (r.width && r.right > wide + 1) wrong.push("on paper " + name + " reaches to " + Math.round(r.right) + " of " + wide + " pixels");
    if (["CANVAS", "FIGURE"].includes(e.tagName) && r.height > high) wrong.push("on paper " + name + " is higher than a page");
    const box = e.closest(".scroll");
    if (box && getComputedStyle(box).overflowX !== "visible") wrong.push("on paper " + name + " is cut");
  }
  for (const e of document.querySelectorAll("button, input, select")) if (e.getBoundingClientRect().width && !e.closest(".legend")) wrong.push("on paper there is a " + e.tagName.toLowerCase() + " '" + e.textContent + "'");
  for (const d of document.querySelectorAll("details")) if (!d.open) wrong.push("on paper '" + d.textContent.slice(0, 30) + "' is folded");
  return wrong;
})()"""


def drag_zooms(browser):
    """Zooms into the first chart with the mouse, and back."""
    x, y, w, h = browser.evaluate("(() => { const e = document.querySelector('.chart .u-over'); e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; })()")
    wrong = []
    scales = "(() => { const {x, y} = [...charts].find((c) => c.plot.over === document.querySelector('.chart .u-over')).plot.scales; return [x.min, x.max, y.min, y.max]; })()"
    axes = (0, 2) if browser.evaluate("[...charts].find((c) => c.plot.over === document.querySelector('.chart .u-over')).plot.cursor.drag.x") else (2,)   # words stand still

    def mouse(kind, at_x, at_y, **more):
        browser.ask("Input.dispatchMouseEvent", type=kind, x=at_x, y=at_y, **more)

    mouse("mouseMoved", x + 0.4 * w, y + 0.5 * h)
    browser.listen(0.2)
    readout, titles = browser.evaluate("[document.querySelector('.tools .at').textContent, document.querySelector('.chart canvas').words.filter((w) => w.turned || w.text.endsWith(')')).map((w) => w.text).join(' ')]")
    if not any(c.isdigit() for c in readout) or ("(MPa)" in titles and "MPa" not in readout):
        wrong.append("no value with its unit is read out under the cursor")
    whole = browser.evaluate(scales)
    pressed = {"button": "left", "buttons": 1, "clickCount": 1}
    mouse("mousePressed", x + 0.2 * w, y + 0.2 * h, **pressed)
    mouse("mouseMoved", x + 0.6 * w, y + 0.6 * h, button="left", buttons=1)
    mouse("mouseReleased", x + 0.6 * w, y + 0.6 * h, button="left", clickCount=1)
    browser.listen(0.3)
    hidden = "[...document.querySelectorAll('.tools button')].find((b) => b.textContent === 'Whole chart').hidden"
    zoomed = browser.evaluate(scales)
    if browser.evaluate(hidden) or any(abs((zoomed[i + 1] - zoomed[i]) / (whole[i + 1] - whole[i]) - 0.4) > 0.02 for i in axes):
        wrong.append(f"dragging a box of two fifths does not zoom into it: {whole} to {zoomed}")
    browser.evaluate("[...document.querySelectorAll('.tools button')].find((b) => b.textContent === 'Whole chart').click()")
    if not browser.evaluate(hidden) or browser.evaluate(scales) != whole:
        wrong.append("a zoomed chart does not go back")
    return wrong


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    report = pathlib.Path(sys.argv[1]).resolve()
    if report.is_dir():
        report /= "report.html"
    pictures = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else report.parent
    if not report.is_file():
        raise SystemExit(f"{report} does not exist")
    address, wrong, charts, pages = report.as_uri(), [], 0, b""
    with opened_browser() as browser:
        pictures.mkdir(parents=True, exist_ok=True)
        browser.ask("Page.addScriptToEvaluateOnNewDocument", source=LISTEN)

        def open_at(width, density, scheme="light"):
            browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=density, mobile=width < 500)
            browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            browser.ask("Page.navigate", url=address)
            for _ in range(40):   # until everything is drawn, at most ten seconds
                browser.listen(0.25)
                if browser.evaluate(DRAWN):
                    break
            browser.listen(0.25)

        for width in WIDTHS:
            for density in DENSITIES:
                open_at(width, density, "dark" if (width, density) == (1000, 2) else "light")
                found, charts = browser.evaluate(CHECK)
                wrong += [f"{width} pixels at density {density}: {line}" for line in found]
                browser.picture(pictures / f"report-{width}-at-{density}.png", "main")
                if (width, density) == (1000, 1):
                    wrong += browser.evaluate(VIEWER) + browser.evaluate(CHART) + drag_zooms(browser)
        # paper: the page as it is laid out for a sheet, then the sheets themselves
        inside = [round(96 * (side - 2 * MARGIN)) for side in SHEET]
        open_at(inside[0], 1)
        browser.ask("Emulation.setEmulatedMedia", media="print", features=[])
        browser.evaluate("dispatchEvent(new Event('beforeprint'))")
        browser.listen(0.5)
        wrong += browser.evaluate(PRINT % {"width": inside[0], "height": inside[1]})
        wrong += ["on paper: " + line for line in browser.evaluate(CHECK)[0]]
        browser.evaluate("dispatchEvent(new Event('afterprint'))")
        browser.ask("Emulation.setEmulatedMedia", media="", features=[])
        pages = base64.b64decode(browser.ask("Page.printToPDF", printBackground=True, preferCSSPageSize=True, paperWidth=SHEET[0], paperHeight=SHEET[1])["data"])
        (pictures / "report.pdf").write_bytes(pages)
        browser.listen(0.5)
        wrong += problems(browser.events, address)
    if not charts:
        wrong.append("the page has no chart")
    if not pages.startswith(b"%PDF"):
        wrong.append("the page does not print")
    for line in wrong:
        print("wrong:", line)
    print(f"{charts} charts at {len(WIDTHS) * len(DENSITIES)} sizes, and on paper; pictures in {pictures}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
