#!/usr/bin/env python3
"""What Dynamic-ICP costs more when it is called from Python, on recordings of swept scans.

usage: python_cost.py [--speed PROGRAM] [--threads N] [--rounds N] RECORDING...     PYTHONPATH must lead to dynamic_icp

Each round processes every scan once by dynamic-icp-speed (C++) and once from Python, in turn, each in a process of its own,
scans loaded before; the first three scans are for warming up. Of the rounds the least counts: what else runs on the machine
makes it slower, never faster. CPU is the processor time of all threads, mean of the scans, p50 the median of the time that passes. "Of the call" is what a call from Python takes beyond the time that
the library itself states for the scan (milliseconds["total"]): taking arrays over, and handing results out.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

WARM_UP = 3


def measure(recording: str, threads: int) -> dict[str, list[float]]:
    """Milliseconds of each scan, and those that the library states."""
    import dynamic_icp

    scans = list(dynamic_icp.open(recording))
    odometry = dynamic_icp.Odometry(threads=threads)
    times: dict[str, list[float]] = {"ms": [], "cpu_ms": [], "library_ms": []}
    for scan in scans:
        begin, cpu_begin = time.perf_counter(), time.process_time()
        frame = odometry.process(scan)
        times["cpu_ms"].append(1000 * (time.process_time() - cpu_begin))
        times["ms"].append(1000 * (time.perf_counter() - begin))
        times["library_ms"].append(frame.milliseconds["total"])
    return {name: values[WARM_UP:] for name, values in times.items()}


def child(words: list[str]) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "times.json"
        subprocess.run([*words, "--output", str(output)], check=True, stdout=subprocess.DEVNULL)
        return json.loads(output.read_text())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--speed", default="build/dynamic-icp-speed")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--output", type=pathlib.Path, help=argparse.SUPPRESS)  # of a child
    options = parser.parse_args()
    if options.output:
        options.output.write_text(json.dumps(measure(options.recordings[0], options.threads)))
        return
    print("| recording | CPU, C++ [ms] | Python [ms] | more [%] | p50, C++ [ms] | Python [ms] | more [%] | of the call [ms] |")
    print("|---|---|---|---|---|---|---|---|")
    for recording in options.recordings:
        cpp: list[tuple[float, float]] = []  # CPU, p50
        python: list[tuple[float, float]] = []
        call = []
        for _ in range(options.rounds):
            words = [recording, "--threads", str(options.threads)]
            row = child([options.speed, *words, "--presets", "default", "--repeat", "1", "--quiet"])["rows"][0]
            cpp.append((row["cpu_ms"], row["p50_ms"]))
            here = child([sys.executable, __file__, *words])
            python.append((float(np.mean(here["cpu_ms"])), float(np.median(here["ms"]))))
            call.append(np.subtract(here["ms"], here["library_ms"]))
        cells = [pathlib.Path(recording).name]
        for of_cpp, of_python in zip(np.min(cpp, axis=0), np.min(python, axis=0)):
            cells += [f"{of_cpp:.2f}", f"{of_python:.2f}", f"{100 * (of_python / of_cpp - 1):+.1f}"]
        cells.append(f"{np.median(np.min(call, axis=0)):.2f}")  # of each scan the least of the rounds
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
