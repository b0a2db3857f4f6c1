#!/usr/bin/env python3
"""What `dynamic-icp info` says of simulated drives that are healthy, and of the same drives with one fault each.

usage: check_diagnosis.py PROGRAM FOLDER [--scenes A,B] [--seeds 1,2] [--faults A,B] [--frames N]   (a;b for a,b in a fault)

Simulates into FOLDER what is not there yet. Each drive is looked at swept and instant, with and without its ground
truth. Prints one row of a Markdown table for each scene and kind of scan, one column for each fault. A cell counts the
looks with truth / those without: "+" right, "?" cannot tell, "-" wrong. Right is:
  healthy    no verdict "wrong", none "suspicious"
  a fault    its own question answered as it must be, and no other called "wrong"
Ends with status 1 and a list when anything was wrong.
"""
import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

SCENES = "street,city,highway,tunnel,traffic-jam,roundabout"
PERIOD_S = 0.1


class Drive:
    """A simulated drive in memory, to be written with a fault."""

    def __init__(self, folder):
        self.scans = [np.fromfile(p, "<f4").reshape(-1, 4) for p in sorted((folder / "point_clouds").glob("*.bin"))]
        self.times = [np.fromfile(p, "<f4") for p in sorted((folder / "times").glob("*.bin"))]
        self.poses = np.loadtxt(folder / "ref_poses.txt")
        self.motion = np.loadtxt(folder / "motion.csv", delimiter=",", skiprows=1)

    def velocities(self, scan):
        """Of the sensor at the time of each point, in its axes."""
        t = self.poses[scan, 0] + (self.times[scan] if self.times else np.zeros(len(self.scans[scan])))
        return np.stack([np.interp(t, self.motion[:, 0], self.motion[:, k]) for k in (8, 9, 10)], axis=1)


def healthy(drive, scan):
    return drive.scans[scan]


def flipped(drive, scan):
    return drive.scans[scan] * np.float32([1, 1, 1, -1])


def compensated(drive, scan):
    points = drive.scans[scan].copy()
    directions = points[:, :3] / np.linalg.norm(points[:, :3], axis=1, keepdims=True)
    points[:, 3] += np.sum(directions * drive.velocities(scan), axis=1)
    return points


def biased(drive, scan):
    return drive.scans[scan] + np.float32([0, 0, 0, 0.2])


def kmh(drive, scan):
    return drive.scans[scan] * np.float32([1, 1, 1, 3.6])


def millimetres(drive, scan):
    return drive.scans[scan] * np.float32([1000, 1000, 1000, 1])


def permuted(*order):
    return lambda drive, scan: drive.scans[scan][:, order]


# name: (what is done to the scans, factor of the stamps, yaw of the sensor, question, verdicts that are right, option)
FAULTS = {
    "healthy": (healthy, 1.0, 0, None, (), ""),
    "flipped": (flipped, 1.0, 0, "doppler_sign", ("wrong",), "--doppler-sign towards"),
    "compensated": (compensated, 1.0, 0, "doppler_kind", ("wrong",), "--doppler-kind compensated"),
    "bias 0.2": (biased, 1.0, 0, "doppler_bias", ("suspicious",), ""),
    "km/h": (kmh, 1.0, 0, "doppler_units", ("wrong",), "--doppler-scale 0.27777"),
    "mm": (millimetres, 1.0, 0, "point_units", ("wrong",), "--point-scale 0.001"),
    "doppler,x,y,z": (permuted(3, 0, 1, 2), 1.0, 0, "columns", ("wrong",), "--columns doppler,x,y,z"),
    "x,z,y,doppler": (permuted(0, 2, 1, 3), 1.0, 0, "columns", ("wrong",), "--columns x,z,y,doppler"),
    "y,x,z,doppler": (permuted(1, 0, 2, 3), 1.0, 0, "columns", ("suspicious",), "--columns y,x,z,doppler"),
    "time 1.2": (healthy, 1.2, 0, "time_scale", ("wrong",), "--time-scale 0.8"),
    "time 0.8": (healthy, 0.8, 0, "time_scale", ("wrong",), "--time-scale 1.2"),
    "yaw 10": (healthy, 1.0, 10, "mounting", ("suspicious",), ""),
    "yaw 30": (healthy, 1.0, 30, "mounting", ("suspicious",), ""),
    "yaw 90": (healthy, 1.0, 90, "mounting", ("suspicious",), ""),
}
# What a fault may make of other questions without being wrong: axes that changed places are not those of the truth.
ALSO_WRONG = {"y,x,z,doppler": ("mounting",), "x,z,y,doppler": ("mounting",), "doppler,x,y,z": ("mounting",)}


def simulate(program, folder, scene, seed, swept, yaw, frames):
    drive = folder / f"{scene}-{seed}-{'swept' if swept else 'instant'}-{yaw}"
    if not drive.exists():
        command = [program, "simulate", scene, "--output", drive, "--frames", frames, "--seed", seed, "--quiet"]
        command += [] if swept else ["--instant"]
        command += ["--set", f"mount.yaw_deg={yaw}"] if yaw else []
        subprocess.run([str(word) for word in command], check=True)
    return Drive(drive)


def write(drive, folder, change, time_factor, with_truth):
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "point_clouds").mkdir(parents=True)
    if drive.times:
        (folder / "times").mkdir()
    for k in range(len(drive.scans)):
        np.asarray(change(drive, k), "<f4").tofile(folder / "point_clouds" / f"{k + 1:05}.bin")
        if drive.times:
            drive.times[k].tofile(folder / "times" / f"{k + 1:05}.bin")
    if with_truth:
        poses = drive.poses * np.array([time_factor] + 7 * [1.0])
        np.savetxt(folder / "ref_poses.txt", poses, fmt="%.9f")


def look(program, folder, with_truth, time_factor):
    command = [program, "info", folder, "--json"]
    command += [] if with_truth else ["--period", f"{PERIOD_S * time_factor:.6f}"]
    done = subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)
    return {finding["question"]: finding for finding in json.loads(done.stdout)["diagnosis"]}


def judge(name, findings):
    """"+", "?" or "-", and what was wrong."""
    _, _, _, question, right, fix = FAULTS[name]
    bad = ("wrong", "suspicious") if question is None else ("wrong",)
    for other, finding in findings.items():
        if other != question and other not in ALSO_WRONG.get(name, ()) and finding["verdict"] in bad:
            return "-", f"{other} {finding['verdict']}: {finding['sentence']} {finding['evidence']}"
    if question is None:
        return "+", ""
    finding = findings[question]
    if finding["verdict"] in right and (finding["fix"] or "").startswith(fix):
        return "+", ""
    # A stamp that is wrong by a factor cannot be told from a Doppler that is: nor can a velocity that is not seen.
    if finding["verdict"] == "cannot_tell":
        return "?", ""
    return "-", f"{question} {finding['verdict']}: {finding['sentence']} {finding['fix']} {finding['evidence']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--scenes", default=SCENES)
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--faults", default=",".join(n.replace(",", ";") for n in FAULTS),
                        help="with commas; a comma in a name is a semicolon here")
    parser.add_argument("--frames", type=int, default=40)
    options = parser.parse_args()
    faults = [name.replace(";", ",") for name in options.faults.split(",")]
    print("| scene | " + " | ".join(faults) + " |\n|---" + "|---" * len(faults) + "|")
    wrong = []
    for scene in options.scenes.split(","):
        for swept in (True, False):
            cells = {name: ["", ""] for name in faults}
            for seed in options.seeds.split(","):
                drives = {}
                for name in faults:
                    change, time_factor, yaw, *_ = FAULTS[name]
                    if yaw not in drives:
                        drives[yaw] = simulate(options.program, options.folder, scene, seed, swept, yaw,
                                               options.frames)
                    for with_truth in (True, False):
                        folder = options.folder / "faulty"
                        write(drives[yaw], folder, change, time_factor, with_truth)
                        mark, why = judge(name, look(options.program, folder, with_truth, time_factor))
                        cells[name][0 if with_truth else 1] += mark
                        if mark == "-":
                            truth = "with" if with_truth else "without"
                            wrong.append(f"{scene} {seed} {'swept' if swept else 'instant'}, {name}, {truth} truth: {why}")
            row = [f"{a} / {b}" for a, b in cells.values()]
            print(f"| {scene} {'swept' if swept else 'instant'} | " + " | ".join(row) + " |", flush=True)
    shutil.rmtree(options.folder / "faulty", ignore_errors=True)
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
