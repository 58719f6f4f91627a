// What is going on in a run, or in the runs of a study, above the report: curves and cracks that grow, the time left, and buttons that end a test or the run. The program sends what is new.
"use strict";

(() => {
  const live = JSON.parse(document.getElementById("live").textContent);
  const numbersOf = (text, Kind) => new Kind(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);

  /** "12 s", "3 min 20 s", "2 h 05 min". */
  function duration(seconds) {
    const s = Math.round(seconds), two = (v) => String(v).padStart(2, "0");
    return s < 60 ? s + " s" : s < 3600 ? Math.floor(s / 60) + " min " + two(s % 60) + " s" : Math.floor(s / 3600) + " h " + two(Math.floor((s % 3600) / 60)) + " min";
  }

  /** A button that asks once more before it does something. */
  function sureButton(text, question, action) {
    const box = h("span", {class: "ask"}), start = h("button", {type: "button", class: "end", onclick: () => { box.replaceChildren(question, yes, no); no.focus(); }}, text);
    const back = () => box.replaceChildren(start);
    const yes = h("button", {type: "button", class: "end", onclick: () => { box.replaceChildren("ending\u2026"); action().then((ok) => { if (!ok) back(); }); }}, "Yes, end it"), no = h("button", {type: "button", onclick: back}, "No");
    back();
    return box;
  }
  const end = (what) => fetch("stop", {method: "POST", body: what}).then((answer) => answer.ok).catch(() => false);

  /** The grains as they are displaced now, and the cracks so far. */
  class Pattern {
    constructor(host) {
      this.canvas = h("canvas", {role: "img", "aria-label": "Cracks so far"});
      host.append(this.canvas);
      Object.assign(this, {outline: null, frame: null, cracks: [], magnify: 1});
      new ResizeObserver(() => this.draw()).observe(host);
    }
    take(test) {
      if (test.outline) this.outline = {...test.outline, begin: numbersOf(test.outline.begin, Int32Array), points: numbersOf(test.outline.points, Uint16Array)};
      if (test.frame) this.frame = {scale: test.frame.scale, steps: numbersOf(test.frame.steps, Int16Array)};
      if (test.cracks) {
        const c = test.cracks;
        this.cracks.length = Math.min(this.cracks.length, c.from);
        for (let i = 0; i < c.mode.length; ++i) this.cracks.push({ends: [c.x0[i], c.y0[i], c.x1[i], c.y1[i]], mode: c.mode[i], grains: [c.a[i], c.b[i]]});
      }
      if (test.outline || test.frame || test.cracks) this.draw();
    }
    /** Displacement of corner i, mm, as it is drawn. */
    move(i) {
      if (!this.frame) return [0, 0];
      const {steps, scale} = this.frame, n = steps.length / 2, k = scale * this.magnify;
      return [steps[i] * k, steps[n + i] * k];
    }
    corner(i) {
      const {x0, y0, scale, points} = this.outline;
      return [x0 + points[2 * i] * scale, y0 + points[2 * i + 1] * scale];
    }
    /** The corner of grain g that is nearest to (x, y). */
    nearest(g, x, y) {
      let best = -1, least = Infinity;
      for (let i = this.outline.begin[g]; i < this.outline.begin[g + 1]; ++i) {
        const [cx, cy] = this.corner(i), d = (cx - x) ** 2 + (cy - y) ** 2;
        if (d < least) { least = d; best = i; }
      }
      return best;
    }
    /** An end of a crack: midway between the corners of its grains that it lies at. */
    crackEnd(crack, e) {
      const x = crack.ends[2 * e], y = crack.ends[2 * e + 1];
      if (!this.frame) return [x, y];
      crack.corners ||= [0, 1].map((end) => crack.grains.map((g) => this.nearest(g, crack.ends[2 * end], crack.ends[2 * end + 1])));
      let dx = 0, dy = 0;
      for (const i of crack.corners[e]) { const [ux, uy] = this.move(i); dx += ux / 2; dy += uy / 2; }
      return [x + dx, y + dy];
    }
    draw() {
      const o = this.outline, dpr = Math.min(devicePixelRatio, 2), wide = this.canvas.clientWidth, high = this.canvas.clientHeight;
      if (!o || !wide) return;
      this.canvas.width = Math.round(wide * dpr);
      this.canvas.height = Math.round(high * dpr);
      const ctx = this.canvas.getContext("2d"), scale = 0.9 * Math.min(this.canvas.width / o.width, (this.canvas.height - 26 * dpr) / o.height);
      const at = (x, y) => [this.canvas.width / 2 + (x - o.x0 - o.width / 2) * scale, (this.canvas.height - 20 * dpr) / 2 - (y - o.y0 - o.height / 2) * scale];
      const corner = (i) => { const [x, y] = this.corner(i), [ux, uy] = this.move(i); return at(x + ux, y + uy); };
      const cracks = this.cracks.map((crack) => ({mode: crack.mode, from: at(...this.crackEnd(crack, 0)), to: at(...this.crackEnd(crack, 1))}));
      drawCracked(ctx, o.begin, corner, cracks, 0.5 * dpr, Math.min(4, Math.max(1.6, wide / 150)) * dpr);
      ctx.font = 12 * dpr + "px system-ui, sans-serif";
      ctx.textAlign = "center";
      const shear = this.cracks.filter((c) => c.mode).length;
      ctx.fillStyle = theme.get("soft");
      ctx.fillText(this.cracks.length ? (this.cracks.length - shear) + " tensile, " + shear + " shear" : "no cracks yet", this.canvas.width / 2, this.canvas.height - 6 * dpr);
    }
  }

  /** A running test: where it is, its curve, its cracks. */
  class Running {
    constructor(test) {
      this.x = []; this.stress = []; this.tensile = []; this.shear = [];
      this.axes = test.axes;
      this.words = h("p", {class: "state soft small"}, "begins");
      this.button = sureButton("End this " + live.one, live.keeps_ended ? "End it, keeping what it has?" : "End it without a result? The same command makes it again another time.", () => end(String(test.n)));
      const curve = h("div", {}, h("p", {class: "soft small"}, "The curve begins with the loading.")), pattern = h("div", {class: "pattern"});
      this.element = h("div", {class: "test"}, h("div", {class: "top"}, h("h3", {}, test.label), this.button), this.words, h("div", {class: "both"}, curve, h("div", {}, pattern)));
      this.pattern = new Pattern(pattern);
      this.curveHost = curve;
    }
    take(test) {
      if (test.axes) this.axes = test.axes;
      if (test.state === "writing") { this.words.textContent = "has ended; its files are being written"; this.button.remove(); }
      else if (test.progress) {
        const p = test.progress;
        const loads = p.stage === "loading";
        this.words.textContent = [p.stage, loads ? "stress " + show(p.stress) + " MPa" : null, loads ? "strain " + show(p.strain) + "\u00b710\u207b\u00b3" : null, "step " + p.step.toLocaleString("en"),
          p.steps_per_second ? show(p.steps_per_second) + " steps/s" : null, loads && p.seconds_left !== null ? "about " + duration(p.seconds_left) + " left" : null].filter(Boolean).join("  \u00b7  ");
      }
      if (test.curve) {
        for (const [own, sent] of [["x", "strain"], ["stress", "stress"], ["tensile", "tensile"], ["shear", "shear"]]) {
          this[own].length = Math.min(this[own].length, test.curve.from);
          this[own].push(...test.curve[sent]);
        }
        this.drawCurve();
      }
      this.pattern.take(test);
    }
    drawCurve() {
      const series = [{label: "stress", x: this.x, y: this.stress, color: "ink", width: 2.2}];
      if (this.tensile[this.tensile.length - 1] > 0) series.push({label: "tensile cracks", x: this.x, y: this.tensile, color: "tensile", width: 1.5, right: true, step: true});
      if (this.shear[this.shear.length - 1] > 0) series.push({label: "shear cracks", x: this.x, y: this.shear, color: "shear", width: 1.5, right: true, step: true});
      if (!this.chart) {
        this.curveHost.replaceChildren();
        this.chart = new XYChart(this.curveHost, {x: this.axes.strain + " (10\u207b\u00b3)", y: this.axes.stress + " (MPa)", right: "Cracks", whole: true, height: 290, series});
      } else this.chart.grow(series);
    }
  }

  const title = h("h2", {}, "Running"), words = h("p", {class: "state"}, "connecting"), bar = h("progress", {max: 1, value: 0, "aria-label": "What has ended"});
  const stopRun = sureButton("End the " + live.whole, "End the " + live.whole + "? What it has is kept, and the same command goes on.", () => end("run"));
  const tests = h("div", {class: "tests"}), done = h("ul", {class: "done"}), news = h("p", {class: "news small"});
  const panel = h("section", {class: "live", "aria-label": "What is going on"}, h("div", {class: "top"}, title, stopRun), bar, words, news, tests, done);
  const running = new Map(), found = new Set();
  let reports = null, reload = null, soon = null;
  if (!live.report) {   // no report yet, so the page is ours
    setTheme();
    pageHead("live view", live.name, []);
    followTheme();
  }
  page.querySelector("header").after(panel);
  if (!live.report && live.over) tests.append(h("p", {class: "soft"}, live.one === "test" ? "No test has ended, so there is no report." : "There is no report."));
  redraw.push(() => running.forEach((test) => test.pattern.draw()));

  /** Gives the page below the data of the report as it is now. */
  function renew() {
    fetch("report.html").then((answer) => (answer.ok ? answer.text() : null)).catch(() => null).then((text) => {
      if (text) window.renewPage(JSON.parse(new DOMParser().parseFromString(text, "text/html").getElementById("data").textContent));   // else the next one will do
    });
  }
  function again() { sessionStorage.setItem("live-scroll", String(scrollY)); location.reload(); }
  const scroll = sessionStorage.getItem("live-scroll");
  sessionStorage.removeItem("live-scroll");
  if (scroll) requestAnimationFrame(() => scrollTo(0, Number(scroll)));

  function isOver(text) {
    title.textContent = "The " + live.whole + " has ended";
    stopRun.remove(); bar.remove(); tests.remove(); done.remove(); news.remove();
    panel.classList.add("over");
    words.textContent = text;
    document.title = live.name + " - Feldspar report";
  }
  if (live.over) { isOver(live.over); return; }

  const stream = new EventSource("events");
  stream.onmessage = (event) => {
    const {run, tests: changed} = JSON.parse(event.data);
    panel.classList.remove("lost");
    for (const test of changed) {
      if (test.state === "running" || test.state === "writing") {
        if (!running.has(test.n)) {
          running.set(test.n, new Running(test));
          const behind = [...running.keys()].filter((n) => n > test.n).sort((a, b) => a - b)[0];
          tests.insertBefore(running.get(test.n).element, behind === undefined ? null : running.get(behind).element);
        }
        running.get(test.n).take(test);
      } else {
        if (running.has(test.n)) { running.get(test.n).element.remove(); running.delete(test.n); }
        if (found.has(test.n) || (test.state !== "ended" && test.state !== "failed")) continue;
        found.add(test.n);
        done.prepend(h("li", {}, test.label + ": " + test.words));
      }
    }
    const ended = run.ended + run.failed, waiting = run.tests - ended - running.size;
    title.textContent = run.ending ? "Ending" : run.busy ? "Preparing" : "Running";
    bar.max = run.tests || 1;
    bar.value = ended;
    words.textContent = [run.tests ? ended + " of " + (run.at_most ? "at most " : "") + plural(run.tests, live.one) + " ended" : null, run.failed ? run.failed + " failed" : null, running.size ? running.size + " running" : null,
      waiting > 0 && run.tests ? (run.at_most ? "up to " : "") + waiting + (run.at_most ? " to come" : " waiting") : null, run.busy || null, run.seconds_left !== null && run.tests && !run.ending ? (run.at_most ? "at most " : "") + "about " + duration(run.seconds_left) + " left" : null].filter(Boolean).join("  \u00b7  ");
    document.title = (run.tests ? ended + "/" + run.tests + " " : "") + live.name + " - Feldspar";
    if (window.renewPage) {   // the page below takes newer data
      if (run.over === null && run.reports !== reports) renew();
      reports = run.reports;
    } else if (reports === null) reports = run.reports;
    if (run.over !== null) {
      stream.close();
      isOver(run.over);
      again();   // the page becomes the report of the whole run
    } else if (run.reports > reports) {
      if (!live.report) soon ||= setTimeout(again, 1500);   // not at once: where all is over, that is told next, and the program waits for pages that listen
      else if (!reload) {
        reload = h("button", {type: "button", onclick: again}, "Show them");
        news.replaceChildren("More " + live.one + "s have ended since the report below was made. ", reload);
      }
    }
  };
  stream.onerror = () => {
    if (stream.readyState === EventSource.OPEN) return;
    panel.classList.add("lost");
    words.textContent = "The program does not answer. If it has ended, its results so far are on the disk, where it said at its start.";
  };
})();
