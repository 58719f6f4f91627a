#!/usr/bin/env python3
"""Follows every link of the built site: files and anchors that are not there are told, and so is whatever a page would fetch from elsewhere.

usage: links.py SITE_DIRECTORY

Exit code 0: fine; 1: something is wrong, said in words.
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded = {"", "__top"}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        if tag in ("a", "area") and attributes.get("href"):
            self.links.append(attributes["href"])
        for key in ("src", "href"):
            if tag in ("img", "script", "link", "iframe", "source") and attributes.get(key) and attributes.get("rel") not in ("canonical", "next", "prev"):
                self.loaded.append(attributes[key])


def main():
    site = pathlib.Path(sys.argv[1])
    pages = {file.resolve(): Page(file.read_text(encoding="utf-8")) for file in site.rglob("*.html") if file.name != "404.html"}
    wrong = []
    for file, page in pages.items():
        name = file.relative_to(site.resolve())
        for link in page.loaded + page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                if link in page.loaded and url.scheme != "data":
                    wrong.append(f"{name}: fetches {link}")
                continue
            target = (file.parent / urllib.parse.unquote(url.path)).resolve() if url.path else file
            if target.is_dir():
                target /= "index.html"
            if not target.is_file():
                wrong.append(f"{name}: leads nowhere: {link}")
            elif target in pages and urllib.parse.unquote(url.fragment) not in pages[target].anchors:
                wrong.append(f"{name}: no such place on the page: {link}")
    for sentence in sorted(set(wrong)):
        print(sentence, file=sys.stderr)
    print(f"{len(pages)} pages, {sum(len(p.links) + len(p.loaded) for p in pages.values())} links")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main())
