// Odometry over scans that a driver might hand over: a sensor that drives through a room and turns. Prints the poses to
// the last digit, so that runs can be compared.
#include <cmath>
#include <cstdio>

#include <dynamic_icp/dynamic_icp.hpp>

namespace {

using Eigen::Vector3d;

dynamic_icp::RawScan scan_at(double time_s) {
  const double yaw = 0.2 * time_s;
  const Vector3d velocity(4.0, 0.0, 0.0);  // m/s, sensor axes
  Eigen::Isometry3d T_room_sensor = Eigen::Isometry3d::Identity();
  T_room_sensor.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  T_room_sensor.translation() = 20.0 * Vector3d(std::sin(yaw), 1.0 - std::cos(yaw), 0.0);
  dynamic_icp::RawScan scan;
  scan.stamp.ns = static_cast<std::int64_t>(std::llround(1e9 * time_s));
  for (int column = -60; column <= 60; ++column) {
    for (int row = -8; row <= 8; ++row) {
      const double azimuth = 0.017 * column;
      const Vector3d u = Vector3d(std::cos(azimuth), std::sin(azimuth), 0.02 * row).normalized();
      const Vector3d direction = T_room_sensor.linear() * u;
      double range = 1e3;
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = std::copysign(Vector3d(40.0, 25.0, 4.0)[axis], direction[axis]);
        range = std::min(range, (wall - T_room_sensor.translation()[axis]) / direction[axis]);
      }
      scan.points.push_back(range * u);
      scan.doppler.push_back(-u.dot(velocity));
    }
  }
  return scan;
}

}  // namespace

int main() {
  for (const char* preset : {"default", "paper"}) {
    const auto odometry = dynamic_icp::odometry::make_odometry("dynamic-icp", dynamic_icp::odometry::preset(preset));
    for (int k = 0; k < 6; ++k) {
      const dynamic_icp::odometry::Frame frame = odometry->process(scan_at(0.1 * k));
      std::printf("%s %s", preset, std::string(to_string(frame.status)).c_str());
      for (int i = 0; i < 12; ++i) {
        std::printf(" %a", frame.T_world_sensor.matrix()(i / 4, i % 4));
      }
      std::printf("\n");
    }
  }
}
