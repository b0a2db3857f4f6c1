#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Collects the pages of the site: the documents as they stand in the repository, with links that work on the site.

usage: collect.py SOURCES FOLDER

FOLDER gets mkdocs.yml, pages/ and headers.txt (the public headers, for Doxygen). A link to a document becomes one to its
page; a link to another file or folder of the repository one to a page that shows it. A link to nothing ends with status 1.
"""

import os
import pathlib
import re
import shutil
import sys

# Documents outside docs/, and where they are on the site.
ELSEWHERE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
    "viewer/README.md": "viewer.md",
}
NOT_SHOWN = (".png", ".svg", ".ipynb")
KATEX = pathlib.Path("/usr/share/javascript/katex")


def documents(sources: pathlib.Path) -> dict[pathlib.Path, str]:
    """Every document and its page."""
    pages = {sources / "docs" / path.relative_to(sources / "docs"): path.relative_to(sources / "docs").as_posix()
             for path in (sources / "docs").rglob("*.md") if "site" not in path.relative_to(sources / "docs").parts}
    return pages | {sources / path: page for path, page in ELSEWHERE.items() if path != "README.md"}


def code_page(path: pathlib.Path, name: str) -> str:
    """A page that shows a file, or the files of a folder."""
    files = sorted(one for one in path.iterdir() if one.is_file()) if path.is_dir() else [path]
    text = f"# {name}\n\n"
    for file in files:
        if path.is_dir():
            text += f"## {file.name}\n\n"
        if file.suffix in NOT_SHOWN:
            text += "See the repository.\n\n"
            continue
        language = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".sh": "bash", ".yaml": "yaml"}.get(file.suffix, "text")
        text += f"````{language}\n{file.read_text(encoding='utf-8').rstrip()}\n````\n\n"
    return text


class Collector:
    def __init__(self, sources: pathlib.Path, folder: pathlib.Path) -> None:
        self.sources, self.pages = sources, folder / "pages"
        self.documents = documents(sources)
        self.shown: dict[str, pathlib.Path] = {}  # pages of other files
        self.broken: list[str] = []

    def target(self, document: pathlib.Path, link: str) -> str:
        """What a link of a document is on its page."""
        if not link or link.startswith("#") or "://" in link or link.startswith("mailto:"):
            return link
        path, _, anchor = link.partition("#")
        wanted = pathlib.Path(os.path.normpath(document.parent / path))
        here = pathlib.PurePosixPath(self.documents[document]).parent
        if not wanted.exists() or not wanted.is_relative_to(self.sources):
            self.broken.append(f"{document.relative_to(self.sources)}: {link}")
            return link
        name = wanted.relative_to(self.sources).as_posix()
        if name in ELSEWHERE:
            page = ELSEWHERE[name]
        elif wanted in self.documents:
            page = self.documents[wanted]
        elif wanted == self.sources / "docs" / "derivations":
            page = "derivations/window.md"
        elif wanted.is_file() and name.startswith("docs/"):
            page = name.removeprefix("docs/")
            (self.pages / page).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(wanted, self.pages / page)
        else:
            page = f"repository/{name}.md"
            self.shown[page] = wanted
        return os.path.relpath(page, here) + (f"#{anchor}" if anchor else "")

    def page(self, document: pathlib.Path) -> str:
        parts = re.split(r"(^```.*?^```)", document.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
        for i in range(0, len(parts), 2):  # those between are code
            parts[i] = re.sub(r"\]\(([^)\s]*)\)", lambda found: f"]({self.target(document, found[1])})", parts[i])
        return "".join(parts)

    def collect(self) -> None:
        for document, page in self.documents.items():
            self.write(page, self.page(document))
        for page, path in self.shown.items():
            self.write(page, code_page(path, path.relative_to(self.sources).as_posix()))

    def write(self, page: str, text: str) -> None:
        path = self.pages / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def public_headers(sources: pathlib.Path) -> list[pathlib.Path]:
    """What is installed: the headers that the modules of the libraries declare as public."""
    headers = [sources / "dynamic_icp" / name for name in ("dynamic_icp.hpp", "recording.hpp")]
    for layer in ("method", "recording"):
        for module in sorted((sources / "dynamic_icp" / layer).glob("*/CMakeLists.txt")):
            found = re.search(r"\bHEADERS((?:\s+[a-z_0-9]+\.hpp)+)", module.read_text(encoding="utf-8"))
            headers += [module.parent / name for name in found[1].split()] if found else []
    return headers


def main() -> int:
    sources, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    collector = Collector(sources, folder)
    collector.collect()
    if collector.broken:
        print("links that lead nowhere:", *collector.broken, sep="\n  ", file=sys.stderr)
        return 1
    own = pathlib.Path(__file__).parent
    shutil.copyfile(own / "mkdocs.yml", folder / "mkdocs.yml")
    for name in ("site.css", "math.js"):
        shutil.copyfile(own / name, collector.pages / name)
    if KATEX.exists():
        for name in ("katex.min.js", "katex.min.css"):
            (collector.pages / "katex").mkdir(exist_ok=True)
            shutil.copyfile(KATEX / name, collector.pages / "katex" / name)
        shutil.copytree(KATEX / "fonts", collector.pages / "katex" / "fonts")
    (folder / "headers.txt").write_text("\n".join(map(str, public_headers(sources))) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
