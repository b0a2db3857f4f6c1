#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Makes the C++ reference of the public headers with Doxygen, with a link back to the site.

usage: reference.py SOURCES HEADERS FOLDER

HEADERS is a file with a path a line. Ends with status 1 where Doxygen warns.
"""

import pathlib
import re
import subprocess
import sys
import tempfile


def main() -> int:
    sources, headers, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    own = sources / "docs" / "site"
    version = re.search(r"project\(dynamic_icp VERSION ([0-9.]+)", (sources / "CMakeLists.txt").read_text())
    folder.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        layout = work / "layout.xml"
        subprocess.run(["doxygen", "-l", str(layout)], check=True, stdout=subprocess.DEVNULL)
        back = '<tab type="user" url="../index.html" title="Site"/>\n    <tab type="user" url="../cpp.html" title="Guide"/>\n    '
        layout.write_text(layout.read_text().replace('<tab type="mainpage"', back + '<tab type="mainpage"', 1))
        page = work / "api.md"  # links to documents are those of the site
        page.write_text(re.sub(r"\[(.*?)\]\(\.\./(\w+)\.md\)", r'<a href="../\2.html">\1</a>', (own / "api.md").read_text()))
        settings = (own / "Doxyfile").read_text() + "\n".join(
            [
                "",
                f"PROJECT_NUMBER = {version[1] if version else ''}",
                f"INPUT = {page} {' '.join(headers.read_text().split())}",
                f"USE_MDFILE_AS_MAINPAGE = {page}",
                f"STRIP_FROM_PATH = {sources}",
                f"STRIP_FROM_INC_PATH = {sources}",
                f"LAYOUT_FILE = {layout}",
                f"OUTPUT_DIRECTORY = {folder.parent}",
                f"HTML_OUTPUT = {folder.name}",
                "",
            ]
        )
        done = subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=sources, capture_output=True, check=False)
        print(done.stderr, end="", file=sys.stderr)
        return done.returncode


if __name__ == "__main__":
    sys.exit(main())
