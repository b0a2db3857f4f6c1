#!/usr/bin/env python3
"""Prints the tables of docs/results/objects.md: how well preset default tracks moving objects in simulated drives.

usage: benchmark_objects.py DIR [--scans 40] [--seeds 51,52,53] [--scenes street,city,...] [--program build/dynamic-icp]

Drives with white noise alone (aeries-ii) and with the errors of real sensors (aeries-ii-real), instant and swept, each
compared by `evaluate --objects`: objects of 50 points and 2 m/s, after 5 scans. Means over the drives of a scene. Safe to
stop and to run again: what is finished is kept.
"""
import argparse
import json
import shutil
import subprocess
from pathlib import Path

KINDS = {"white noise, instant": ["--sensor", "aeries-ii", "--instant"], "white noise, swept": ["--sensor", "aeries-ii"],
         "errors of real sensors, instant": ["--sensor", "aeries-ii-real", "--instant"],
         "errors of real sensors, swept": ["--sensor", "aeries-ii-real"]}
SCENES = "street,city,highway,traffic-jam,roundabout,stationary,bridge,curved-walls,tunnel"
TRACKS = [("HOTA", "hota", 2), ("MOTA", "mota", 2), ("IDF1", "idf1", 2), ("switches /100 s", "id_switches_per_100_s", 2),
          ("false /1000 scans", "false_per_1000_scans", 0), ("overlap", "overlap_mean", 2),
          ("latency, longest [s]", "latency_max_s", 1)]
ERRORS = [("along [m/s]", "along_mae_mps", 2), ("across [m/s]", "across_mae_mps", 2), ("heading [deg]", "heading_mae_deg", 1),
          ("centre [m]", "center_mae_m", 2), ("size [m]", "size_mae_m", 2), ("NEES velocity", "nees_velocity", 1),
          ("NEES centre", "nees_center", 1), ("1 s ahead [m]", "predicted_center_mae_m", 2),
          ("points in box, median", "points_in_box_median", 3), ("5 %", "points_in_box_p5", 3)]


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def scores(program, folder, scene, seed, scans, options):
    drive, out = folder / "drive", folder / "run"
    result = folder / "objects.json"
    if not result.exists():
        if not (drive / "scene.json").exists():
            run(program, "simulate", scene, "--seed", seed, "--frames", scans, "--calibration", "--quiet", "--output", drive,
                *options)
        if not (out / "run.json").exists():
            run(program, "run", drive, "--output", out, "--save-labels", "--quiet")
        result.write_text(run(program, "evaluate", "--objects", out, drive, "--json"))
        shutil.rmtree(drive / "point_clouds")
        shutil.rmtree(out / "labels")
    return json.loads(result.read_text())


def mean(cells, key):
    values = [cell[key] for cell in cells if cell[key] is not None]
    return sum(values) / len(values) if values else None


def print_table(columns, rows):
    print(f"| scene | {' | '.join(name for name, _, _ in columns)} |\n|---|{'---|' * len(columns)}")
    for scene, cells in rows.items():
        numbers = [(mean(cells, key), digits) for _, key, digits in columns]
        print(f"| {scene} | " + " | ".join("-" if n is None else f"{n:.{digits}f}" for n, digits in numbers) + " |")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--scans", default="40")
    parser.add_argument("--seeds", default="51,52,53")
    parser.add_argument("--scenes", default=SCENES)
    parser.add_argument("--program", default=Path(__file__).resolve().parents[1] / "build" / "dynamic-icp")
    options = parser.parse_args()
    for kind, sensor in KINDS.items():
        rows = {}
        for scene in options.scenes.split(","):
            rows[scene] = []
            for seed in options.seeds.split(","):
                folder = options.folder / kind.replace(", ", "-").replace(" ", "-") / f"{scene}-{seed}"
                folder.mkdir(parents=True, exist_ok=True)
                rows[scene].append(scores(options.program, folder, scene, seed, options.scans, sensor))
        print(f"**{kind}**\n")
        print_table(TRACKS, rows)
        print_table(ERRORS, rows)


if __name__ == "__main__":
    main()
