#!/usr/bin/env python3
"""Prints how many points of a saved map come from bodies that move, of a simulated drive whose scans take no time.

usage: map_ghosts.py DRIVE [--program build/dynamic-icp]

Runs preset default with --save-map and --save-labels, and finds for each point of the map the static point of a scan it
was, at the pose of the run, and for that the body of the drive's labels. Needs NumPy, SciPy and the module dynamic_icp.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import dynamic_icp

SAME_POINT_M = 0.003  # the map is written as float32


def labels_in(folder):
    return [np.fromfile(file, np.int32) for file in sorted((folder / "labels").iterdir())]


def points_of(ply):
    data = ply.read_bytes()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    return np.frombuffer(data[begin:], "<f4").reshape(-1, 3).astype(float)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive", type=Path)
    parser.add_argument("--program", type=Path, default=Path("build/dynamic-icp"))
    arguments = parser.parse_args()
    drive = arguments.drive
    with tempfile.TemporaryDirectory() as folder:
        run, ply = Path(folder) / "run", Path(folder) / "map.ply"
        subprocess.run([arguments.program, "run", drive, "--quiet", "--save-labels", "--save-map", ply, "--output", run], check=True)
        poses = np.loadtxt(run / "trajectory.tum")
        labels, found = labels_in(drive), labels_in(run)
        in_map = points_of(ply)
    recording = dynamic_icp.open(drive)
    if not len(recording) == len(poses) == len(labels) == len(found):
        sys.exit(f"{drive}: {len(recording)} scans, {len(poses)} poses and {len(labels)} labels, expected as many of each")
    bodies = {body["id"] for line in open(drive / "objects.jsonl") for body in json.loads(line)["objects"]}
    points, of_body = [], []
    for scan, pose, truth, label in zip(recording, poses, labels, found):
        is_static = label == 0
        points.append(Rotation.from_quat(pose[4:8]).apply(np.asarray(scan.points, float)[is_static]) + pose[1:4])
        of_body.append(np.isin(truth[is_static], list(bodies)))
    distance, which = KDTree(np.vstack(points)).query(in_map)
    is_known = distance < SAME_POINT_M
    ghosts = np.concatenate(of_body)[which[is_known]].sum()
    print(f"{drive}: {ghosts} of {is_known.sum()} points on moving bodies, {100 * ghosts / is_known.sum():.3f} %; "
          f"{(~is_known).sum()} of unknown origin")


if __name__ == "__main__":
    main()
