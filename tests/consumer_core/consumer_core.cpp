// Odometry over scans that a driver might hand over, here from files of float32 x, y, z (m) and Doppler (m/s, positive
// away from the sensor), 0.1 s apart. Prints the poses to the last digit, so that runs can be compared.
#include <array>
#include <cstdio>
#include <fstream>

#include <Eigen/LU>

#include <dynamic_icp/dynamic_icp.hpp>

namespace {

dynamic_icp::RawScan read_scan(const char* path, int index) {
  dynamic_icp::RawScan scan;
  scan.stamp.ns = 100'000'000LL * index;
  std::ifstream file(path, std::ios::binary);
  std::array<float, 4> record;
  while (file.read(reinterpret_cast<char*>(record.data()), sizeof(record))) {
    scan.points.emplace_back(record[0], record[1], record[2]);
    scan.doppler.push_back(record[3]);
  }
  return scan;
}

}  // namespace

int main(int argc, char** argv) {
  // Matrices of its own, compiled for its own flags.
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(50, 50) + 0.01 * Eigen::MatrixXd::Ones(50, 50);
  std::fprintf(stderr, "%g\n", A.inverse().sum());
  for (const char* preset : {"default", "paper"}) {
    const auto odometry =
        dynamic_icp::odometry::make_odometry(dynamic_icp::odometry::configuration("dynamic-icp", preset));
    for (int k = 1; k < argc; ++k) {
      const dynamic_icp::odometry::Frame frame = odometry->process(read_scan(argv[k], k));
      std::printf("%s %s", preset, std::string(to_string(frame.status)).c_str());
      for (int i = 0; i < 12; ++i) {
        std::printf(" %a", frame.T_world_sensor.matrix()(i / 4, i % 4));
      }
      std::printf("\n");
    }
  }
}
