"""Odometry scan by scan, as a driver would feed it: points (N, 3) in m, Doppler (N,) in m/s, positive away."""

import dynamic_icp

odometry = dynamic_icp.Odometry()
for scan in dynamic_icp.simulate("city", frames=10, lidar={"columns": 400, "rows": 32}):
    frame = odometry.process(scan.points, scan.doppler, scan.times, stamp_ns=scan.stamp_ns)
    print(frame.status, frame.position.round(3), "m", frame.ego_velocity.round(2), "m/s", len(frame.objects), "objects")
