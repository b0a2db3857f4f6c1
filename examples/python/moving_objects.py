"""Moving objects: how fast they are, and what a simulator says of them."""

import numpy as np

import dynamic_icp

odometry = dynamic_icp.Odometry()
for scan in dynamic_icp.simulate("city", frames=12, lidar={"columns": 400, "rows": 32}):
    frame = odometry.process(scan)
    for one in frame.objects:
        truth = min(scan.truth.objects, key=lambda true: float(np.linalg.norm(true.center - one.centroid)), default=None)
        known = "" if truth is None else f"{truth.name}, {np.linalg.norm(truth.velocity):.2f} m/s"
        print(f"{frame.stamp:.1f} s  object {one.id}: {one.speed:.2f} m/s, {one.points} points ({known})")
