#!/usr/bin/env python3
"""Breaks the source on purpose, one line at a time (mutants.toml), and looks whether the test program that stands beside it notices.

  scripts/quality mutants                  all of them; the result goes to docs/validation/mutants-last-run.md
  scripts/quality mutants polygon- merge-  those whose names begin so; nothing is written

It edits files of this working tree and puts them back, whatever happens but SIGKILL; a file with changes that are not committed is left alone. build/release must have been built.
"""
import datetime
import pathlib
import signal
import subprocess
import sys
import time
import tomllib

root = pathlib.Path(__file__).resolve().parents[2]
longest_s = 900


def ended(*_):
    raise KeyboardInterrupt


def run(*command, timeout=None):
    return subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=timeout)


def build(program):
    return run("cmake", "--build", "build/release", "--target", program)


def first_failure(output):
    for line in output.splitlines():
        if line.startswith("[  FAILED  ]"):
            return line.removeprefix("[  FAILED  ]").split(",")[0].split(" (")[0].strip()
    return "ended by a signal"


def verdict_of(mutant):
    file = root / mutant["file"]
    text = file.read_text()
    if text.count(mutant["from"]) != 1:
        return "stale", f"'{mutant['from']}' stands {text.count(mutant['from'])} times in the file: mend mutants.toml"
    if run("git", "diff", "--quiet", "HEAD", "--", mutant["file"]).returncode != 0:
        return "left out", "the file has changes that are not committed"
    try:
        file.write_text(text.replace(mutant["from"], mutant["to"]))
        built = build(mutant["caught_by"])
        if built.returncode != 0:
            return "does not compile", built.stdout[-300:]
        try:
            tested = run(str(root / "build/release" / mutant["caught_by"]), "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + mutant.get("filter", "*"),
                         timeout=longest_s)
        except subprocess.TimeoutExpired:
            return "caught", f"no end within {longest_s} s"
        return ("caught", first_failure(tested.stdout)) if tested.returncode != 0 else ("lives", "")
    finally:
        file.write_text(text)


def main():
    signal.signal(signal.SIGTERM, ended)
    with open(root / "tests/mutants/mutants.toml", "rb") as stream:
        mutants = tomllib.load(stream)["mutant"]
    names = [mutant["name"] for mutant in mutants]
    assert len(names) == len(set(names)), "two mutants have one name"
    beginnings = tuple(sys.argv[1:])
    chosen = [mutant for mutant in mutants if not beginnings or mutant["name"].startswith(beginnings)]
    rows = []
    try:
        for mutant in chosen:
            start = time.monotonic()
            verdict, why = verdict_of(mutant)
            rows.append((mutant, verdict, why))
            print(f"{len(rows):3d}/{len(chosen)} {verdict:10s} {mutant['name']}: {why}  ({time.monotonic() - start:.0f} s)", flush=True)
    finally:
        for program in sorted({mutant["caught_by"] for mutant in chosen}):
            build(program)   # what stands in build/release is whole again
    caught = sum(verdict == "caught" for _, verdict, _ in rows)
    lives = [mutant["name"] for mutant, verdict, _ in rows if verdict == "lives"]
    print(f"{caught} of {len(rows)} caught; live: {', '.join(lives) or 'none'}")
    if not beginnings:
        commit = run("git", "rev-parse", "--short", "HEAD").stdout.strip()
        lines = ["# Mutants: the last run of all", "",
                 f"`scripts/quality mutants` on commit {commit}, {datetime.date.today()}: {caught} of {len(rows)} caught. What each one is stands in [mutants.toml](../../tests/mutants/mutants.toml);",
                 "formulas that were broken by hand, and what came of it: [mutants.md](mutants.md).", "", "| mutant | file | verdict | first test that failed |", "|---|---|---|---|"]
        lines += [f"| {mutant['name']} | {mutant['file'].removeprefix('src/feldspar/')} | {verdict} | {why.replace('|', '/')} |" for mutant, verdict, why in rows]
        (root / "docs/validation/mutants-last-run.md").write_text("\n".join(lines) + "\n")
    return 0 if caught == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
