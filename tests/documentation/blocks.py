#!/usr/bin/env python3
"""Runs what tutorial and how-tos tell a reader to do, block by block, as a reader would: in an empty directory, from top to bottom.

usage: blocks.py FELDSPAR [--all] [--keep DIRECTORY] [PAGE ...]

Pages are docs/first-rock.md, docs/own-test.md and docs/how-to/*.md unless given. A comment on the line before a block says what to do with it:

    (none), ```sh      the commands are run; a command that fails is an error
    (none), ```toml    the file is written under the name in its first line, `# granite.toml`, and `feldspar check` takes it, if it is a job
    <!-- add -->       of ```toml: these lines are put behind those of the page's last file with that name, which is checked again
    <!-- slow -->      run with --all only; what follows on the page and needs it says so, too
    <!-- shown -->     not run: output, or something that needs what a test does not have
    <!-- exit 2 -->    of ```sh: the last command ends with this exit code

Blocks of other languages, or of none, are output and not run. Beside that every command with options that any page names, run or not, is held against
`feldspar COMMAND --help`. Exit code 0: fine; 1: a block fails, a marker is not known, or a page names an option that the program does not have.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
SMALL = "times as wide as its largest grain"     # the one warning that a job of these pages may give: they are small to be quick
BLOCK = re.compile(r"^(?:<!-- *([^\n]*?) *-->\n)?^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def run(commands, where, environment, seconds):
    script = "set -euo pipefail\n" + commands
    return subprocess.run(["bash", "-c", script], cwd=where, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=seconds, stdin=subprocess.DEVNULL)


def follow(page, feldspar, slow, where):
    """Runs the blocks of one page in the directory `where`; returns sentences on what is wrong, and how many blocks were run."""
    environment = dict(os.environ, PATH=f"{feldspar.parent}:{os.environ['PATH']}")
    for folder in ("examples", "studies"):
        link = where / folder
        if not link.exists():
            link.symlink_to(TOP / folder)
    text, wrong, done = page.read_text(encoding="utf-8"), [], 0
    for match in BLOCK.finditer(text):
        marker, language, body = match.group(1) or "", match.group(2), match.group(3)
        place = f"{page.relative_to(TOP)}:{text.count(chr(10), 0, match.start(3))}"
        known = re.fullmatch(r"add|slow|shown|exit \d+|slow, exit \d+", marker)
        if marker and not known:
            wrong.append(f"{place}: no such marker: {marker}")
            continue
        if marker == "shown" or language not in ("sh", "toml") or (marker.startswith("slow") and not slow):
            continue
        done += 1
        if language == "toml":
            name = re.match(r"# (\S+\.toml)", body)
            if not name:
                wrong.append(f"{place}: the first line does not name the file")
                continue
            file = where / name.group(1)
            file.write_text((file.read_text(encoding="utf-8") if marker == "add" else "") + body, encoding="utf-8")
            if not re.search(r"^\[specimen\]", file.read_text(encoding="utf-8"), flags=re.MULTILINE):
                continue                       # a study or a calibration: the commands on the page read it
            body, expected = f"feldspar check {file.name}", 0
        else:
            expected = int(re.search(r"\d+", marker).group(0)) if "exit" in marker else 0
        began = time.monotonic()
        try:
            outcome = run(body, where, environment, 3600 if slow else 300)
        except subprocess.TimeoutExpired:
            wrong.append(f"{place}: takes too long")
            continue
        if outcome.returncode != expected:
            wrong.append(f"{place}: ends with {outcome.returncode}, not {expected}:\n{outcome.stdout[-2000:]}")
        elif language == "toml" and any("warning:" in line and SMALL not in line for line in outcome.stdout.splitlines()):
            wrong.append(f"{place}: warns:\n{outcome.stdout[-2000:]}")
        print(f"{place}: {time.monotonic() - began:.1f} s")
    return wrong, done


def unknown_options(feldspar):
    """Sentences on options of `feldspar COMMAND` in pages, examples and studies that the program does not know."""
    known, wrong = {}, []

    def help_of(command):
        if command not in known:
            answer = subprocess.run([feldspar, *command.split(), "--help"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            known[command] = (answer.returncode == 0, set(re.findall(r"--[a-zA-Z][\w-]*", answer.stdout)))
        return known[command]

    files = [*TOP.glob("*.md"), *(f for folder in ("docs", "examples", "studies") for f in (TOP / folder).rglob("*") if f.suffix in (".md", ".toml"))]
    for file in files:
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            for match in re.finditer(r"\bfeldspar (study (?:status|table|gather)\b|[a-z][a-z-]+)((?:[^`|;&#\n]|\|(?= ))*)", line):
                command, rest = match.groups()
                fine, options = help_of(command)
                named = re.findall(r"(?<![\w-])--[a-zA-Z][\w-]*", rest)
                if named and not fine:
                    wrong.append(f"{file.relative_to(TOP)}:{number}: no such command: feldspar {command}")
                wrong += [f"{file.relative_to(TOP)}:{number}: feldspar {command} has no option {option}" for option in named if fine and option not in options]
    return wrong


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("feldspar", type=pathlib.Path)
    options.add_argument("--all", action="store_true")
    options.add_argument("--keep", type=pathlib.Path, help="the directory to work in, which stays")
    options.add_argument("pages", nargs="*", type=pathlib.Path)
    given = options.parse_intermixed_args()
    pages = [page.resolve() for page in given.pages] or [TOP / "docs/first-rock.md", TOP / "docs/own-test.md", *sorted((TOP / "docs/how-to").glob("*.md"))]
    wrong, done = unknown_options(given.feldspar.resolve()), 0
    for page in pages:
        with tempfile.TemporaryDirectory() as folder:
            where = given.keep / page.stem if given.keep else pathlib.Path(folder)
            where.mkdir(parents=True, exist_ok=True)
            found, count = follow(page, given.feldspar.resolve(), given.all, where)
            wrong += found
            done += count
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    print(f"{len(pages)} pages, {done} blocks run, {len(wrong)} wrong")
    return 1 if wrong or not done else 0


if __name__ == "__main__":
    sys.exit(main())
