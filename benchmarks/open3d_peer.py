#!/usr/bin/env python3
"""Times Open3D's point-to-plane odometry on recordings of the layout dicp, in the same way as dynamic-icp-speed.

usage: open3d_peer.py [--threads N] [--repeat N] --output FILE.json RECORDING...

Each scan: voxel grid of 0.3 m, normals (30 neighbours within 2 m), alignment with the scan before, which starts from
the last motion; gate 1 m, Open3D's own stopping rule. Reading is excluded and so are the first three scans. Skips
(status 77) where Open3D is not installed: Debian package python3-open3d.
"""
import argparse
import json
import os
import sys
import time
from pathlib import Path

WARM_UP = 3
VOXEL_M, RADIUS_M, NEIGHBOURS, GATE_M = 0.3, 2.0, 30, 1.0


def options():
    parser = argparse.ArgumentParser()
    parser.add_argument("recordings", nargs="+", type=Path)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--output", type=Path, required=True)
    return parser.parse_args()


OPTIONS = options()
os.environ["OMP_NUM_THREADS"] = str(OPTIONS.threads)  # read when the library is loaded

try:
    import numpy as np
    import open3d as o3d
except ImportError:
    print("skipped: needs python3-open3d")
    sys.exit(77)

REGISTRATION = o3d.pipelines.registration


def load(recording):
    files = sorted((recording / "point_clouds").glob("*.bin"), key=lambda file: int(file.stem))
    return [np.fromfile(file, "<f4").reshape(-1, 4)[:, :3].astype(float) for file in files]


def true_poses(recording):
    """T_world_sensor of each scan; nothing where the poses are those of the vehicle."""
    if (recording / "calibration.json").exists() or not (recording / "ref_poses.txt").exists():
        return None
    poses = []
    for row in np.loadtxt(recording / "ref_poses.txt", ndmin=2):
        x, y, z, w = row[4:8] / np.linalg.norm(row[4:8])
        pose = np.eye(4)
        pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        pose[:3, 3] = row[1:4]
        poses.append(pose)
    return poses


def run(scans):
    """Milliseconds of each scan, and the motions T_target_source."""
    neighbourhood = o3d.geometry.KDTreeSearchParamHybrid(RADIUS_M, NEIGHBOURS)
    times, motions, last, motion = [], [], None, np.eye(4)
    for points in scans:
        begin = time.perf_counter()
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)).voxel_down_sample(VOXEL_M)
        cloud.estimate_normals(neighbourhood)
        if last is not None:
            motion = REGISTRATION.registration_icp(
                last, cloud, GATE_M, motion, REGISTRATION.TransformationEstimationPointToPlane()).transformation
            motions.append(motion)
        times.append(1e3 * (time.perf_counter() - begin))
        last = cloud
    return times, motions


def median_error_m(motions, poses):
    """Of the translation from scan to scan; shows that the time was spent on something."""
    if poses is None:
        return None
    errors = []
    for i, motion in enumerate(motions):
        true = np.linalg.inv(poses[i + 1]) @ poses[i]
        errors.append(float(np.linalg.norm((np.linalg.inv(true) @ motion)[:3, 3])))
    return float(np.median(errors))


def measure(recording):
    scans = load(recording)
    if len(scans) <= WARM_UP:
        sys.exit(f"{recording}: has {len(scans)} scans, expected more than {WARM_UP}")
    counted, motions = [], []
    for _ in range(OPTIONS.repeat):
        times, motions = run(scans)
        counted.append(times[WARM_UP:])
    middle = [float(np.median(times)) for times in counted]
    return {
        "recording": str(recording), "name": f"{recording.parent.name}/{recording.name}", "peer": "Open3D point-to-plane",
        "version": o3d.__version__, "threads": OPTIONS.threads, "runs": OPTIONS.repeat, "scans": len(counted[0]),
        "points_mean": float(np.mean([len(points) for points in scans[WARM_UP:]])),
        "p50_ms": float(np.median(middle)), "p50_ms_least_of_runs": min(middle), "p50_ms_largest_of_runs": max(middle),
        "p95_ms": float(np.median([np.percentile(times, 95) for times in counted])),
        "p99_ms": float(np.median([np.percentile(times, 99) for times in counted])),
        "median_error_m": median_error_m(motions, true_poses(recording)),
    }


def main():
    rows = []
    for recording in OPTIONS.recordings:
        row = measure(Path(os.path.abspath(recording)))
        print(f"{row['name']:<24} Open3D point-to-plane, {row['threads']} threads: {row['p50_ms']:.1f} ms "
              f"({row['p50_ms_least_of_runs']:.1f}-{row['p50_ms_largest_of_runs']:.1f})")
        rows.append(row)
    OPTIONS.output.write_text(json.dumps({"rows": rows}, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
