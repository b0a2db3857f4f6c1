#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""HDBSCAN of Dynamic-ICP beside the packages of Python that have it: hdbscan, and scikit-learn 1.3 or newer.

usage: hdbscan_peers.py [--sizes N...] [--samples N] [--rounds N] [--limit SECONDS] [--peers PYTHON]

PYTHONPATH must lead to dynamic_icp.

Two tables: how long each takes, and how far each agrees with ours: share of the points in the same cluster, how many are in
another though no tie left a choice, share of the points with the same probability, too, and the largest relative difference of
the lambda at which a point leaves the tree, which ties cannot change. Whichever package can be imported is measured; it says
which cannot. Points are in space: ours takes two or three dimensions only, the packages any number.

Each round runs all in turn, each in a process of its own that has clustered a few points before, and the least of the rounds
counts: what else runs on the machine makes it slower, never faster. CPU is the processor time of that process; jobs of hdbscan
are processes of their own, whose time is not in it. What would keep the processor longer than the limit, by the square
of the number of points, is left out. `--peers` names another interpreter for the packages.
"""
import argparse
import importlib
import pathlib
import subprocess
import sys
import tempfile
import time
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]  # (N, 3), m
Result = dict[str, Any]

MIN_CLUSTER_SIZE = 30
SAME = 1e-9  # how far two computations of a probability may differ


# `samples`: neighbours, the point itself not counted.


def of_ours(points: Points, samples: int, threads: int) -> Result:
    dynamic_icp = importlib.import_module("dynamic_icp")
    found = dynamic_icp.hdbscan(points, min_cluster_size=MIN_CLUSTER_SIZE, min_samples=samples, threads=threads)
    result = {"labels": found.labels, "probabilities": found.probabilities}
    return {**result, "lambdas": found.tree.point_lambda, "births": found.tree.birth}


def of_hdbscan(points: Points, samples: int, **options: Any) -> Result:
    module = importlib.import_module("hdbscan")
    found = module.HDBSCAN(min_cluster_size=MIN_CLUSTER_SIZE, min_samples=samples, **options).fit(points)
    result = {"labels": found.labels_, "probabilities": found.probabilities_}
    tree = found._condensed_tree  # the raw array; condensed_tree_ wraps it
    leaves = tree[tree["child"] < len(points)]
    result["lambdas"] = np.zeros(len(points))
    result["lambdas"][leaves["child"]] = leaves["lambda_val"]
    return result


def of_sklearn(points: Points, samples: int) -> Result:
    cluster = importlib.import_module("sklearn.cluster")  # counts the point itself among its neighbours
    found = cluster.HDBSCAN(min_cluster_size=MIN_CLUSTER_SIZE, min_samples=samples + 1, copy=True).fit(points)
    return {"labels": found.labels_, "probabilities": found.probabilities_}


# Algorithm "best" of hdbscan is boruvka_kdtree for points like these. By default its spanning tree is approximate.
IMPLEMENTATIONS: dict[str, Callable[[Points, int], Result]] = {
    "ours, 1 thread": lambda points, samples: of_ours(points, samples, 1),
    "ours": lambda points, samples: of_ours(points, samples, 0),
    "hdbscan exact, 1 job": lambda points, samples: of_hdbscan(
        points, samples, approx_min_span_tree=False, core_dist_n_jobs=1
    ),
    "hdbscan exact": lambda points, samples: of_hdbscan(points, samples, approx_min_span_tree=False),
    "hdbscan default, 1 job": lambda points, samples: of_hdbscan(points, samples, core_dist_n_jobs=1),
    "hdbscan default": lambda points, samples: of_hdbscan(points, samples),
    "scikit-learn": of_sklearn,
}
REFERENCE = "ours, 1 thread"


def measure(name: str, points: Points, samples: int) -> Result:
    """Result and times of one implementation, ms."""
    run = IMPLEMENTATIONS[name]
    run(points[:300], samples)  # imports, starts threads and jobs
    begin, cpu_begin = time.perf_counter(), time.process_time()
    result = run(points, samples)
    result["cpu_ms"] = 1000 * (time.process_time() - cpu_begin)
    result["ms"] = 1000 * (time.perf_counter() - begin)
    return result


VERSIONS = {  # what prints it
    "ours": "import dynamic_icp; print(dynamic_icp.__version__)",
    "hdbscan": "import hdbscan, importlib.metadata; print(importlib.metadata.version('hdbscan'))",
    "scikit-learn": "import sklearn; from sklearn.cluster import HDBSCAN; print(sklearn.__version__)",
}


def version(python: str, code: str) -> Optional[str]:
    """Of a package; None where it cannot be imported."""
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def blobs(count: int, random: np.random.Generator) -> Points:
    """Twenty clusters of unlike density in a tenth of noise, m."""
    centres, spread = random.uniform(-40, 40, size=(20, 3)), random.uniform(0.3, 3.0, size=20)
    of = random.integers(20, size=count)
    points: Points = centres[of] + random.normal(size=(count, 3)) * spread[of, None]
    noise = random.random(count) < 0.1
    points[noise] = random.uniform(-50, 50, size=(noise.sum(), 3))
    return points


def city(count: int, random: np.random.Generator) -> Points:
    """So many points of simulated scans of a city, m."""
    dynamic_icp = importlib.import_module("dynamic_icp")
    scans: list[Points] = []
    for scan in dynamic_icp.simulate("city", frames=1 + count // 50000):
        scans.append(np.asarray(scan.points, dtype=np.float64))
    points: Points = np.unique(np.concatenate(scans), axis=0)
    return random.permutation(points)[:count]


def agreement(ours: Result, theirs: Result) -> list[str]:
    """How far a result is ours, as the cells of the second table.

    Clusters have other numbers; each of ours is the one of theirs that has most of its points. Where three parts meet at
    one distance, the order in which they are joined is free, and decides to which cluster a point belongs that leaves just
    where a cluster begins.
    """
    count = ours["labels"].max() + 1
    names = np.full(count + 1, -2)
    names[-1] = -1  # noise
    for number in range(count):
        inside = theirs["labels"][(ours["labels"] == number) & (theirs["labels"] >= 0)]
        names[number] = np.bincount(inside).argmax() if inside.size else -2
    same = names[ours["labels"]] == theirs["labels"]
    close = same & (np.abs(ours["probabilities"] - theirs["probabilities"]) < SAME)
    unexplained = ~same & ~np.isin(ours["lambdas"], ours["births"])
    cells = [
        f"{theirs['labels'].max() + 1}",
        f"{100 * same.mean():.2f}",
        f"{unexplained.sum()}",
        f"{100 * close.mean():.2f}",
    ]
    if "lambdas" not in theirs:
        return [*cells, "-"]
    return [*cells, f"{np.max(np.abs(theirs['lambdas'] / ours['lambdas'] - 1)):.1e}"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[1000, 10000, 100000])
    parser.add_argument("--samples", type=int, default=10, help="neighbours, the point itself not counted")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of the processor; see above")
    parser.add_argument("--peers", default=sys.executable, metavar="PYTHON")
    parser.add_argument("--child", nargs=3, help=argparse.SUPPRESS)  # implementation, points, output
    options = parser.parse_args()
    if options.child:
        name, points, output = options.child
        np.savez(output, **measure(name, np.load(points), options.samples))
        return

    python = {name: sys.executable if name.startswith("ours") else options.peers for name in IMPLEMENTATIONS}
    found = {of: version(sys.executable if of == "ours" else options.peers, code) for of, code in VERSIONS.items()}
    if found["ours"] is None:
        sys.exit("dynamic_icp cannot be imported: set PYTHONPATH")
    for of, number in found.items():
        print(f"{of}: {number or 'not there'}")
    if not found["hdbscan"] and not found["scikit-learn"]:
        print("Neither package to compare with can be imported: ours alone.")
    names = [name for name in IMPLEMENTATIONS if found[next(of for of in found if name.startswith(of))]]

    times = ["", "| points | | " + " | ".join(names) + " |", "|---|---|" + "---|" * len(names)]
    titles = (
        "points",
        "",
        "implementation",
        "clusters",
        "same cluster [%]",
        "others, not by ties",
        "same probability [%]",
    )
    agreements = ["", "| " + " | ".join([*titles, "lambda, relative"]) + " |", "|---|---|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        points_file, output = pathlib.Path(folder) / "points.npy", pathlib.Path(folder) / "result.npz"
        for set_name, points_of in (("blobs", blobs), ("city", city)):
            last: dict[str, tuple[int, float]] = {}  # points, ms of the processor
            for size in options.sizes:
                points = points_of(size, np.random.default_rng(size))
                np.save(points_file, points)
                results: dict[str, list[Result]] = {name: [] for name in names}
                for _ in range(options.rounds):
                    for name in names:
                        before, ms = last.get(name, (size, 0.0))
                        if ms * (size / before) ** 2 > 1000 * options.limit:
                            continue
                        words = [python[name], __file__, "--samples", str(options.samples)]
                        words += ["--child", name, str(points_file), str(output)]
                        subprocess.run(words, check=True)
                        with np.load(output) as result:
                            results[name].append(dict(result))
                cells = [f"{len(points):,}", set_name]
                for name, rounds in results.items():
                    if not rounds:
                        cells.append("-")
                        continue
                    least = [min(float(one[key]) for one in rounds) for key in ("ms", "cpu_ms")]
                    last[name] = (size, least[1])
                    cells.append(f"{least[0]:.1f} ({least[1]:.1f})")
                    if name != REFERENCE:
                        row = [f"{len(points):,}", set_name, name, *agreement(results[REFERENCE][0], rounds[0])]
                        agreements.append("| " + " | ".join(row) + " |")
                times.append("| " + " | ".join(cells) + " |")
                print(times[-1], file=sys.stderr, flush=True)
    print("\nMilliseconds that pass, in brackets of the processor:")
    print("\n".join([*times, *agreements]))


if __name__ == "__main__":
    main()
