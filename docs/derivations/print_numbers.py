#!/usr/bin/env python3
"""Prints the numbers of the two derivations in this folder, with nothing but numpy and scipy.

usage: print_numbers.py                closed forms and small simulations
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


def weights(samples, begin, end):
    """So that weights . f(samples) is the integral of the polynomial through the samples."""
    k = np.arange(len(samples))
    return np.linalg.solve(np.power.outer(samples, k).T, (np.power(end, k + 1.0) - np.power(begin, k + 1.0)) / (k + 1))


def sway_velocity(t, parts):
    g = np.zeros((len(t), 3))
    if "heave" in parts:
        w = 2 * np.pi * 1.2
        g[:, 2] += 0.012 * w * np.cos(w * t)
    if "pitch" in parts:
        w = 2 * np.pi * 0.9
        angle = np.radians(0.4) * np.sin(w * t + 1.0)
        rate = np.radians(0.4) * w * np.cos(w * t + 1.0)
        g[:, 0] += 2.0 * rate * -np.sin(angle)
        g[:, 2] += 2.0 * rate * np.cos(angle)
    if "turn" in parts:
        g[:, 0] += 8.0 * np.cos(0.6 * t)
        g[:, 1] += 8.0 * np.sin(0.6 * t)
    return g


def quadrature_section():
    print("## Quadrature: weights in units of the interval")
    rules = {"trapezoid": np.array([-1.0, 0.0]), "three stamps": np.array([-2.0, -1.0, 0.0]),
             "mid-sweep, one": np.array([-0.5]), "mid-sweep, three": np.array([-1.5, -0.5, 0.5])}
    for name, samples in rules.items():
        c = weights(samples, -1.0, 0.0)
        print(f"  {name:17} {np.round(c, 6)}  noise {np.sqrt(c @ c):.3f} dt sigma_v")
    print("  RMS error (mm) of a displacement, without noise")
    ends = 1.0 + DT * np.arange(1000)
    x, w = np.polynomial.legendre.leggauss(12)
    for parts in (["heave"], ["pitch"], ["turn"], ["heave", "pitch", "turn"]):
        truth = sum(DT / 2 * wi * sway_velocity(ends - DT / 2 + DT / 2 * xi, parts) for xi, wi in zip(x, w))
        errors = []
        for samples in rules.values():
            c = weights(samples, -1.0, 0.0)
            got = sum(DT * ci * sway_velocity(ends + DT * si, parts) for ci, si in zip(c, samples))
            errors.append(1e3 * np.sqrt(np.mean(np.sum((got - truth) ** 2, axis=1))))
        print(f"  {'+'.join(parts):17} " + "  ".join(f"{n} {e:.3f}" for n, e in zip(rules, errors)))


def bias_section():
    print("## Constant Doppler bias b, instant scans")
    for width in (120, 60, 30):
        u = view(width)[0]
        leak = np.linalg.solve(u.T @ u, u.sum(axis=0))
        left = 1.0 - u.mean(axis=0) @ leak
        sigma = deviations(information(np.c_[u, -np.ones(len(u))]))
        print(f"  {width:3} degrees: leak {np.round(leak, 3)}, left {left:.6f}, sigma_b {1e3 * sigma[3]:.2f} mm/s, "
              f"v {np.round(1e3 * sigma[:3], 2)} mm/s, v_x with b known {1e3 * deviations(information(u))[0]:.2f} mm/s")


def unexplained(rows, column, others):
    """Share of a column's square that the other columns leave."""
    fit = np.linalg.lstsq(rows[:, others], rows[:, column], rcond=None)[0]
    return np.sum((rows[:, column] - rows[:, others] @ fit) ** 2) / np.sum(rows[:, column] ** 2)


def sweep_rows(width, height=19.2):
    u, share = view(width, height)
    return np.c_[u, -np.ones(len(u)), (DT * share)[:, None] * u]


def sweep_section():
    print("## One sweep: unknowns v, b, a")
    for width in (120, 60, 30):
        rows = sweep_rows(width)
        print(f"  {width:3} degrees: share of a_x left by v_y {unexplained(rows, 4, [1]):.5f}, "
              f"of a_y left by v_x, b {unexplained(rows, 5, [0, 3]):.6f}")
        for name, used in (("v, b, a", range(7)), ("v, a", [0, 1, 2, 4, 5, 6]), ("v, b", range(4)), ("v", range(3))):
            used = list(used)
            sigma = np.full(7, np.nan)
            sigma[used] = deviations(information(rows[:, used]))
            print(f"    {name:8} v {np.round(1e3 * sigma[:3], 2)} mm/s, b {1e3 * sigma[3]:.2f} mm/s, "
                  f"a {np.round(sigma[4:], 3)} m/s^2")
    for width in (60, 30):
        sigma = deviations(information(sweep_rows(width, 2.0)))
        print(f"  {width:3} degrees, elevations within 2 degrees only: v {np.round(1e3 * sigma[:3], 1)} mm/s")
    print("  with acceleration left out: error of (v, b) per m/s^2, mm/s")
    rows = sweep_rows(120)
    for used in ([0, 1, 2, 3], [0, 1, 2]):
        errors = 1e3 * np.linalg.lstsq(rows[:, used], rows[:, 4:6], rcond=None)[0]
        print(f"    {'v, b' if 3 in used else 'v':5} a_x {np.round(errors[:, 0], 2)} a_y {np.round(errors[:, 1], 2)}")


def average_section():
    print("## A sweep measures averages: kappa of x, y, z; error (mm) of a displacement in a sway of 1.2 cm, 1.2 Hz")
    print("   along one axis: one sample, three as if at mid-sweep, three with kappa")
    rows = sweep_rows(120)[::10]
    tau = DT * view(120)[1][::10]
    w = 2 * np.pi * 1.2
    starts = 1.0 + DT * np.arange(600)
    for name, used in (("a known", [0, 1, 2]), ("a fitted", [0, 1, 2, 4, 5, 6])):
        gain = np.linalg.pinv(rows[:, used])
        kappa = np.diag(gain[:3] @ (rows[:, :3] * (tau**2 / 2)[:, None])) / (DT**2 / 24)
        result = []
        for axis in range(3):
            middle = starts[:, None] + DT / 2
            speed = 0.012 * w * np.cos(w * (middle + tau))
            if name == "a known":
                speed += 0.012 * w**2 * np.sin(w * middle) * tau
            v = (rows[:, axis] * speed) @ gain[axis]
            rules = [np.array([1, -2, 1]) * (1 - k) / 24 + [0, 1, 0] for k in (1.0, 0.0, kappa[axis])]
            got = [DT * (c[0] * v[:-2] + c[1] * v[1:-1] + c[2] * v[2:]) for c in rules]
            truth = 0.012 * (np.sin(w * starts[2:]) - np.sin(w * starts[1:-1]))
            result.append([1e3 * np.sqrt(np.mean((g - truth) ** 2)) for g in got])
        print(f"  {name:8} kappa {np.round(kappa, 2)}  x {np.round(result[0], 3)}  y {np.round(result[1], 3)}  "
              f"z {np.round(result[2], 3)}")


def filter_section(jerk=5.0):
    print(f"## In a filter over scans: constant acceleration, jerk {jerk} m/s^3, bias wanders by 1 mm/s a scan")
    F = np.eye(7)
    F[0:3, 4:7] = DT * np.eye(3)
    G = np.zeros((7, 3))
    G[0:3], G[4:7] = 0.5 * DT**2 * np.eye(3), DT * np.eye(3)
    Q = jerk**2 * G @ G.T
    Q[3, 3] = 1e-6
    for width in (120, 60, 30):
        rows = sweep_rows(width)
        for name in ("swept", "instant"):
            J = rows.copy()
            if name == "instant":
                J[:, 4:] = 0.0
            P = np.diag([1e4, 1e4, 1e4, 0.04, 1.0, 1.0, 1.0])
            for scan in range(1, 101):
                if scan > 1:
                    P = F @ P @ F.T + Q
                P = np.linalg.inv(np.linalg.inv(P) + information(J))
                if scan in (1, 2, 5, 100):
                    s = np.sqrt(np.diag(P))
                    print(f"  {width:3} degrees, {name:7} scan {scan:3}: v {np.round(1e3 * s[:3], 2)} mm/s, "
                          f"b {1e3 * s[3]:.2f} mm/s, a {np.round(s[4:], 3)} m/s^2")


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
        for section in (velocity_section, rotation_section, object_section, quadrature_section, bias_section,
                        sweep_section, average_section, filter_section):
            section()
