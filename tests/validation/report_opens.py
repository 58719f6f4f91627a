#!/usr/bin/env python3
"""Opens report.html in a headless browser from disk, uses it, and fails on any console error or network request.

usage: report_opens.py RESULTS_DIRECTORY [PICTURE_DIRECTORY]

Saves report.png (the whole page), report-viewer.png and report-dark.png, for looking at. Exit code 0: fine; 1: something is
wrong (said in words); 77: no browser is installed (skipped).
"""
import base64
import contextlib
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import tempfile
import time

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--no-first-run", "--disable-dev-shm-usage", "--remote-debugging-pipe", "about:blank"]
SKIPPED = 77


class Browser:
    """A browser driven over a pair of pipes: one JSON message, one zero byte."""

    def __init__(self, program, profile):
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()

        def connect():   # the browser reads commands from descriptor 3 and answers on 4
            high_in, high_out = os.dup(to_browser), os.dup(from_browser)
            high_in, high_out = [os.dup2(fd, number, True) for fd, number in ((high_in, 20), (high_out, 21))]
            os.dup2(high_in, 3)
            os.dup2(high_out, 4)

        self.process = subprocess.Popen([program, f"--user-data-dir={profile}", *FLAGS], preexec_fn=connect, close_fds=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.number = 0
        self.session = None
        self.events = []

    def receive(self, seconds):
        """The next message, or None when there is none within so many seconds."""
        end = time.monotonic() + seconds
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.read_end], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                return None
            piece = os.read(self.read_end, 1 << 20)
            if not piece:
                raise SystemExit("the browser ended by itself")
            self.buffer += piece
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, **parameters):
        """Sends a command and waits for its answer; events that come first are kept."""
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.write_end, json.dumps(command).encode() + b"\0")
        while True:
            message = self.receive(60)
            if message is None:
                raise SystemExit(f"the browser does not answer {method}")
            if message.get("id") == self.number:
                if "error" in message:
                    raise SystemExit(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def listen(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.receive(end - time.monotonic())
            if message is not None:
                self.events.append(message)

    def evaluate(self, script):
        answer = self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise SystemExit(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def picture(self, file, selector=None):
        size = self.evaluate("(() => { const e = document.querySelector(%s), r = e.getBoundingClientRect();"
                             "return [r.left + scrollX, r.top + scrollY, r.width, r.height]; })()" % json.dumps(selector or "html"))
        clip = dict(zip(("x", "y", "width", "height"), size), scale=1)
        data = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)["data"]
        file.write_bytes(base64.b64decode(data))

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()


def problems(events, allowed):
    """Console errors, uncaught exceptions, and requests for anything but the report itself."""
    found = []
    for event in events:
        method, p = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = p["exceptionDetails"]
            found.append("exception: " + details.get("exception", {}).get("description", details.get("text", "?")))
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            found.append("console: " + " ".join(str(a.get("value", a.get("description"))) for a in p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            found.append("log: " + p["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            url = p["request"]["url"]
            if url != allowed and not url.startswith(("data:", "blob:")):
                found.append("request: " + url)
    return found


USE_EVERYTHING = """(async () => {
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  let used = 0;
  for (const button of document.querySelectorAll(".pick button, .zoom button")) { button.click(); ++used; await pause(120); }
  for (const select of document.querySelectorAll("select")) {
    for (const option of select.options) {
      select.value = option.value;
      select.dispatchEvent(new Event("change"));
      ++used;
      await pause(60);
    }
    select.selectedIndex = 0;
    select.dispatchEvent(new Event("change"));
  }
  for (const slider of document.querySelectorAll("input[type=range]")) {
    for (let n = 0; n <= Number(slider.max); ++n) { slider.value = n; slider.dispatchEvent(new Event("input")); ++used; await pause(60); }
  }
  for (const over of document.querySelectorAll(".u-over")) {
    const r = over.getBoundingClientRect();
    over.dispatchEvent(new MouseEvent("mousemove", {clientX: r.left + r.width / 2, clientY: r.top + r.height / 2, bubbles: true}));
  }
  return used;
})()"""


# What a reader takes out of the page, or brings along: picture and film of the viewer, a measured curve, a rock mass, another packing. `saveAs` is the page's own function that
# hands files to the reader.
TAKEN_AND_BROUGHT = """(async () => {
  const wrong = [], pause = (ms) => new Promise((done) => setTimeout(done, ms)), saved = [], button = (text, inside) => [...document.querySelectorAll(inside + " button")].find((b) => b.textContent === text);
  window.saveAs = (blob, name) => saved.push([blob, name]);
  if (button("PNG", ".viewer")) {
    for (const list of document.querySelectorAll(".viewer select")) { list.selectedIndex = 0; list.dispatchEvent(new Event("change")); }
    button("PNG", ".viewer").click();
    button("Film", ".viewer").click();
    for (let n = 0; n < 150 && saved.length < 2; ++n) await pause(200);
    if (!saved.some(([blob, name]) => name.endsWith(".png") && blob.size > 5000)) wrong.push("the viewer gives no picture");
    if (!saved.some(([blob, name]) => name.endsWith(".webm") && blob.size > 20000)) wrong.push("the viewer gives no film: " + saved.map(([blob, name]) => name + " " + blob.size).join(", "));
  } else wrong.push("there is no viewer");
  const input = document.querySelector("input[type=file]"), files = new DataTransfer();
  files.items.add(new File(["# measured\\nAxial strain (%);Axial stress (MPa)\\n0,0;0\\n0,1;20,5\\n0,2;41\\n"], "core-7.csv"));
  input.files = files.files;
  input.dispatchEvent(new Event("change"));
  await pause(500);
  const curve = [...charts].flatMap((c) => c.series).find((s) => s.label === "measured: core-7.csv");
  if (!curve || curve.x.join() !== "0,1,2" || curve.y.join() !== "0,20.5,41") wrong.push("a measured curve is not laid over ours: " + JSON.stringify(curve));
  const mass = rockMass(10, 100, 50, 0);   // by hand from the formulas of 2002
  if (Math.abs(mass.mb - 1.6767) > 1e-4 || Math.abs(mass.s - 0.003866) > 1e-6 || Math.abs(mass.a - 0.50573) > 1e-5) wrong.push("mb, s, a of GSI 50: " + [mass.mb, mass.s, mass.a]);
  const seeds = packing.seeds;
  packing.choose(seeds[seeds.length - 1]);
  await pause(200);
  const facts = [...document.querySelectorAll(".numbers dd:first-of-type")].map((e) => e.textContent);
  if (!facts.length || facts.some((t) => t !== "seed " + seeds[seeds.length - 1])) wrong.push("not the whole page shows packing " + seeds[seeds.length - 1] + ": " + facts);
  packing.choose(seeds[0]);
  return wrong;
})()"""


@contextlib.contextmanager
def opened_browser():
    """A browser with an empty page that tells what happens in it. Ends the program as skipped where no chromium is installed."""
    program = next((p for p in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if p), None)
    if not program:
        print("skipped: no chromium is installed")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
            browser.session = browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
            for domain in ("Page", "Runtime", "Log", "Network"):
                browser.ask(domain + ".enable")
            yield browser
        finally:
            browser.close()


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    report = pathlib.Path(sys.argv[1]).resolve() / "report.html"
    pictures = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else sys.argv[1])
    if not report.is_file():
        raise SystemExit(f"{report} does not exist")
    address = report.as_uri()
    with opened_browser() as browser:
        pictures.mkdir(parents=True, exist_ok=True)
        browser.ask("Emulation.setDeviceMetricsOverride", width=1280, height=900, deviceScaleFactor=1, mobile=False)
        browser.events.clear()
        browser.ask("Page.navigate", url=address)
        browser.listen(4)
        counts = browser.evaluate("[document.querySelectorAll('h2').length, document.querySelectorAll('table').length, document.querySelectorAll('canvas').length]")
        browser.picture(pictures / "report.png")
        used = browser.evaluate(USE_EVERYTHING)
        brought = browser.evaluate(TAKEN_AND_BROUGHT)
        has_viewer = browser.evaluate("document.querySelector('.viewer') !== null")
        drawn = True
        if has_viewer:
            browser.picture(pictures / "report-viewer.png", ".viewer")
            drawn = browser.evaluate("(() => { const c = document.querySelector('.stage canvas');"
                                     "return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((v) => v > 0); })()")
        browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        browser.listen(1.5)
        browser.picture(pictures / "report-dark.png")
        browser.ask("Emulation.setEmulatedMedia", features=[])
        (pictures / "report.pdf").write_bytes(base64.b64decode(browser.ask("Page.printToPDF", printBackground=True)["data"]))
        browser.listen(0.5)
        found = brought + problems(browser.events, address)
    if counts[0] < 3 or counts[1] < 2 or counts[2] < 1:
        found.append(f"the page looks empty: {counts} headings, tables and canvases")
    if not drawn:
        found.append("the failure pattern is blank")
    for line in found:
        print("wrong:", line)
    print(f"{address.rsplit('/', 2)[-2]}/report.html: {counts[0]} sections, {counts[1]} tables, {counts[2]} canvases, {used} controls used; "
          f"pictures in {pictures}")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
