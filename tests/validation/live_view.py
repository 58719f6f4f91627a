#!/usr/bin/env python3
"""Looks at a running job in a headless browser, ends a test and then the run from the page, and holds what is left against a run that nobody looked at.

usage: live_view.py FELDSPAR JOB.toml REFERENCE_RESULTS WORK_DIRECTORY

Held: curves, cracks and displaced grains arrive and grow; the page is not wider than its window at 390 and 1000 pixels; an address with another key is refused; the button of a
test ends that test alone, with its results whole and its reason said; the button of the run ends it as Ctrl-C does (exit code 130), and the page becomes its report; tests that
ended by themselves have the histories of the reference, number by number. Pictures stay in WORK_DIRECTORY. Exit code 0: fine; 1: something is wrong (said in words); 77: no
browser is installed (skipped).
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request

from report_opens import opened_browser, problems

CURVES = """[...charts].filter((c) => c.host.closest(".live")).map((c) => c.series[0].x.length)"""
# Of a copy: a canvas that is read again and again makes the browser say so in its console.
PATTERNS = """[...document.querySelectorAll(".live .pattern canvas")].map(({width, height}, i) => {
  if (!(width > 1)) return false;
  const ctx = Object.assign(document.createElement("canvas"), {width, height}).getContext("2d", {willReadFrequently: true});
  ctx.drawImage(document.querySelectorAll(".live .pattern canvas")[i], 0, 0);
  return ctx.getImageData(0, 0, width, height).data.some((v) => v > 0);
})"""
SHEET = """[document.documentElement.scrollWidth, document.documentElement.clientWidth]"""


class Program:
    """A run with its live view, and what it says."""

    def __init__(self, command, cwd=None):
        self.lines, self.process = [], subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, cwd=cwd)
        threading.Thread(target=lambda: self.lines.extend(self.process.stderr), daemon=True).start()

    def address(self):
        for _ in range(600):
            for line in self.lines:
                if found := re.search(r"live view: (http://127\.0\.0\.1:\d+/[0-9a-f]{48}/)", line):
                    return found[1]
            time.sleep(0.1)
        raise SystemExit("the program prints no address: " + "".join(self.lines))


def numbers(file):
    return [line for line in file.read_text().splitlines() if not line.startswith("#")]


def stem(test):
    """As its files are named."""
    pressure = f"-p{test['sigma3_MPa']:g}" if test["kind"] == "biaxial" else ""
    return f"{test['kind']}-s{test['seed']}{pressure}"


def refused(address):
    try:
        with urllib.request.urlopen(address, timeout=10) as answer:
            return answer.status
    except urllib.error.HTTPError as error:
        return error.code


def wait_for(browser, script, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        browser.listen(0.25)
        if value := browser.evaluate(script):
            return value
    return None


def size(browser, width, density=1, scheme="light"):
    browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=1100, deviceScaleFactor=density, mobile=width < 500)
    browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    browser.listen(1.0)


def press(browser, text, inside):
    script = "(() => { const b = [...document.querySelectorAll(%s)].find((e) => e.textContent === %s); if (b) b.click(); return Boolean(b); })()"
    return browser.evaluate(script % (json.dumps(inside), json.dumps(text)))


def main():
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    feldspar, job, reference, work = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    results, wrong = work / "results", []
    with opened_browser() as browser:
        program = Program([feldspar, "run", job, "--out", str(results), "--live", *(word for seed in range(1, 9) for word in ("--seed", str(seed)))])
        try:
            address = program.address()
            key = address.rstrip("/").rsplit("/", 1)[1]
            for other in (address.replace(key, key[:-1] + ("0" if key[-1] != "0" else "1")), address.replace(key + "/", "")):
                if (code := refused(other)) != 403:
                    wrong.append(f"{other} is answered with {code}")
            size(browser, 1000)
            browser.events.clear()
            browser.ask("Page.navigate", url=address)
            wait_for(browser, "typeof charts !== 'undefined' && document.querySelector('.live') !== null")
            first = wait_for(browser, f"{CURVES}.some((n) => n > 5) && {PATTERNS}.some((drawn) => drawn) && {CURVES}")
            if not first:
                wrong.append("no curve or no grains appear: " + str(browser.evaluate(f"[{CURVES}, {PATTERNS}]")))
            ended = browser.evaluate("document.querySelector('.live progress').value")
            if first and not wait_for(browser, f"{CURVES}.reduce((a, b) => a + b, 0) > {sum(first)} || document.querySelector('.live progress').value > {ended}"):
                wrong.append("the curves do not grow")
            # the first report comes: the page takes it by itself, and later ones when the reader asks
            if not wait_for(browser, "document.querySelector('.live') !== null && document.querySelectorAll('h2').length > 3"):
                wrong.append("the report does not come when a test has ended")
            wait_for(browser, f"{PATTERNS}.some((drawn) => drawn)")
            for width, density, scheme in ((1000, 1, "light"), (1000, 2, "dark"), (390, 2, "light")):
                size(browser, width, density, scheme)
                wide, seen = browser.evaluate(SHEET)
                if wide > seen + 1:
                    wrong.append(f"the page is {wide} pixels wide in a window of {seen}")
                browser.picture(work / f"live-{width}-{density}-{scheme}.png", ".live")
            size(browser, 1000)
            # the first test that runs is ended alone, however it stands
            if not wait_for(browser, "Boolean(document.querySelector('.live .test .end'))"):
                wrong.append("no test can be ended")
            name = browser.evaluate("document.querySelector('.live .test h3').textContent")
            press(browser, "End this test", ".live .test:first-child .end")
            press(browser, "Yes, end it", ".live .test:first-child .end")
            listed = wait_for(browser, "[...document.querySelectorAll('.live .done li')].map((e) => e.textContent).find((t) => t.startsWith(%s)) || document.title.includes('report')" % json.dumps(name))
            if not listed or "ended by the user" not in str(listed):
                wrong.append(f"{name} is not listed as ended by the user: {listed}")
            wait_for(browser, "[...charts].some((c) => c.host.closest('.live'))")
            browser.evaluate("sessionStorage.clear()")
            press(browser, "End the run", ".live .top > .ask .end")
            press(browser, "Yes, end it", ".live .top > .ask .end")
            if not wait_for(browser, "document.querySelector('.live.over') !== null && document.querySelectorAll('h2').length > 3"):
                wrong.append("the page does not become the report")
            browser.listen(1.0)
            browser.picture(work / "live-over.png", ".live.over")
            code = program.process.wait(60)
        finally:
            program.process.kill()
        wrong += [line for line in problems(browser.events, address) if not line.startswith("request: " + address)]
    if code != 130:
        wrong.append(f"the program ended with {code}: " + "".join(program.lines))
    summary = json.loads((results / "summary.json").read_text())
    reasons = {test["stop_reason"] for test in summary["tests"]}
    if "ended by the user" not in reasons:
        wrong.append(f"no test is marked as ended by the user: {reasons}")
    same = 0
    for test in summary["tests"]:
        if test["stop_reason"] in ("ended by the user", "interrupted by the user"):
            continue
        own = results / f"history-{stem(test)}.csv"
        if not (reference / own.name).exists():   # of another packing
            continue
        if numbers(own) != numbers(reference / own.name):
            wrong.append(f"{own.name} differs from that of the run that nobody looked at")
        same += 1
    if same == 0:
        wrong.append("no test of the reference's packings has ended by itself")
    for line in wrong:
        print("wrong:", line)
    print(f"{len(summary['tests'])} tests, {same} of which ended by themselves and have the reference's numbers; pictures in {work}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
