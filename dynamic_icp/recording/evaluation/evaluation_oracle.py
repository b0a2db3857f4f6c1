# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""A second, independent evaluation of trajectories, for independent_test.cpp.

evaluation_oracle.py ESTIMATE.tum REFERENCE.tum prints one JSON object. Exit status 77: NumPy or SciPy is missing.
Written from the definitions in docs/evaluation.md, with SciPy's rotations, interpolation and alignment.
"""
import json
import sys

try:
    import numpy as np
    from scipy.spatial.transform import Rotation, Slerp
except ImportError:
    sys.exit(77)

MAX_GAP_S = 0.2
GAP_S = 1.0


def read(path):
    rows = np.loadtxt(path, ndmin=2)
    return rows[:, 0], rows[:, 1:4], Rotation.from_quat(rows[:, 4:8])


def associate(estimate, reference):
    times, positions, rotations = estimate
    ref_times, ref_positions, ref_rotations = reference
    slerp = Slerp(ref_times, ref_rotations)
    keep = []
    for k, t in enumerate(times):
        if ref_times[0] <= t <= ref_times[-1]:
            after = min(max(int(np.searchsorted(ref_times, t)), 1), len(ref_times) - 1)
            exact = np.min(np.abs(ref_times - t)) == 0
            if exact or ref_times[after] - ref_times[after - 1] <= MAX_GAP_S + 1e-9:
                keep.append(k)
    t = times[keep]
    at_times = np.stack([np.interp(t, ref_times, ref_positions[:, axis]) for axis in range(3)], axis=1)
    return t, (positions[keep], rotations[keep]), (at_times, slerp(t))


def motion_error(est, ref, i, j):
    def motion(poses):
        positions, rotations = poses
        return rotations[i].inv().apply(positions[j] - positions[i]), rotations[i].inv() * rotations[j]

    (est_t, est_r), (ref_t, ref_r) = motion(est), motion(ref)
    return np.linalg.norm(est_t - ref_t), np.degrees((ref_r.inv() * est_r).magnitude())


def statistics(errors):
    errors = np.asarray(errors)
    return {"rmse": np.sqrt(np.mean(errors**2)), "mean": np.mean(errors), "median": np.median(errors),
            "p95": np.percentile(errors, 95), "max": np.max(errors)}


def relative(est, ref, pairs):
    errors = [motion_error(est, ref, i, j) for i, j in pairs]
    return {"steps": len(errors), "translation_m": statistics([e[0] for e in errors]),
            "rotation_deg": statistics([e[1] for e in errors])}


def pairs_by_time(t):
    pairs = []
    for i in range(len(t) - 1):
        if t[-1] - t[i] > GAP_S - 1e-6:
            j = i + 1 + int(np.argmin(np.abs(t[i + 1:] - t[i] - GAP_S)))
            if abs(t[j] - t[i] - GAP_S) <= 0.1 * GAP_S:
                pairs.append((i, j))
    return pairs


def segments(est, ref):
    steps = np.linalg.norm(np.diff(ref[0], axis=0), axis=1)
    distance = np.concatenate([[0.0], np.cumsum(steps)])
    rows = []
    for first in range(0, len(distance), 10):
        for length in range(100, 900, 100):
            beyond = np.nonzero(distance > distance[first] + length)[0]
            if len(beyond):
                translation, rotation = motion_error(est, ref, first, beyond[0])
                rows.append((100 * translation / length, 100 * rotation / length))
    means = np.mean(rows, axis=0)
    return {"count": len(rows), "translation_percent": means[0], "rotation_deg_per_100m": means[1],
            "path_length_m": distance[-1]}


def absolute(est, ref):
    x, y = est[0] - est[0].mean(axis=0), ref[0] - ref[0].mean(axis=0)
    turned = Rotation.align_vectors(y, x)[0].apply(x)
    scale = np.sum(y * turned) / np.sum(x * x)
    return {"se3": statistics(np.linalg.norm(y - turned, axis=1)),
            "sim3": statistics(np.linalg.norm(y - scale * turned, axis=1)), "scale": scale}


def main():
    t, est, ref = associate(read(sys.argv[1]), read(sys.argv[2]))
    frames = [(i, i + 1) for i in range(len(t) - 1)]
    print(json.dumps({"matched": len(t), "frames": relative(est, ref, frames),
                      "seconds": relative(est, ref, pairs_by_time(t)), "segments": segments(est, ref),
                      "absolute": absolute(est, ref)}))


main()
