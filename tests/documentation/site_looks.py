#!/usr/bin/env python3
"""Opens every page of the built documentation from disk in a headless browser, and fails on what a reader would not like.

usage: site_looks.py SITE_DIRECTORY [PICTURE_DIRECTORY [PAGE ...]]

Held, at widths of 390 and 1000 pixels: no console error, no request but for files of the site, no formula that KaTeX cannot read, no picture that is missing, no
page wider than the window; and the search finds something. With a folder for pictures, the named pages (or the start page) are kept in light and dark.
Exit code 0: fine; 1: something is wrong (said in words); 77: no browser is installed, or the site is not built (skipped).
"""
import base64
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "validation"))
from report_opens import opened_browser, problems  # noqa: E402

CHECK = """(() => {
  const wrong = [], seen = document.documentElement.clientWidth, wide = document.documentElement.scrollWidth;
  if (wide > seen + 1) wrong.push("is " + wide + " pixels wide in a window of " + seen + ": " +
    [...document.querySelectorAll(".md-content *")].filter((e) => e.getBoundingClientRect().right > seen + 1).slice(0, 3).map((e) => e.tagName + " " + e.textContent.slice(0, 30)).join(", "));
  for (const e of document.querySelectorAll(".katex-error")) wrong.push("formula: " + e.title);
  for (const e of document.querySelectorAll(".arithmatex")) if (!e.querySelector(".katex, .katex-error")) wrong.push("a formula is not drawn: " + e.textContent.slice(0, 40));
  for (const e of document.images) if (!e.naturalWidth) wrong.push("no picture: " + e.src);
  return wrong;
})()"""

SEARCH = """(async () => {
  document.querySelector("[data-md-toggle=search]").click();
  const field = document.querySelector("[data-md-component=search-query]");
  field.focus();
  field.value = "calibration";
  for (const name of ["input", "keyup"]) field.dispatchEvent(new Event(name, {bubbles: true}));
  for (let i = 0; i < 50; ++i) {
    await new Promise((done) => setTimeout(done, 100));
    const found = document.querySelectorAll(".md-search-result__item").length;
    if (found) return found;
  }
  return 0;
})()"""


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    pictures = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    chosen = sys.argv[3:] or ["index.html"]
    if not (site / "index.html").exists():
        print("the site is not built (scripts/build-docs): skipped")
        return 77
    wrong = []
    with opened_browser() as browser:
        pages = sorted(p for p in site.rglob("*.html") if p.name != "404.html")
        for page in pages:
            name = page.relative_to(site).as_posix()
            if pictures and name not in chosen:
                continue
            browser.ask("Page.navigate", url=page.as_uri())
            for _ in range(100):
                browser.listen(0.1)
                if browser.evaluate("document.readyState") == "complete" and browser.evaluate("location.href").startswith(page.as_uri()):
                    break
            for width in (390, 1000):
                browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
                browser.listen(0.1)
                wrong += [f"{name}, {width} pixels: {sentence}" for sentence in browser.evaluate(CHECK)]
                if pictures:
                    pictures.mkdir(parents=True, exist_ok=True)
                    for look in ("light", "dark"):
                        browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": look}])
                        browser.evaluate("localStorage.clear()")
                        browser.ask("Page.reload")
                        browser.listen(1.0)
                        data = browser.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                                           clip={"x": 0, "y": 0, "width": width, "height": min(2600, browser.evaluate("document.documentElement.scrollHeight")), "scale": 1})["data"]
                        (pictures / f"{name.replace('/', '-')[:-5]}-{width}-{look}.png").write_bytes(base64.b64decode(data))
        browser.ask("Page.navigate", url=(site / "index.html").as_uri())
        browser.listen(1.5)
        found = browser.evaluate(SEARCH)
        if not found:
            wrong.append("the search finds nothing")
        elif pictures:
            data = browser.ask("Page.captureScreenshot", format="png")["data"]
            (pictures / "search.png").write_bytes(base64.b64decode(data))
        ours = ("request: " + site.as_uri(), "request: about:")
        wrong += [sentence for sentence in problems(browser.events, None) if not sentence.startswith(ours)]
    for sentence in wrong:
        print(sentence)
    print(f"{len(pages)} pages, {found} results of the search, {len(wrong)} problems")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main())
