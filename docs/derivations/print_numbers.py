#!/usr/bin/env python3
"""Prints the numbers of doppler-and-rotation.md, with nothing but numpy and scipy.

usage: print_numbers.py                closed forms
       print_numbers.py DRIVE...       what the static points of simulated drives say of rotation; layout dicp, instant
                                       scans
       print_numbers.py --lost REFERENCE.tum ESTIMATE.tum...   scans more than 0.1 m off, and the errors of the others

Unless said otherwise: 10,000 static points in 120 x 19.2 degrees, 5 cm/s Doppler noise, 10 scans a second, 20 m/s.
"""
import json
import sys
from pathlib import Path

import numpy as np

SIGMA, POINTS, DT, SPEED = 0.05, 10_000, 0.1, 20.0
RNG = np.random.default_rng(1)


def view(width_deg, height_deg=19.2, count=200_000):
    """Lines of sight in a field of view, and the share of the sweep at which each is taken, from -0.5 to 0.5."""
    azimuth = np.radians(width_deg) * ((np.arange(count) + 0.5) / count - 0.5)
    elevation = np.radians(height_deg) * (np.random.default_rng(1).permutation(count) / (count - 1.0) - 0.5)
    u = np.c_[np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    return u, -azimuth / np.radians(width_deg)


def information(rows, points=POINTS):
    """Of `points` Doppler values with the distribution of these rows."""
    return points / SIGMA**2 * rows.T @ rows / len(rows)


def deviations(H):
    return np.sqrt(np.diag(np.linalg.inv(H)))


def velocity_section():
    print("## Velocity from one scan: deviation of v_x, v_y, v_z (mm/s)")
    for width in (120, 60, 30):
        print(f"  {width:3} degrees: {np.round(1e3 * deviations(information(view(width)[0])), 2)}")


def rotation_section():
    print("## Rotation: deviation in degrees; nothing is said of the rotation about the direction of travel")
    C = np.linalg.inv(information(view(120)[0]))
    v = np.array([SPEED, 0.0, 0.0])
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    for a in (3.0, 1.0, 0.25, 0.0):
        S = (a * DT) ** 2 * np.eye(3) + 2 * C
        H = cross.T @ np.linalg.inv(S) @ cross
        pitch, yaw = np.degrees(np.diag(H)[1:] ** -0.5)
        print(f"  |a| = {a:4} m/s^2 unknown: pitch {pitch:.4f} yaw {yaw:.4f}")
    sigma_d = DT / 2 * np.sqrt(2 * np.diag(C))
    print(f"  displacement (trapezoid) x y z: {np.round(1e3 * sigma_d, 3)} mm")
    for place in (2e-3, 1e-3, 0.0):
        S = np.diag(sigma_d**2 + place**2)
        H = (DT / 2) ** 2 * cross.T @ np.linalg.inv(S) @ cross
        pitch, yaw = np.degrees(np.diag(H)[1:] ** -0.5)
        print(f"  position known to {1e3 * place} mm: pitch {pitch:.4f} yaw {yaw:.4f}")
    for slip_deg in (0.0, 0.1, 1.0):
        s = DT / 2.0 * np.hypot(np.sqrt(C[1, 1]), SPEED * np.radians(slip_deg))
        print(f"  lever arm 2 m, side slip {slip_deg} degrees: yaw {np.degrees(s):.4f}")


def object_section():
    print("## An object's share of the information along one axis, with 0.5 mm from the static scene")
    for sigma_v in (0.5, 0.1, 0.025, 0.005):
        w = sigma_v * DT
        share = 0.0005**2 / (0.0005**2 + w**2)
        wrong = 0.02 / np.sqrt(500)
        print(f"  sigma_v = {sigma_v} m/s: {1e3 * w:.1f} mm, share {100 * share:.3f} %; 500 points taken as "
              f"independent claim {1e3 * wrong:.2f} mm")


def normals_of(points, neighbours=30):
    """Unit normals, and which neighbourhoods are planes: smallest eigenvalue under 5 % of the middle one."""
    from scipy.spatial import cKDTree
    near = points[cKDTree(points).query(points, neighbours)[1]]
    near = near - near.mean(axis=1, keepdims=True)
    values, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", near, near))
    return vectors[:, :, 0], values[:, 0] < 0.05 * values[:, 1]


def drive_section(folder):
    """Both terms at the true pose, medians over every eighth scan; constant velocity, planes without own errors."""
    folder = Path(folder)
    ego = [np.array(json.loads(line)["velocity_sensor"]) for line in open(folder / "ego.jsonl")]
    rows = []
    for scan in range(0, len(ego), 8):
        data = np.fromfile(folder / "point_clouds" / f"{scan + 1:05}.bin", "f4").reshape(-1, 4).astype(float)
        labels = np.fromfile(folder / "labels" / f"{scan + 1:05}.bin", "i4")
        points = data[(labels == 0) & np.isfinite(data).all(axis=1), :3]
        points = points[RNG.permutation(len(points))[:POINTS]]
        reach = np.linalg.norm(points, axis=1)
        u, v = points / reach[:, None], ego[scan]
        across = np.linalg.norm(np.cross(u, v), axis=1)
        value = -(across**2) * DT / reach
        J = np.cross(u, DT * v) / reach[:, None] * -(u @ v)[:, None]
        kept = np.abs(value) < 0.3
        H = J[kept].T @ J[kept] / (2 * SIGMA**2)
        side = np.linalg.eigh(H)[1][:, 1:]  # the axis of travel is invisible
        face = np.sqrt(np.trace(np.linalg.inv(side.T @ H @ side)) / 2)
        pull = np.linalg.norm(np.linalg.solve(side.T @ H @ side, side.T @ (J[kept].T @ value[kept]) / (2 * SIGMA**2)))
        normal, plane = normals_of(points)
        Jg = np.c_[np.cross(points, normal), normal][plane] / 0.02
        planes = np.sqrt(np.trace(np.linalg.inv(Jg.T @ Jg)[:3, :3]) / 3)
        # Range noise is along the ray: across the plane it is 0.02 |n.u|, and no surface is smoother than 1 mm.
        across_plane = np.hypot(0.02 * np.abs((normal * (points / reach[:, None])).sum(axis=1)), 0.001)[plane]
        Jr = np.c_[np.cross(points, normal), normal][plane] / across_plane[:, None]
        along_ray = np.sqrt(np.trace(np.linalg.inv(Jr.T @ Jr)[:3, :3]) / 3)
        # What the objective of the paper makes of it: lambda 0.2, Tukey 0.3 m/s, metres against metres a second.
        tukey = np.where(kept, (1.0 - (value / 0.3) ** 2) ** 2, 0.0)
        shift = np.linalg.solve(0.8 * 0.02**2 * Jg.T @ Jg, np.r_[0.2 * J.T @ (tukey * value), np.zeros(3)])[:3]
        rows.append([np.sqrt(np.mean(value**2)), 1 - kept.mean(), np.linalg.norm(J, axis=1).mean(), np.degrees(face),
                     np.degrees(pull), np.degrees(np.linalg.norm(shift)), np.degrees(planes), np.degrees(along_ray)])
    m = np.median(rows, axis=0)
    print(f"| {folder.name} | {m[0]:.2f} | {100 * m[1]:.0f} % | {m[2]:.2f} | {m[3]:.2f} | {m[4]:.0f} | {m[5]:.4f} | "
          f"{m[6]:.4f} | {m[7]:.4f} |")


def poses(path):
    from scipy.spatial.transform import Rotation
    table = np.loadtxt(path)
    T = np.tile(np.eye(4), (len(table), 1, 1))
    T[:, :3, :3] = Rotation.from_quat(table[:, 4:8]).as_matrix()
    T[:, :3, 3] = table[:, 1:4]
    return T


def lost_section(reference, estimate):
    """Frame-to-frame errors as docs/evaluation.md defines them; both files have the same stamps."""
    A, B = poses(reference), poses(estimate)
    E = np.linalg.inv(np.linalg.inv(A[:-1]) @ A[1:]) @ (np.linalg.inv(B[:-1]) @ B[1:])
    rte = np.linalg.norm(E[:, :3, 3], axis=1)
    rre = np.degrees(2.0 * np.arcsin(np.linalg.norm(E[:, :3, :3] - np.eye(3), axis=(1, 2)) / np.sqrt(8.0)))
    near = rte <= 0.1
    rest = np.sqrt([np.mean(rte[near] ** 2), np.mean(rre[near] ** 2)]) if near.any() else [np.nan, np.nan]
    print(f"  {estimate}: {np.sum(~near)} of {len(rte)} lost, others {1e3 * rest[0]:.2f} mm, {rest[1]:.5f} degrees")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--lost"]:
        for argument in sys.argv[3:]:
            lost_section(sys.argv[2], argument)
    elif len(sys.argv) > 1:
        print("| drive | RMS of r_v (m/s) | beyond 0.3 m/s | mean size of J (m/s per rad) "
              "| deviation at face value (deg) | r_v alone pulls by (deg) | moves the paper's optimum by (deg) "
              "| deviation from planes (deg) | with noise along the ray (deg) |\n"
              "|---|---|---|---|---|---|---|---|---|")
        for argument in sys.argv[1:]:
            drive_section(argument)
    else:
        for section in (velocity_section, rotation_section, object_section):
            section()
