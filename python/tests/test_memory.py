# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Nothing leaks: the memory of a long stream of large scans stays flat. DYNAMIC_ICP_ROUNDS=1000 for all of it."""

import ctypes
import gc
import os
import pathlib

import numpy as np
import pytest

import dynamic_icp

STATUS = pathlib.Path("/proc/self/statm")
LIBC = ctypes.CDLL(None)
WARM_UP = 8
ROUNDS = int(os.environ.get("DYNAMIC_ICP_ROUNDS", "20"))


def resident_mib():
    """What is in use: free memory, which several threads leave in places that differ from run to run, goes back first."""
    gc.collect()
    if hasattr(LIBC, "malloc_trim"):  # glibc
        LIBC.malloc_trim(0)
    return int(STATUS.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def room(count):
    """Points on the walls of a room around a sensor at rest, with some noise of the Doppler."""
    random = np.random.default_rng(1)
    points = random.uniform([-20, -15, -2], [20, 15, 6], size=(count, 3))
    axis = random.integers(3, size=count)
    sides = np.array([[-20, -15, -2], [20, 15, 6]])[random.integers(2, size=count), axis]
    points[np.arange(count), axis] = sides + random.normal(scale=0.01, size=count)
    return points, random.normal(scale=0.05, size=count)


@pytest.mark.skipif(not STATUS.exists(), reason="needs /proc")
def test_a_million_points_a_scan_leak_nothing():
    points, doppler = room(1_000_000)
    times = np.linspace(0, 0.1, len(points))
    odometry = dynamic_icp.Odometry()
    for k in range(ROUNDS):
        frame = odometry.process(points, doppler, times, stamp_ns=100_000_000 * k)
        if k == WARM_UP:
            begin = resident_mib()
    assert frame.status == "ok" and len(frame.labels) == len(points)
    print(f"{ROUNDS} rounds: {begin:.0f} MiB after {WARM_UP}, {resident_mib():.0f} MiB at the end")
    # One array of the scan kept in each round would be 4 MiB (labels) to 23 MiB (points) a round.
    assert resident_mib() - begin < max(20, 0.05 * (ROUNDS - WARM_UP))
