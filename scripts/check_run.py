#!/usr/bin/env python3
"""Holds runs of simulated drives against the truth of the simulator, apart from the program's own evaluation: motion,
ego velocity, stated covariances, objects. Needs numpy.

usage: check_run.py DRIVE RUN [DRIVE RUN ...]   (folders of `simulate` and of `run`)

Per drive: RTE (mm) and RRE (degrees), root mean squares of the frame-to-frame errors; the error of the ego velocity
(mm/s) in the first scan and as a root mean square, of scans that sweep in the middle of the sweep; the normalised
estimation error squared (NEES) of the motion, mean over the frames (6 numbers: an honest covariance gives 6); objects of
2 m/s and 50 points or more from the sixth scan on: error of the velocity along and across the motion (m/s), share
reported, and false ones a scan.
"""
import json
import sys
from pathlib import Path

import numpy as np


def rotations(q):
    x, y, z, w = q.T
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                     2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], 1).reshape(-1, 3, 3)


def poses(path):
    rows = np.loadtxt(path, ndmin=2)
    T = np.tile(np.eye(4), (len(rows), 1, 1))
    T[:, :3, :3] = rotations(rows[:, 4:8] / np.linalg.norm(rows[:, 4:8], axis=1)[:, None])
    T[:, :3, 3] = rows[:, 1:4]
    return T


def sensor_poses(drive):
    """Of the sensor, also where the drive has those of the vehicle."""
    T = poses(drive / "ref_poses.txt")
    if not (drive / "calibration.json").exists():
        return T
    mount = json.loads((drive / "calibration.json").read_text())["T_V_to_S"]
    T_vehicle_sensor = np.eye(4)
    T_vehicle_sensor[:3, :3] = rotations(np.array([[mount["quaternion"][k] for k in "xyzw"]]))[0]
    T_vehicle_sensor[:3, 3] = [mount["translation"][k] for k in "xyz"]
    return T @ T_vehicle_sensor


def lines(path):
    return [json.loads(line) for line in open(path)]


def rotation_vector(R):
    v = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    s = np.linalg.norm(v)
    return v if s < 1e-12 else v * np.arctan2(s, (np.trace(R) - 1) / 2) / s


def motion_errors(truth, estimate, frames):
    """Per pair: translation (m), rotation (rad), NEES of the left perturbation of T_target_source."""
    result = []
    for k in range(1, len(truth)):
        exact = np.linalg.inv(truth[k]) @ truth[k - 1]
        found = np.linalg.inv(estimate[k]) @ estimate[k - 1]
        D = exact @ np.linalg.inv(found)
        e = np.r_[rotation_vector(D[:3, :3]), D[:3, 3]]
        E = exact @ np.linalg.inv(found)
        P = np.array(frames[k]["pose_covariance"], float)
        result.append((np.linalg.norm(E[:3, 3]), np.linalg.norm(e[:3]), e @ np.linalg.solve(P, e)))
    return np.array(result)


def ego_errors(drive, frames):
    """m/s; the truth of a sweep is that in its middle."""
    times = sorted((drive / "times").glob("*")) if (drive / "times").is_dir() else []
    motion = np.loadtxt(drive / "motion.csv", delimiter=",", skiprows=1) if times else None
    errors = []
    for frame, ego in zip(frames, lines(drive / "ego.jsonl")):
        velocity = np.array(ego["velocity_sensor"])
        if times:
            middle = ego["timestamp"] + 0.5 * json.loads((drive / "scene.json").read_text())["rig"]["sensors"][0]["lidar.sweep_s"]
            velocity = np.array([np.interp(middle, motion[:, 0], motion[:, c]) for c in (8, 9, 10)])
        errors.append(np.linalg.norm(np.array(frame["ego_velocity"]) - velocity))
    return np.array(errors)


def object_scores(truth, estimate, warm_up=5, least_points=50, least_speed=2.0):
    along, across, reported, wanted, false = [], [], 0, 0, 0
    for k, (exact, found) in enumerate(zip(truth, estimate)):
        centres = np.array([o["centroid"] for o in found["objects"]]).reshape(-1, 3)
        explained = set()
        for o in exact["objects"]:
            distance = np.linalg.norm(centres - np.array(o["center_sensor"]), axis=1)
            near = [i for i in np.argsort(distance) if distance[i] < 3 + max(o["size"]) / 2]
            explained.update(near)
            v = np.array(o["velocity_sensor"])
            speed = np.linalg.norm(v)
            if k < warm_up or o["points"] < least_points or speed < least_speed:
                continue
            wanted += 1
            if near:
                reported += 1
                e = np.array(found["objects"][near[0]]["velocity"]) - v
                along.append(abs(e @ v) / speed)
                across.append(np.linalg.norm(e - (e @ v) / speed**2 * v))
        false += len(centres) - len(explained)
    if not wanted:
        return None, None, None, false / max(len(truth), 1)
    return np.mean(along or [np.nan]), np.mean(across or [np.nan]), reported / wanted, false / len(truth)


def check(drive, run):
    frames = lines(run / "frames.jsonl")
    motion = motion_errors(sensor_poses(drive), poses(run / "trajectory.tum"), frames)
    ego = ego_errors(drive, frames)
    objects = object_scores(lines(drive / "objects.jsonl"), lines(run / "objects.jsonl"))
    rms = np.sqrt((motion[:, :2] ** 2).mean(0))
    shown = ["-" if value is None else f"{value:.2f}" for value in objects]
    return [drive.name, f"{1000 * rms[0]:.2f}", f"{np.degrees(rms[1]):.4f}", f"{1000 * ego[0]:.0f}",
            f"{1000 * np.sqrt((ego**2).mean()):.1f}", f"{motion[:, 2].mean():.1f}", *shown]


def main():
    columns = ["drive", "RTE [mm]", "RRE [deg]", "ego, first [mm/s]", "ego [mm/s]", "NEES", "along [m/s]",
               "across [m/s]", "reported", "false a scan"]
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    folders = [Path(argument) for argument in sys.argv[1:]]
    for drive, run in zip(folders[::2], folders[1::2]):
        print(f"| {' | '.join(check(drive, run))} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    main()
