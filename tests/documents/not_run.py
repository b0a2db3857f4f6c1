# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Commands of the documents that are not run by commands.py, and why."""

import re

REASONS = [
    # what a command looks like, why it is not run
    (r"apt-get install|sudo apt ", "installs packages; scripts/check_packages.sh does it in a Debian of its own"),
    (r"git clone", "needs a server"),
    (r"scripts/(demo|build|packages)\.sh", "builds all; scripts/check_packages.sh builds from sources"),
    (r"scripts/install_\w+\.sh", "installs packages"),
    (r"cmake --", "builds all; tests/install_test.sh installs and links"),
    (r"scripts/(benchmark_\w+|mean_over_seeds)\.|benchmarks/summary\.py", "takes an hour"),
    (r"snakemake", "needs Snakemake or Slurm; scripts/test_workflow.sh"),
    (r"dynamic-icp-(speed|kernels)|python_cost|hdbscan_peers", "measures; dynamic-icp-speed is tested where it is built"),
    (r"--live(?!=0)", "takes a port of the machine, which others may have; tests/interop/live.test.mjs"),
    (r"--manifest", "the recordings are not at hand; tests/benchmark_test.cpp"),
    (r"/usr/bin/time|aeries_ii.lidar.rows=32", "measures a drive of 1,000 scans"),
    (r"drive\.bag|rig\.mcap", "bags with these topics are made by tests/bags_test.cpp"),
    (r"check_simulation\.py", "takes minutes; scripts/check.sh"),
    (r"--seed 71 --frames 250", "takes minutes"),
    (r"--seed 151 --frames 40|map_ghosts\.py", "needs SciPy, which nothing else does"),
]


class NotRun:
    def __init__(self) -> None:
        self.used: set[str] = set()
        self.count = 0

    def reason(self, page: str, command: str) -> str:
        """Why a command is not run; empty where it is."""
        for pattern, why in REASONS:
            if re.search(pattern, command):
                self.used.add(pattern)
                self.count += 1
                return why
        return ""

    def unused(self) -> list[str]:
        return [pattern for pattern, _ in REASONS if pattern not in self.used]
