"""HDBSCAN of the moving points of a scan, stage by stage as in the paper."""

import numpy as np

import dynamic_icp

scan = dynamic_icp.simulate("highway", frames=1)[0]
ego = dynamic_icp.ego_velocity(scan)
moving, compensated = dynamic_icp.velocity_filter(scan, ego.velocity)
clusters = dynamic_icp.hdbscan(scan.points[moving])
print(f"{ego.velocity.round(2)} m/s over ground; {moving.sum()} of {len(scan)} points move")
for label in range(clusters.labels.max(initial=-1) + 1):
    members = clusters.labels == label
    speed = np.median(compensated[moving][members])
    print(f"cluster {label}: {members.sum()} points at {scan.points[moving][members].mean(axis=0).round(1)} m, {speed:.1f} m/s")
