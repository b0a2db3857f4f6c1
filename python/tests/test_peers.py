# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""The comparison of clusterings with other packages, on few points."""

import importlib.util
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dynamic_icp

SCRIPT = pathlib.Path(__file__).parents[2] / "benchmarks" / "hdbscan_peers.py"


@pytest.fixture(scope="module")
def peers():
    spec = importlib.util.spec_from_file_location("hdbscan_peers", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_agreement_counts_points_not_numbers_of_clusters(peers):
    points = peers.blobs(2000, np.random.default_rng(1))
    ours = peers.of_ours(points, 10, 1)
    count = ours["labels"].max() + 1
    assert count > 3
    turned = np.append((np.arange(count) + 1) % count, -1)[ours["labels"]]
    same = {**ours, "labels": turned}
    assert peers.agreement(ours, same) == [str(count), "100.00", "0", "100.00", "0.0e+00"]

    inside = np.flatnonzero((ours["labels"] >= 0) & ~np.isin(ours["lambdas"], ours["births"]))[:4]
    turned = turned.copy()
    turned[inside] = -1
    lambdas = ours["lambdas"].copy()
    lambdas[inside[0]] *= 1.25
    other = {**ours, "labels": turned, "lambdas": lambdas}
    assert peers.agreement(ours, other) == [str(count), "99.80", "4", "99.80", "2.5e-01"]


def test_the_comparison_says_which_package_is_there(peers):
    words = [sys.executable, str(SCRIPT), "--sizes", "600", "--rounds", "1"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert f"ours: {dynamic_icp.__version__}" in done.stdout
    rows = [
        [cell.strip() for cell in line.split("|")[1:-1]] for line in done.stdout.splitlines() if line.startswith("| ")
    ]
    results = [row for row in rows if len(row) == 8 and row[0] == "600"]
    assert {tuple(row[4:]) for row in results if row[2] == "ours"} == {("100.00", "0", "100.00", "0.0e+00")}
    if importlib.util.find_spec("hdbscan") is None:
        assert "hdbscan: not there" in done.stdout
    else:  # the same tree, to the last bits of a distance
        exact = [row for row in results if row[2].startswith("hdbscan exact")]
        assert len(exact) == 4 and all(row[5] == "0" and float(row[7]) < 1e-9 for row in exact)
