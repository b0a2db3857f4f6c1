#!/usr/bin/env python3
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Joins the trajectories of overlapping parts of a recording.

Each part is taken from the last scan of the part before it on, and moved rigidly so that both have the same pose there: by
then the part has seen its share of the overlap and knows the sensor. Poses before the first part are its own.

usage: workflow/join_trajectories.py PART.tum... > trajectory.tum      (in the order of time)
"""
import math
import sys


def multiply(p, q):
    """The product of two quaternions x, y, z, w."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h,
            d * h - a * e - b * f - c * g)


def inverse(q):
    return (-q[0], -q[1], -q[2], q[3])


def turn(q, v):
    return multiply(multiply(q, (*v, 0.0)), inverse(q))[:3]


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def read(path):
    """Stamps, as they are written, and poses t, q of a TUM file."""
    poses = []
    with open(path, encoding="ascii") as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if words and not words[0].startswith("#"):
                if len(words) != 8:
                    sys.exit(f"{path}, line {number}: expected time x y z qx qy qz qw")
                values = [float(word) for word in words[1:]]
                norm = math.hypot(*values[3:])
                poses.append((words[0], values[:3], [value / norm for value in values[3:]]))
    if not poses:
        sys.exit(f"{path}: holds no poses")
    return poses


def main(paths):
    if not paths:
        sys.exit(__doc__)
    joined = read(paths[0])
    for path in paths[1:]:
        part = read(path)
        seam = next((i for i, pose in enumerate(part) if pose[0] == joined[-1][0]), None)
        if seam is None:
            sys.exit(f"{path}: has no pose at {joined[-1][0]}, where the part before it ends; expected parts that overlap")
        _, t_last, q_last = joined[-1]
        _, t_here, q_here = part[seam]
        q = multiply(q_last, inverse(q_here))
        t = add(t_last, turn(q, [-value for value in t_here]))
        joined += [(stamp, add(t, turn(q, t_pose)), multiply(q, q_pose)) for stamp, t_pose, q_pose in part[seam + 1:]]
    for stamp, t, q in joined:
        print(stamp, *t, *q)


if __name__ == "__main__":
    main(sys.argv[1:])
