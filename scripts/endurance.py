#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""One run over very many scans: does memory stay flat, time per scan, are all files whole, is the report within its budget?

Simulates drives of different scenes and sensor errors and strings them together by links, again and again, into one recording
of the wanted length. Where one drive follows another, the sensor jumps.

usage: scripts/endurance.py FOLDER [--scans 100000] [--columns 75] [--checkpoint S] [--program build/dynamic-icp]
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import threading
import time

DRIVES = [  # scene, sensor
    ("street", "aeries-ii"),
    ("city", "aeries-ii-real"),
    ("highway", "aeries-ii"),
    ("traffic-jam", "aeries-ii-real"),
    ("roundabout", "aeries-ii"),
    ("tunnel", "aeries-ii-real"),
]
SCANS_OF_A_DRIVE = 200


def simulate(program, folder, columns):
    drives = []
    for seed, (scene, sensor) in enumerate(DRIVES, 1):
        drive = folder / "drives" / f"{scene}-{sensor}"
        if not (drive / "scene.json").exists():
            subprocess.run(
                [program, "simulate", scene, "--seed", str(seed), "--sensor", sensor, "--frames", str(SCANS_OF_A_DRIVE),
                 "--set", f"lidar.columns={columns}", "--quiet", "--output", drive], check=True)
        drives.append(drive)
    return drives


def string_together(drives, folder, scans):
    clouds = folder / "recording" / "point_clouds"
    clouds.mkdir(parents=True, exist_ok=True)
    sources = [scan for drive in drives for scan in sorted((drive / "point_clouds").iterdir())]
    for i in range(scans):
        link = clouds / f"{i + 1:06d}.bin"
        if not link.is_symlink():
            link.symlink_to(os.path.relpath(sources[i % len(sources)], clouds))
    return folder / "recording"


class Memory(threading.Thread):
    """Resident memory of a process in MiB, once a second."""

    def __init__(self, process):
        super().__init__(daemon=True)
        self.process, self.samples = process, []

    def run(self):
        while self.process.poll() is None:
            try:
                status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
                self.samples.append(int(status.split("VmRSS:")[1].split()[0]) / 1024)
            except (OSError, IndexError):
                pass
            time.sleep(1)


def part(values, index, parts=10):
    """The median of one of ten parts of a list."""
    size = max(len(values) // parts, 1)
    return statistics.median(values[index * size:(index + 1) * size])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scans", type=int, default=100_000)
    parser.add_argument("--columns", type=int, default=75, help="columns of a scan; fewer take less time")
    parser.add_argument("--checkpoint", type=float, help="seconds between two checkpoints; as the program does where not stated")
    parser.add_argument("--program", default="build/dynamic-icp")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    drives = simulate(program, arguments.folder, arguments.columns)
    recording = string_together(drives, arguments.folder, arguments.scans)

    run = arguments.folder / "run"
    start = time.time()
    with open(arguments.folder / "messages.txt", "w") as messages:
        words = [] if arguments.checkpoint is None else ["--checkpoint", str(arguments.checkpoint)]
        process = subprocess.Popen([program, "run", recording, "--output", run, "--force", "--quiet", *words], stderr=messages)
        memory = Memory(process)
        memory.start()
        status = process.wait()
    seconds = time.time() - start

    faults = []
    rows = [json.loads(line) for line in open(run / "frames.jsonl")]
    if len(rows) != arguments.scans or [row["index"] for row in rows] != list(range(len(rows))):
        faults.append(f"frames.jsonl has {len(rows)} lines")
    poses = sum(1 for _ in open(run / "trajectory.tum"))
    objects = sum(1 for _ in open(run / "objects.jsonl"))
    if poses != len(rows) or objects != len(rows):
        faults.append(f"trajectory.tum has {poses} lines, objects.jsonl {objects}")
    statuses = {name: sum(row["status"] == name for row in rows) for name in sorted({row["status"] for row in rows})}
    milliseconds = [row["ms"]["total"] for row in rows]

    print(f"scans              {len(rows)} in {seconds:.0f} s, exit status {status}; {statuses}")
    print(f"memory, MiB        median of tenths of the run: "
          f"{', '.join(f'{part(memory.samples, i):.1f}' for i in range(10))}; most {max(memory.samples):.1f}")
    print(f"ms a scan          median of tenths of the run: {', '.join(f'{part(milliseconds, i):.2f}' for i in range(10))}")
    print(f"files              {sum(f.stat().st_size for f in run.iterdir()) / 1e6:.1f} MB")

    start = time.time()
    page = arguments.folder / "report.html"
    if subprocess.run([program, "report", run, "--output", page]).returncode == 0:
        print(f"report             {page.stat().st_size / 1e6:.1f} MB in {time.time() - start:.1f} s")
    else:
        faults.append("no report")
    for fault in faults:
        print(f"FAULT              {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
