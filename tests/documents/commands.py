#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Runs every command and every piece of Python that the documents show.

usage: commands.py PROGRAM PYTHON_FOLDER [PAGE...]     default: all pages

Each page has a folder of its own, in which its blocks ```bash, ```sh and ```python run in their order; Python blocks share
their names. The words of inputs.py (RECORDING, drive.mcap, ...) are made before. What is not run is listed in not_run.py
with the reason. Status 77 without NumPy.
"""

import contextlib
import importlib.util
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import traceback

SOURCES = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["README.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md", "docs/results/*.md", "docs/derivations/*.md", "docs/site/*.md"]
BLOCK = re.compile(r"^```(bash|sh|python)\n(.*?)^```", re.DOTALL | re.MULTILINE)
# The simulator makes short drives here, whatever length a page asks for.
SHORT_DRIVES = """#!/usr/bin/env python3
import os, sys
words = sys.argv[1:]
if words[:1] == ["simulate"] and "--output" in words:
    if "--frames" not in words:
        words += ["--frames", "{frames}"]
    at = words.index("--frames") + 1
    words[at] = str(min(int(words[at]), {frames}))
os.execv({program!r}, ["dynamic-icp", *words])
"""
FRAMES = 12


def commands(block: str) -> list[str]:
    """The block command by command: a line, or lines that only together are one (loops, continued lines)."""
    found: list[str] = []
    pending = ""
    for line in block.splitlines():
        pending += line + "\n"
        if not line.endswith("\\") and subprocess.run(["bash", "-n", "-c", pending], capture_output=True, check=False).returncode == 0:
            if pending.split("#")[0].strip():
                found.append(pending)
            pending = ""
    return found + ([pending] if pending else [])


class Sandbox:
    """The folder of a page."""

    def __init__(self, folder: pathlib.Path, program: pathlib.Path, module: pathlib.Path) -> None:
        self.folder = folder
        self.names: dict[str, object] = {}
        build = folder / "build"
        build.mkdir()
        wrapper = build / "dynamic-icp"
        wrapper.write_text(SHORT_DRIVES.format(frames=FRAMES, program=str(program)), encoding="utf-8")
        wrapper.chmod(0o755)
        for other in program.parent.glob("dynamic-icp-*"):
            (build / other.name).symlink_to(other)
        if module.is_dir():
            (build / "python").symlink_to(module)
        for name in ("scripts", "docs", "examples", "manifests", "benchmarks", "tests"):
            (folder / name).symlink_to(SOURCES / name)
        self.environment = {
            **os.environ,
            "PATH": f"{build}:/usr/bin:{os.environ['PATH']}",
            "PYTHONPATH": str(module),
            "PYTHONDONTWRITEBYTECODE": "1",
            "MPLBACKEND": "svg",
        }

    def shell(self, block: str) -> str:
        """Runs a block; what it printed where it failed, else nothing."""
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", block],
            cwd=self.folder, env=self.environment, text=True, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=900,
        )
        return "" if done.returncode == 0 else f"status {done.returncode}\n{done.stdout[-3000:]}"

    def python(self, block: str, page: str) -> str:
        """The same for Python, which goes on with the names of the blocks before."""
        shown = io.StringIO()
        before = os.getcwd()
        os.chdir(self.folder)
        try:
            with contextlib.redirect_stdout(shown), contextlib.redirect_stderr(shown):
                exec(compile(block, f"<{page}>", "exec"), self.names)
        except Exception:
            return shown.getvalue()[-1000:] + traceback.format_exc(limit=-3)
        finally:
            os.chdir(before)
        return ""


def run_page(page: str, sandbox: Sandbox, inputs, not_run, has_module: bool) -> tuple[int, list[str]]:
    """How many pieces were run, and what failed."""
    text = (SOURCES / page).read_text(encoding="utf-8")
    count, problems = 0, []
    for language, block in BLOCK.findall(text):
        if language == "python":
            if not has_module or not_run.reason(page, block):
                continue
            inputs.make(block, sandbox.folder)
            problem = sandbox.python(block, page)
            count += 1
        else:
            chosen = [one for one in commands(block) if not not_run.reason(page, one)]
            inputs.make("".join(chosen), sandbox.folder)
            problem = sandbox.shell("".join(chosen)) if chosen else ""
            block = "".join(chosen)
            count += len(chosen)
        if problem:
            problems.append(f"{page}\n{block}--> {problem}")
    return count, problems


def main() -> int:
    if importlib.util.find_spec("numpy") is None:
        print("skipped: NumPy not found (scripts/install_dependencies.sh python)")
        return 77
    program, module = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    sys.path.insert(0, str(module))
    has_module = (module / "dynamic_icp" / "__init__.py").is_file()
    if has_module:
        os.environ["MPLBACKEND"] = "svg"
    import inputs as inputs_module
    import not_run as not_run_module

    pages = sys.argv[3:] or sorted(str(path.relative_to(SOURCES)) for glob in PAGES for path in SOURCES.glob(glob))
    not_run = not_run_module.NotRun()
    problems, total = [], 0
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        inputs = inputs_module.Inputs(work / "inputs", program)
        for number, page in enumerate(pages):
            folder = work / str(number)
            folder.mkdir()
            count, failed = run_page(page, Sandbox(folder, program, module), inputs, not_run, has_module)
            total += count
            problems += failed
            if count or failed:
                print(f"{page}: {count} run, {len(failed)} blocks failed", flush=True)
    if not sys.argv[3:]:
        problems += [f"not_run.py: nothing is like {unused}" for unused in not_run.unused()]
        if total < 50:
            problems.append(f"only {total} commands found")
    print(*problems, sep="\n\n")
    print(f"{total} commands and pieces of Python run, {not_run.count} not (tests/documents/not_run.py says why)")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
