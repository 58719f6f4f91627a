#!/usr/bin/env python3
"""Looks at a study that runs in a headless browser, ends a run and then the study from the page, and lets the same command go on.

usage: live_study.py FELDSPAR WORK_DIRECTORY

Held: runs of an earlier call are listed as done; curves and grains of the runs under way appear; the page counts runs and is not wider than its window at 390 and 1000 pixels;
below stand all points of the study, whose runs and numbers grow without the page being loaded again, and what the reader has chosen there stays;
a run that is ended there is listed as failed, ended by the user; the button of the study ends it as Ctrl-C does (exit code 130), and the page becomes that of the study; the same
command makes the rest, the ended run too. Pictures stay in WORK_DIRECTORY. Exit code 0: fine; 1: something is wrong (said in words); 77: no browser is installed (skipped).
"""
import json
import pathlib
import shutil
import subprocess
import sys

from live_view import CURVES, PATTERNS, SHEET, Program, press, size, wait_for
from report_opens import opened_browser, problems

JOB = """[specimen]
shape = "rectangle"
width = "40 mm"
height = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "brazilian"
"""
STUDY = """job = "job.toml"
seeds = [1, 2]
[[axis]]
name = "mu"
key = "material.contact.mu"
values = [0.2, 0.4, 0.6]
"""
WORDS = "document.querySelector('.live > .state')?.textContent || ''"
# Of the table of points: how many runs of each are done, and its cells.
DONE = "[...document.querySelectorAll('table.points tbody tr')].map((row) => Number(row.cells[row.cells.length - 3].textContent))"
CELLS = "[...document.querySelectorAll('table.points tbody tr')].map((row) => [...row.cells].map((cell) => cell.textContent))"
LISTED = "[...document.querySelectorAll('.live .done li')].map((e) => e.textContent)"


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    feldspar, work, wrong = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve(), []
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    (work / "job.toml").write_text(JOB)
    (work / "study.toml").write_text(STUDY)
    (work / "first.toml").write_text('name = "first"\nresults = "study"\ntests = ["uniaxial-compression"]\n' + STUDY.replace("[1, 2]", "[1]").replace("[0.2, 0.4, 0.6]", "[0.2]"))
    subprocess.run([feldspar, "study", "first.toml", "--quiet"], cwd=work, check=True, stdout=subprocess.DEVNULL)   # a run of the study that is done before
    with opened_browser() as browser:
        program = Program([feldspar, "study", "study.toml", "--live", "--threads", "2"], cwd=work)
        try:
            address = program.address()
            size(browser, 1000)
            browser.events.clear()
            browser.ask("Page.navigate", url=address)
            wait_for(browser, "typeof charts !== 'undefined' && document.querySelector('.live') !== null")
            if not wait_for(browser, f"{CURVES}.some((n) => n > 5) && {PATTERNS}.some((drawn) => drawn)"):
                wrong.append("no curve or no grains appear: " + str(browser.evaluate(f"[{CURVES}, {PATTERNS}]")))
            words = browser.evaluate(WORDS)
            if "of 12 runs ended" not in words or "running" not in words:
                wrong.append(f"the page does not count the runs: {words}")
            if not any("0.2: uniaxial-compression, seed 1: " in line for line in browser.evaluate(LISTED)):
                wrong.append(f"the run that was done before is not listed: {browser.evaluate(LISTED)}")
            before = wait_for(browser, f"{DONE}.length > 0 ? {DONE} : null") or []
            if len(before) != 3 or not any("to do" in cell for row in browser.evaluate(CELLS) for cell in row):
                wrong.append(f"the points of the study are not there: {browser.evaluate(CELLS)}")
            browser.evaluate("window.notLoadedAgain = true; document.querySelector('section input[type=checkbox]').click()")
            if not wait_for(browser, f"{DONE}.reduce((a, b) => a + b, 0) > {sum(before)}", 120):
                wrong.append(f"runs end, but the table of points does not show them: {browser.evaluate(CELLS)}")
            if not browser.evaluate("window.notLoadedAgain === true && document.querySelector('section input[type=checkbox]').checked"):
                wrong.append("the page was loaded again for them, or has forgotten what was chosen")
            if not any(row[1].strip() for row in browser.evaluate(CELLS)):
                wrong.append(f"no point has a number: {browser.evaluate(CELLS)}")
            browser.evaluate("document.querySelector('section input[type=checkbox]').click()")
            for width, density, scheme in ((1000, 1, "light"), (390, 2, "dark")):
                size(browser, width, density, scheme)
                wide, seen = browser.evaluate(SHEET)
                if wide > seen + 1:
                    wrong.append(f"the page is {wide} pixels wide in a window of {seen}")
                browser.picture(work / f"live-study-{width}-{density}-{scheme}.png", ".live")
                browser.picture(work / f"live-study-points-{width}-{density}-{scheme}.png", "main")
            size(browser, 1000)
            ended = None
            for _ in range(20):   # a run may end by itself while it is being ended
                if not wait_for(browser, "Boolean(document.querySelector('.live .test .end'))"):
                    break
                press(browser, "End this run", ".live .test:first-child .end")
                press(browser, "Yes, end it", ".live .test:first-child .end")
                if ended := wait_for(browser, f"{LISTED}.find((t) => t.includes('ended by the user'))", 10):
                    break
            if not ended:
                wrong.append(f"no run is listed as ended by the user: {browser.evaluate(LISTED)}")
            browser.picture(work / "live-study-ended.png", ".live")
            press(browser, "End the study", ".live .top > .ask .end")
            press(browser, "Yes, end it", ".live .top > .ask .end")
            if not wait_for(browser, "document.querySelector('.live.over') !== null && document.querySelectorAll('table').length > 0"):
                wrong.append("the page does not become that of the study")
            else:
                browser.listen(1.0)
                browser.picture(work / "live-study-over.png", ".live.over")
            code = program.process.wait(60)
        finally:
            program.process.kill()
        late = "status of 409"   # the run had ended by itself when the button was pressed
        wrong += [line for line in problems(browser.events, address) if not line.startswith("request: " + address) and late not in line]
    if code != 130:
        wrong.append(f"the program ended with {code}: " + "".join(program.lines))
    rest = subprocess.run([feldspar, "study", "study.toml", "--json"], cwd=work, capture_output=True, text=True, check=False)
    if rest.returncode != 0:
        wrong.append(f"the same command does not go on: {rest.stderr}")
    else:
        executed = json.loads(rest.stdout)["executed"]
        if executed["done"] + executed["done_before"] != 12 or executed["failed_before"] != 0:
            wrong.append(f"the same command did not make the rest: {executed}")
    for line in wrong:
        print("wrong:", line)
    print(f"pictures in {work}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
