#!/usr/bin/env python3
"""Runs every test method on every kind of grain, kills the program at random moments until the run is complete, and compares what is left with an undisturbed run.

    python3 tests/validation/kill_and_go_on.py build/release/feldspar --kills 300

The jobs are the templates of `feldspar new`, with fewer grains. Compared are all histories and events, and the numbers of summary.json but for times.
Ends with 1 when anything differs.
"""
import argparse
import json
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP]
RIGID = '[model]\nkind = "rigid"\n'
INNER = '[model]\nkind = "inner-particles"\n'


def kinds(program):
    text = subprocess.run([program, "new", "nothing"], capture_output=True, text=True).stderr
    allowed = re.search(r"allowed: (.*)", text, re.S).group(1).split("Did you")[0]
    return [word for word in re.findall(r"[a-z-]+", allowed) if word not in ("study", "calibration", "laboratory", "or")]


def job_of(program, kind, grains):
    text = subprocess.run([program, "new", kind], capture_output=True, text=True, check=True).stdout
    text = re.sub(r'minimum = "2 mm", maximum = "4 mm"', 'minimum = "4 mm", maximum = "7 mm"', text, count=1)
    text = re.sub(r'accuracy = "1 %"', 'accuracy = "5 %"\nmaximum_steps = 6000', text, count=1)
    text = re.sub(r"\nseeds = \[1, 2, 3\]", "\nseeds = [1]", text, count=1)
    if grains == "inner-particles":
        text = text.replace("porosity = 0.10", "particles_per_grain = 9\nporosity = 0.10", 1)
    if grains != "flexible":
        text = re.sub(r"\[model\].*?\n\n", (RIGID if grains == "rigid" else INNER) + "\n", text, count=1, flags=re.S)
        text = re.sub(r'\nE = "25.8 GPa" +# Young.*?\nnu = 0.23 +# Poi[^\n]*', "", text, count=1)
    return text


def left(results):
    """What is compared, by file."""
    found = {}
    for file in sorted(results.glob("*.csv")):
        found[file.name] = "".join(line for line in file.read_text().splitlines(True) if not line.startswith("#"))
    tests = json.loads((results / "summary.json").read_text())["tests"]
    for test in tests:
        for key in ("wall_s", "ms_per_step", "threads"):
            test.pop(key, None)
    found["summary.json"] = json.dumps(tests, sort_keys=True)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=300, help="in all, at least")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    chance = random.Random(options.seed)
    kills, wrong, compared, refused = 0, [], 0, []
    cases = [(kind, grains) for kind in kinds(program) for grains in ("flexible", "rigid", "inner-particles")]
    each = -(-options.kills // len(cases))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for kind, grains in cases:
            name = f"{kind}-{grains}"
            (folder / f"{name}.toml").write_text(job_of(program, kind, grains))
            command = [program, "run", f"{name}.toml", "--checkpoint-every", "50 ms"]
            start = time.monotonic()
            whole = subprocess.run(command + ["--out", f"{name}-whole"], cwd=folder, capture_output=True, text=True)
            seconds = time.monotonic() - start
            if whole.returncode != 0:
                refused.append(f"{name}: {whole.stderr.strip().splitlines()[-1][:150]}")
                continue
            here, rounds, same = 0, 0, True
            while here < each and rounds < 30 and same:
                out = f"{name}-{rounds}"
                for attempt in range(200):
                    process = subprocess.Popen(command + ["--out", out, "--threads", str(1 + attempt % 2)], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    try:
                        process.wait(timeout=chance.uniform(0.0, 1.2 * seconds) if here < each and attempt < 10 else None)
                    except subprocess.TimeoutExpired:
                        process.send_signal(chance.choice(SIGNALS))
                        here += 1
                    if process.wait() == 0:
                        break
                same = (folder / out / "summary.json").exists() and left(folder / out) == left(folder / f"{name}-whole")
                rounds += 1
            kills += here
            compared += 1
            if not same:
                wrong.append(name)
            print(f"{name}: {here} kills in {rounds} runs, {'same' if same else 'DIFFERENT'}", flush=True)
    print(f"{kills} kills over {compared} runs; different: {', '.join(wrong) or 'none'}")
    for line in refused:
        print(f"not run: {line}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
