# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Types, documents and examples."""

import doctest
import importlib.util
import inspect
import os
import pathlib
import shutil
import subprocess
import sys

import pytest
from conftest import run_program

import dynamic_icp

SOURCES = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = SOURCES / "examples" / "python"
ENVIRONMENT = {
    **os.environ,
    "PYTHONPATH": str(pathlib.Path(dynamic_icp.__file__).parents[1]),
    "MYPYPATH": str(pathlib.Path(dynamic_icp.__file__).parents[1]),
}


def run_module(*words, folder=SOURCES):
    done = subprocess.run(
        [sys.executable, *map(str, words)], capture_output=True, text=True, check=False, env=ENVIRONMENT, cwd=folder
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


needs_mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")


@needs_mypy
def test_types_are_strict(tmp_path):
    files = [SOURCES / "python" / "dynamic_icp", *EXAMPLES.glob("*.py")]
    run_module("-m", "mypy", "--strict", "--cache-dir", tmp_path, *files)


@needs_mypy
def test_the_stub_is_that_of_the_extension_module():
    allowed = SOURCES / "python" / "tests" / "stubtest_allowed.txt"
    run_module("-m", "mypy.stubtest", "dynamic_icp._core", "--ignore-missing-stub", "--allowlist", allowed)


def test_everything_public_is_documented():
    for name in dynamic_icp.__all__:
        public = getattr(dynamic_icp, name)
        if inspect.isclass(public):
            members = [value for key, value in vars(public).items() if not key.startswith("_")]
            methods = [one.fget if isinstance(one, property) else one for one in members]
            assert all(inspect.getdoc(one) for one in methods if inspect.isfunction(one)), name
        if callable(public):
            assert inspect.getdoc(public), name


def test_examples_in_docstrings_are_right():
    modules = [sys.modules[name] for name in sorted(sys.modules) if name.split(".")[0] == "dynamic_icp"]
    results = [doctest.testmod(module) for module in modules if hasattr(module, "__file__")]
    assert sum(result.attempted for result in results) >= 6 and sum(result.failed for result in results) == 0


@pytest.mark.parametrize("script", sorted(path.name for path in EXAMPLES.glob("*.py")))
def test_examples_run(script, folder, tmp_path):
    words = [str(folder)] if "sys.argv" in (EXAMPLES / script).read_text(encoding="utf-8") else []
    assert run_module(EXAMPLES / script, *words, folder=tmp_path)


def test_the_notebook_runs(tmp_path):
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    shutil.copy(EXAMPLES / "quickstart.ipynb", tmp_path)
    run_module("-m", "nbconvert", "--to", "notebook", "--execute", "quickstart.ipynb", "--output", "done", folder=tmp_path)
    assert "image/svg" in (tmp_path / "done.ipynb").read_text(encoding="utf-8")


def test_the_module_is_the_program():
    assert dynamic_icp.__version__ in run_program("--version")[0]
    run_program("--no-such-option", status=2)
