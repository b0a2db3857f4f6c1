#!/usr/bin/env python3
"""Holds runs of simulated drives against the truth of the simulator, apart from the program's own evaluation: motion,
ego velocity, stated covariances, objects. Needs numpy.

usage: check_run.py DRIVE RUN [DRIVE RUN ...]   (folders of `simulate`, layout dicp, and of `run`)

For all drives of a scene (name-1, name-2, ...) together: RTE (mm) and RRE (degrees), root mean squares of the
frame-to-frame errors; the error of the ego velocity (mm/s), largest of the first scans and root mean square, of scans
that sweep in the middle of the sweep; the normalised estimation error squared (NEES) of the motion, mean over the
frames (6 numbers: an honest covariance gives 6); objects of 2 m/s and 50 points or more from the sixth scan on: mean
error of the velocity along and across the motion (m/s) and share reported; false ones a scan, over all scans. The
estimate of an object is the nearest one within 3 m beyond half its longest edge; false is what is near no object.
Ends with status 1 when a NEES is above 18, three times the honest value,.
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
        covariance = frames[k]["pose_covariance"]
        nees = e @ np.linalg.solve(np.array(covariance, float), e) if covariance else np.nan
        result.append((np.linalg.norm(e[3:]), np.linalg.norm(e[:3]), nees))
    return np.array(result)


def ego_errors(drive, frames):
    """m/s; the truth of a sweep is that in its middle."""
    times = sorted((drive / "times").glob("*")) if (drive / "times").is_dir() else []
    motion = np.loadtxt(drive / "motion.csv", delimiter=",", skiprows=1) if times else None
    sensor = json.loads((drive / "scene.json").read_text())["rig"]["sensors"][0]
    errors = []
    for frame, ego in zip(frames, lines(drive / "ego.jsonl")):
        velocity = np.array(ego["velocity_sensor"])
        if times:
            middle = ego["timestamp"] + 0.5 * sensor["lidar.sweep_s"]
            velocity = np.array([np.interp(middle, motion[:, 0], motion[:, c]) for c in (8, 9, 10)])
        errors.append(np.linalg.norm(np.array(frame["ego_velocity"]) - velocity))
    return np.array(errors)


def object_errors(truth, estimate, warm_up=5, least_points=50, least_speed=2.0):
    """Errors along and across the motion of the objects found, how many were to be found, false ones."""
    along, across, wanted, false = [], [], 0, 0
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
                e = np.array(found["objects"][near[0]]["velocity"]) - v
                along.append(abs(e @ v) / speed)
                across.append(np.linalg.norm(e - (e @ v) / speed**2 * v))
        false += len(centres) - len(explained)
    return along, across, wanted, false


class Scene:
    """What is known of the drives of one scene."""

    def __init__(self):
        self.motion, self.ego, self.first = [], [], []
        self.along, self.across, self.wanted, self.false, self.scans = [], [], 0, 0, 0

    def add(self, drive, run):
        frames = lines(run / "frames.jsonl")
        self.motion.extend(motion_errors(sensor_poses(drive), poses(run / "trajectory.tum"), frames))
        ego = ego_errors(drive, frames)
        self.ego.extend(ego)
        self.first.append(ego[0])
        along, across, wanted, false = object_errors(lines(drive / "objects.jsonl"), lines(run / "objects.jsonl"))
        self.along.extend(along)
        self.across.extend(across)
        self.wanted += wanted
        self.false += false
        self.scans += len(frames)

    def row(self):
        motion, ego = np.array(self.motion), np.array(self.ego)
        rte, rre = np.sqrt((motion[:, :2] ** 2).mean(0))
        objects = [f"{np.mean(self.along):.2f}", f"{np.mean(self.across):.2f}",
                   f"{100 * len(self.along) / self.wanted:.0f} %"] if self.along else ["-", "-", "-"]
        return [f"{1000 * rte:.2f}", f"{np.degrees(rre):.4f}", f"{1000 * max(self.first):.0f}",
                f"{1000 * np.sqrt((ego**2).mean()):.1f}", f"{np.nanmean(motion[:, 2]):.1f}", *objects,
                f"{self.false / self.scans:.2f}"]


def main():
    scenes = {}
    folders = [Path(argument) for argument in sys.argv[1:]]
    for drive, run in zip(folders[::2], folders[1::2]):
        scenes.setdefault(drive.name.rpartition("-")[0] or drive.name, Scene()).add(drive, run)
    columns = ["scene", "RTE [mm]", "RRE [deg]", "ego, first [mm/s]", "ego [mm/s]", "NEES", "along [m/s]",
               "across [m/s]", "reported", "false a scan"]
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for name, scene in scenes.items():
        print(f"| {name} | {' | '.join(scene.row())} |")
    honest = all(np.nanmean(np.array(scene.motion)[:, 2]) < 18.0 for scene in scenes.values())
    sys.exit(0 if honest else 1)


if __name__ == "__main__":
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    main()
