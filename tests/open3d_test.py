#!/usr/bin/env python3
"""Compares point-to-point, point-to-plane and gicp with Open3D on the same pairs of clouds.

usage: open3d_test.py PROGRAM

Skips (status 77) where Open3D is not installed: Debian package python3-open3d.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import open3d as o3d
except ImportError:
    print("skipped: needs python3-open3d")
    sys.exit(77)

REGISTRATION = o3d.pipelines.registration
GATE, ITERATIONS, TOLERANCE = 0.3, 300, 1e-9
RADIUS, NEIGHBOURS = 2.0, 30  # of the normals


def simulate(program, folder, scene, speed):
    subprocess.run([program, "simulate", scene, "--instant", "--frames", "2", "--quiet", "--set", f"speed={speed}",
                    "--set", "traffic=0", "--set", "lidar.columns=400", "--set", "lidar.rows=40", "--output", folder],
                   check=True)
    scans = [folder / "point_clouds" / f"0000{i}.bin" for i in (1, 2)]
    for scan in scans:
        thin(scan)
    return scans


def thin(path):
    """Leaves one point of each 0.3 m voxel and no point whose neighbours make no plane: there the programs differ."""
    rows = np.fromfile(path, "<f4").reshape(-1, 4)
    rows = rows[np.linalg.norm(rows[:, :3], axis=1) <= 40.0]
    rows = rows[np.sort(np.unique(np.floor(rows[:, :3] / 0.3), axis=0, return_index=True)[1])]
    while True:
        tree = o3d.geometry.KDTreeFlann(cloud_of(rows))
        plane = []
        for point in rows[:, :3].astype(float):
            _, near, _ = tree.search_hybrid_vector_3d(point, RADIUS, NEIGHBOURS)
            values = np.linalg.eigvalsh(np.cov(rows[near, :3].T.astype(float))) if len(near) > 5 else np.zeros(3)
            plane.append(values[1] > 0.002 * values[2] > 0.0)
        if all(plane):
            rows.tofile(path)
            return
        rows = rows[plane]


def cloud_of(rows):
    return o3d.geometry.PointCloud(o3d.utility.Vector3dVector(rows[:, :3].astype(float)))


def ours(program, method, source, target):
    settings = ["preprocess.voxel.voxel_size_m=0", "preprocess.range.min_range_m=0", "preprocess.range.max_range_m=80",
                f"registration.max_correspondence_distance_m={GATE}", f"registration.max_iterations={ITERATIONS}",
                f"registration.tolerance={TOLERANCE}"]
    if method != "point-to-point":
        settings += [f"preprocess.normals.radius_m={RADIUS}", f"preprocess.normals.max_neighbours={NEIGHBOURS}"]
    command = [program, "register", source, target, "--method", method, "--preset", "paper"]
    for setting in settings:
        command += ["--set", setting]
    pair = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return np.array(pair["T_target_source"]), pair["converged"], pair["fitness"]


def cloud(path):
    result = cloud_of(np.fromfile(path, "<f4").reshape(-1, 4))
    result.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(RADIUS, NEIGHBOURS))
    return result


def theirs(method, source, target):
    criteria = REGISTRATION.ICPConvergenceCriteria(TOLERANCE, TOLERANCE, ITERATIONS)
    arguments = [cloud(source), cloud(target), GATE, np.eye(4)]
    if method == "gicp":
        result = REGISTRATION.registration_generalized_icp(
            *arguments, REGISTRATION.TransformationEstimationForGeneralizedICP(), criteria)
    else:
        estimation = (REGISTRATION.TransformationEstimationPointToPoint() if method == "point-to-point"
                      else REGISTRATION.TransformationEstimationPointToPlane())
        result = REGISTRATION.registration_icp(*arguments, estimation, criteria)
    return result.transformation, result.fitness


def main():
    program, failures, compared = sys.argv[1], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for scene, speed in (("parking", 1.5), ("roundabout", 1.5), ("city", 1.5), ("street", 1.0)):
            source, target = simulate(program, Path(folder) / scene, scene, speed)
            for method in ("point-to-point", "point-to-plane", "gicp"):
                T, converged, fitness = ours(program, method, source, target)
                T_open3d, fitness_open3d = theirs(method, source, target)
                difference = np.linalg.inv(T_open3d) @ T
                metres = np.linalg.norm(difference[:3, 3])
                skew = difference[:3, :3] - difference[:3, :3].T
                radians = 0.5 * np.linalg.norm([skew[2, 1], skew[0, 2], skew[1, 0]])
                good = metres < 1e-4 and radians < 1e-4 and abs(fitness - fitness_open3d) < 1e-3
                compared += converged
                failures += converged and not good
                print(f"{scene:10} {method:15} {metres:.1e} m {radians:.1e} rad  fitness {fitness:.4f} {fitness_open3d:.4f}"
                      f"  {'not converged' if not converged else 'ok' if good else 'DIFFERS'}")
    print(f"{compared} pairs compared, {failures} differ")
    return 1 if failures or compared < 6 else 0


if __name__ == "__main__":
    sys.exit(main())
