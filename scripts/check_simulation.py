#!/usr/bin/env python3
"""Checks simulated sequences against their own truth with nothing but numpy and scipy.

usage: check_simulation.py DIR...   (sequences in the layout dicp, made with --point-truth)

Prints one row of a Markdown table for each sequence:
  scans, points    how many
  moving           share of the points on moving bodies
  static Doppler   |s_true + u . v| below which 99 % of the static points of every scan lie, with the sensor's velocity at
                   the point's own time interpolated in motion.csv (5 ms; where the yaw acceleration jumps, the line
                   between two samples is off by up to 1e-3 m/s; the tests ask the trajectory itself)
  laid on next     median distance of static points of scan k, deskewed and moved by the true poses, from the planes
                   through the nearest points of scan k+1; with noise it is about the noise
  range, Doppler   mean and standard deviation of measured minus true, of the Doppler also minus its systematic error,
                   without values off by more than 6 sigma: mixed returns at edges and gross Doppler errors
  outliers         share of the Doppler values off by more than 6 sigma
Ends with status 1 when the static Doppler is off by more than 1 mm/s, or the mean of range or Doppler by 1 mm or 1 mm/s.
"""
import json
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation, Slerp


class Motion:
    """Pose and velocity of the sensor over time, from motion.csv."""

    def __init__(self, path):
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        self.t = rows[:, 0]
        self.position = rows[:, 1:4]
        self.rotation = Slerp(self.t, Rotation.from_quat(rows[:, 4:8]))
        self.velocity = rows[:, 8:11]

    def _between(self, columns, t):
        return np.stack([np.interp(t, self.t, columns[:, k]) for k in range(3)], axis=1)

    def velocity_at(self, t):
        return self._between(self.velocity, t)

    def to_world(self, points, t):
        # Cubic between the samples: positions bend as much as the velocity turns.
        i = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 2)
        h = self.t[i + 1] - self.t[i]
        x = ((t - self.t[i]) / h)[:, None]
        v = self.rotation(self.t).apply(self.velocity)
        p = ((1 + 2 * x) * (1 - x) ** 2 * self.position[i] + x * (1 - x) ** 2 * h[:, None] * v[i]
             + x**2 * (3 - 2 * x) * self.position[i + 1] + x**2 * (x - 1) * h[:, None] * v[i + 1])
        return self.rotation(t).apply(points) + p


class Scan:
    def __init__(self, folder, index, stamp):
        name = f"{index + 1:05}.bin"
        rows = np.fromfile(folder / "point_clouds" / name, "<f4").reshape(-1, 4).astype(float)
        self.points, self.doppler = rows[:, :3], rows[:, 3]
        self.labels = np.fromfile(folder / "labels" / name, "<i4")
        self.true_range, self.true_doppler = np.fromfile(folder / "truth" / name, "<f8").reshape(-1, 2).T
        times = folder / "times" / name
        self.t = stamp + (np.fromfile(times, "<f4").astype(float) if times.exists() else np.zeros(len(rows)))
        systematic = folder / "doppler_error" / name
        self.doppler_error = self.doppler - self.true_doppler
        self.doppler_error -= np.fromfile(systematic, "<f8") if systematic.exists() else 0.0


def distances_to_planes(points, cloud):
    """From each point to the plane through its six nearest points of the cloud, where these lie in one plane."""
    near = cloud[cKDTree(cloud).query(points, k=6)[1]]
    centred = near - near.mean(axis=1, keepdims=True)
    _, sigma, axes = np.linalg.svd(centred)
    flat = (sigma[:, 2] < 0.05 * sigma[:, 1]) & (np.linalg.norm(near[:, 0] - points, axis=1) < 0.3)
    return np.abs(np.einsum("ij,ij->i", points - near.mean(axis=1), axes[:, 2]))[flat]


def check(folder):
    folder = Path(folder)
    if not (folder / "truth").is_dir():
        sys.exit(f"{folder}: no truth/; make the sequence with --point-truth, one sensor and the layout dicp")
    scene = json.loads((folder / "scene.json").read_text())
    lidar = scene["rig"]["sensors"][0]
    motion = Motion(folder / "motion.csv")
    stamps = np.loadtxt(folder / "ref_poses.txt", ndmin=2)[:, 0]
    if (folder / "stamps.csv").exists():  # the sensor's stamps err: when the scans began
        stamps = np.loadtxt(folder / "stamps.csv", delimiter=",", skiprows=1, ndmin=2)[:, 2]
    scans = [Scan(folder, i, stamps[i]) for i in range(len(stamps))]

    static_doppler, laid = 0.0, []
    range_error, doppler_error = [], []
    if len(scans) < 2 or any(len(scan.t) == 0 for scan in scans):
        sys.exit(f"{folder}: expected at least two scans, none of them empty")
    for k, scan in enumerate(scans):
        inside = scan.t <= motion.t[-1]
        static = (scan.labels == 0) & inside
        u = scan.points / np.linalg.norm(scan.points, axis=1)[:, None]
        residual = np.abs(scan.true_doppler + np.einsum("ij,ij->i", u, motion.velocity_at(scan.t)))[static]
        static_doppler = max(static_doppler, np.quantile(residual, 0.99))
        range_error.append(np.linalg.norm(scan.points, axis=1) - scan.true_range)
        doppler_error.append(scan.doppler_error)
        if k + 1 < len(scans) and k % max(1, len(scans) // 8) == 0:
            other = scans[k + 1]
            use = static & (np.arange(len(static)) % 5 == 0)
            ahead = (other.labels == 0) & (other.t <= motion.t[-1])
            laid.append(np.median(distances_to_planes(motion.to_world(scan.points[use], scan.t[use]),
                                                      motion.to_world(other.points[ahead], other.t[ahead]))))
    range_error, doppler_error = np.concatenate(range_error), np.concatenate(doppler_error)
    sigma = lidar["lidar.doppler_noise_mps"] + lidar["lidar.doppler_step_mps"] + 1e-4
    usual = np.abs(doppler_error) < 6 * sigma
    close = np.abs(range_error) < 6 * (lidar["lidar.range_noise_m"] + lidar["lidar.range_step_m"] + 1e-4)
    points = sum(len(s.labels) for s in scans)
    moving = sum((s.labels > 0).sum() for s in scans) / points
    print(f"| {scene['scene']} | {len(scans)} | {points / len(scans):.0f} | {100 * moving:.1f} % | {static_doppler:.1e} m/s "
          f"| {1000 * np.median(laid):.3f} mm | {1000 * range_error[close].mean():+.2f} +- {1000 * range_error[close].std():.2f} mm "
          f"| {doppler_error[usual].mean():+.4f} +- {doppler_error[usual].std():.4f} m/s | {100 * (1 - usual.mean()):.2f} % |",
          flush=True)
    return static_doppler < 1e-3 and abs(range_error[close].mean()) < 1e-3 and abs(doppler_error[usual].mean()) < 1e-3


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| scene | scans | points | moving | static Doppler | laid on next | range | Doppler | outliers |")
    print("|---|---|---|---|---|---|---|---|---|")
    sys.exit(0 if all([check(argument) for argument in sys.argv[1:]]) else 1)
