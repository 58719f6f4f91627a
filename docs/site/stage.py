#!/usr/bin/env python3
"""Lays the documentation out for mkdocs: pages of docs, examples and studies, and the files that they link to.

usage: stage.py OUTPUT_DIRECTORY

In the repository a link leads to a file of the repository. Here every link is turned into one that leads to a page of the site: a folder to its README, a job
or a program to a page that shows it, beside which the file itself lies. Citations of equations, such as (P31), become links to the equation. A link that leads
nowhere ends this program with exit code 1. Writes OUTPUT_DIRECTORY/mkdocs.yml and OUTPUT_DIRECTORY/source.
"""
import os
import pathlib
import re
import shutil
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
PAGES = {"ARCHITECTURE.md": "project/architecture.md", "CONTRIBUTING.md": "project/contributing.md", "CHANGELOG.md": "project/changelog.md"}
SHOWN = {".toml": "toml", ".py": "python", ".cpp": "cpp", ".hpp": "cpp", ".sh": "bash", ".txt": "text", ".js": "javascript"}     # files that become a page
COPIED = {".csv", ".tess", ".png", ".svg", ".h5", ".msh"}                                     # files that are copied as they are
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^()\s]+)\)")
CITATION = re.compile(r"(?<![\[\w])\(([STCGHMLP]\d+)\)(?!\()")
OUTSIDE = re.compile(r"^[a-z]+:|^#")


def place(path):
    """Where a page of the repository lies in the site, as a path from the site's root; None if it is not a part of it."""
    path = str(path)
    if path in PAGES:
        return PAGES[path]
    if path == "README.md":
        return "index.md"          # the start page says what the README says
    if path.startswith("docs/site/"):
        return None
    if path.endswith(".md") and path.startswith(("docs/", "examples/", "studies/")):
        path = path[5:] if path.startswith("docs/") else path
        return re.sub(r"(^|/)README\.md$", r"\1index.md", path)
    return None


class Stage:
    def __init__(self, output):
        self.output = output
        self.source = output / "source"
        self.wrong = []
        self.equations = {}        # number -> page of the site
        self.made = set()

    def write(self, name, text):
        file = self.source / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def beside(self, path):
        """Where a file lies that is no page."""
        path = str(path)
        return path[5:] if path.startswith("docs/") else path

    def target(self, path, page):
        """The place in the site of a file or folder of the repository that `page` links to; makes what is not there yet."""
        file = TOP / path
        if file.is_dir():
            if (file / "README.md").exists():
                return place(os.path.join(path, "README.md"))
            return self.listing(path)
        if not file.exists():
            self.wrong.append(f"{page}: no such file: {path}")
            return None
        known = place(path)
        if known:
            return known
        name = self.beside(path)
        if file.suffix in SHOWN:
            return self.shown(path, name)
        if file.suffix not in COPIED:
            name += ".txt"
        if name not in self.made:
            self.made.add(name)
            (self.source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, self.source / name)
        return name

    def shown(self, path, name):
        """The page that shows a job or a program; the file itself lies beside it."""
        page = name + ".md"
        if page not in self.made:
            self.made.add(page)
            (self.source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(TOP / path, self.source / name)
            text = (TOP / path).read_text(encoding="utf-8")
            lines = "`" * 3 if "```" not in text else "~" * 5
            self.write(page, f"# {path}\n\n[Save the file]({os.path.basename(name)}){{ download }}\n\n{lines}{SHOWN[(TOP / path).suffix]}\n{text.rstrip()}\n{lines}\n")
        return page

    def listing(self, path):
        page = self.beside(path).rstrip("/") + "/index.md"
        if page not in self.made:
            self.made.add(page)
            names = sorted(p for p in (TOP / path).iterdir() if p.is_file())
            rows = [f"* [{p.name}]({os.path.relpath(self.target(str(p.relative_to(TOP)), page), os.path.dirname(page))})" for p in names]
            self.write(page, f"# {path.rstrip('/')}\n\n" + "\n".join(rows) + "\n")
        return page

    def link(self, match, path, name):
        words, target = match.groups()
        if OUTSIDE.search(target):
            return match.group(0)
        target, _, anchor = target.partition("#")
        found = self.target(os.path.normpath(os.path.join(os.path.dirname(path), target)), path)
        if found is None:
            return match.group(0)
        return f"{words}({os.path.relpath(found, os.path.dirname(name) or '.')}{'#' + anchor if anchor else ''})"

    def citation(self, match, name):
        number = match.group(1)
        if number not in self.equations:
            return match.group(0)
        return f"[({number})]({os.path.relpath(self.equations[number], os.path.dirname(name) or '.')}#{number})"

    def page(self, path, name):
        """One page: links and citations outside of code and formulas; an anchor before each numbered equation."""
        text, kept = (TOP / path).read_text(encoding="utf-8"), []

        def keep(match):
            block = match.group(0)
            number = re.search(r"\\tag\{([A-Z]\d+)\}", block)
            if number and re.match(r"[ \t]*```math", block):
                indent = re.match(r"[ \t]*", block).group(0)
                block = f'{indent}<span id="{number.group(1)}"></span>\n\n{block}'
            kept.append(block)
            return f"\0{len(kept) - 1}\0"

        text = re.sub(r"<!--.*?-->\n?", "", text, flags=re.DOTALL)
        text = re.sub(r"^([ \t]*)(```|~~~)[^\n]*\n.*?^\1\2[ \t]*$", keep, text, flags=re.DOTALL | re.MULTILINE)
        text = re.sub(r"(?<!`)(`+)(?!`)[^\n]*?(?<!`)\1(?!`)|\$[^$\n]+\$", keep, text)
        text = LINK.sub(lambda m: self.link(m, path, name), text)
        parts = re.split(r"(^#+ [^\n]*$)", text, flags=re.MULTILINE)
        text = "".join(part if part.startswith("#") else CITATION.sub(lambda m: self.citation(m, name), part) for part in parts)
        # numbers without a displayed formula begin their paragraph
        text = re.sub(r"^\(([A-Z]\d+)\)", r'<span id="\1"></span>(\1)', text, flags=re.MULTILINE)
        text = re.sub(r"^\[\(([A-Z]\d+)\)\]\([^)]*\)", lambda m: f'<span id="{m.group(1)}"></span>({m.group(1)})' if self.equations.get(m.group(1)) == name else m.group(0),
                      text, flags=re.MULTILINE)
        while "\0" in text:
            text = re.sub(r"\0(\d+)\0", lambda m: kept[int(m.group(1))], text)
        self.write(name, text)

    def navigation(self):
        """mkdocs.yml with the starred lines written out."""
        lines = (TOP / "docs/site/mkdocs.yml").read_text(encoding="utf-8").splitlines()
        named = {m.group(1) for line in lines for m in [re.match(r"\s*- (\S+\.md)$", line)] if m and "*" not in line}
        for page in named:
            if not (self.source / page).exists():
                self.wrong.append(f"docs/site/mkdocs.yml: no such page: {page}")
        written = []
        for line in lines:
            starred = re.match(r"(\s*)- (\S*\*\S*)$", line)
            if not starred:
                written.append(line)
                continue
            pattern = starred.group(2) if starred.group(2).endswith(".md") else starred.group(2) + ".md"
            for file in sorted(self.source.glob(pattern)):
                page = file.relative_to(self.source).as_posix()
                if page not in named and page[:-3] not in self.made and page not in self.made:
                    written.append(f"{starred.group(1)}- {page}")
        (self.output / "mkdocs.yml").write_text("\n".join(written) + "\n", encoding="utf-8")

    def run(self):
        shutil.rmtree(self.source, ignore_errors=True)
        pages = sorted(p.relative_to(TOP).as_posix() for folder in ("docs", "examples", "studies") for p in (TOP / folder).rglob("*.md")) + list(PAGES)
        pages = [(path, place(path)) for path in pages if place(path)]
        for path, name in pages:
            for m in re.finditer(r"\\tag\{([A-Z]\d+)\}|^\(([A-Z]\d+)\)", (TOP / path).read_text(encoding="utf-8"), flags=re.MULTILINE):
                if path.startswith("docs/theory/"):
                    self.equations[m.group(1) or m.group(2)] = name
        for path, name in pages:
            self.page(path, name)
        self.navigation()
        for sentence in self.wrong:
            print(sentence, file=sys.stderr)
        return 1 if self.wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(Stage(pathlib.Path(sys.argv[1])).run())
