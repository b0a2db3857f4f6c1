#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Checks a site: every link leads to a file and to a place in it, and no page loads anything from a network.

usage: check_links.py SITE
"""

import html.parser
import pathlib
import re
import sys
import urllib.parse

# What a browser fetches by itself, rather than when a reader clicks.
LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("video", "src"),
          ("object", "data"), ("embed", "src")}
ELSEWHERE = re.compile(r"^(https?:)?//", re.IGNORECASE)


class Page(html.parser.HTMLParser):
    """The links of a page and the places in it that links can lead to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.places: set[str] = set()
        self.links: list[tuple[str, str, str]] = []  # tag, attribute, address
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id" or (tag == "a" and name == "name"):
                self.places.add(value or "")
            if name in ("href", "src", "data") and value is not None:
                self.links.append((tag, name, value))


def main() -> int:
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html") if path.name != "404.html"}
    problems, count = [], 0
    for path, page in sorted(pages.items()):
        here = path.relative_to(site)
        for tag, attribute, address in page.links:
            if ELSEWHERE.match(address):
                if (tag, attribute) in LOADED:
                    problems.append(f"{here}: loads {address}")
                continue
            parts = urllib.parse.urlsplit(address)
            if parts.scheme:  # mailto:, data:, javascript:
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.is_relative_to(site) or not target.is_file():
                problems.append(f"{here}: {address}: no such file")
            elif parts.fragment and target in pages:
                place = urllib.parse.unquote(parts.fragment)
                if place == "nested-classes" and here.parts[0] == "api":
                    continue  # of private classes, which Doxygen 1.9.4 leaves out but for this link
                if place not in pages[target].places:
                    problems.append(f"{here}: {address}: no such place")
    for style in site.rglob("*.css"):
        for address in re.findall(r"(?:url\(|@import\s+)[\"']?([^\"')\s]+)", style.read_text(encoding="utf-8")):
            if ELSEWHERE.match(address):
                problems.append(f"{style.relative_to(site)}: loads {address}")
    print(*problems, sep="\n", end="\n" if problems else "", file=sys.stderr)
    print(f"{len(pages)} pages, {count} links within the site, {len(problems)} problems")
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
