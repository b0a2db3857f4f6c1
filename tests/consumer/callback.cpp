// Scans of a driver in the memory of its messages, as docs/cpp.md shows; two of a wall ahead, while the sensor drives
// at 10 m/s.
#include <cstdint>
#include <iostream>
#include <memory>
#include <vector>

#include <dynamic_icp/dynamic_icp.hpp>

struct Point {  // as a driver has it, in the memory of its message
  float x, y, z, intensity, doppler, time;
};

class Driver {
 public:
  /// Called for each scan: its timestamp in ns, and points with times in s after it.
  void on_scan(std::int64_t stamp_ns, const std::vector<Point>& points) {
    if (points.empty()) return;
    const auto column = [&](const float Point::*member) {
      return dynamic_icp::Column(&(points.data()->*member), points.size(), sizeof(Point));
    };
    dynamic_icp::ScanView scan;
    scan.stamp.ns = stamp_ns;
    scan.points = {column(&Point::x), column(&Point::y), column(&Point::z)};
    scan.doppler = column(&Point::doppler);  // m/s, positive away from the sensor
    scan.times = column(&Point::time);       // leave it out where all points are taken at once
    const dynamic_icp::odometry::Frame frame = odometry_->process(scan);
    std::cout << verdict(frame.status) << "  position " << frame.T_world_sensor.translation().transpose()
              << " m  velocity " << frame.ego.velocity_sensor.transpose() << " m/s\n";
  }

 private:
  std::unique_ptr<dynamic_icp::odometry::Odometry> odometry_ = dynamic_icp::odometry::make_odometry();
};

int main() {
  Driver driver;
  for (int k = 0; k < 2; ++k) {
    std::vector<Point> points;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3f ray =
          Eigen::Vector3f(1.0F, -0.5F + 0.01F * float(i % 100), -0.25F + 0.01F * float(i / 100)).normalized();
      const Eigen::Vector3f point = ray * ((20.0F - float(k)) / ray.x());
      points.push_back({point.x(), point.y(), point.z(), 1.0F, -10.0F * ray.x(), 0.0F});
    }
    driver.on_scan(100'000'000LL * k, points);
  }
}
