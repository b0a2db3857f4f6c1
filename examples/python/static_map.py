"""The static scene as a point cloud, without what moves through it."""

import dynamic_icp

odometry, static_scene = dynamic_icp.Odometry(), dynamic_icp.Map(voxel_size=0.2)
for scan in dynamic_icp.simulate("city", frames=10, lidar={"columns": 400, "rows": 32}):
    static_scene.add(odometry.process(scan))
static_scene.save("map.ply")
print(static_scene, "in map.ply")
