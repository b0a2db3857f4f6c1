# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""What the tests of the Python package share: a short simulated drive, and the program to compare with."""

import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dynamic_icp


def run_program(*arguments, status=0):
    """Runs the program and gives what it printed on standard output and standard error."""
    words = [sys.executable, "-m", "dynamic_icp", *map(str, arguments)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stderr
    return done.stdout, done.stderr


@pytest.fixture(scope="session")
def drive():
    """Few points and scans of a city with traffic."""
    return dynamic_icp.simulate("city", frames=6, lidar={"columns": 300, "rows": 32})


@pytest.fixture(scope="session")
def folder(drive, tmp_path_factory):
    """The same as a recording."""
    path = tmp_path_factory.mktemp("recording") / "city"
    drive.save(path)
    return path


@pytest.fixture(scope="session")
def program_run(folder, tmp_path_factory):
    """What the program makes of it."""
    output = tmp_path_factory.mktemp("run") / "run"
    run_program("run", folder, "--output", output, "--save-labels", "--save-map", output / "map.ply", "--quiet")
    return pathlib.Path(output)


@pytest.fixture
def static_scan():
    """Points all around a sensor that moves with (10, -1, 0.5) m/s, without any error."""
    random = np.random.default_rng(4)
    directions = random.normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = directions * random.uniform(5, 60, size=(2000, 1))
    return dynamic_icp.Scan(points, -directions @ np.array([10.0, -1.0, 0.5]))
