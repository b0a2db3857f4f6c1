// The first example of docs/cpp.md, word for word: odometry over a recording in fifteen lines.
#include <iostream>

#include <dynamic_icp/dynamic_icp.hpp>
#include <dynamic_icp/recording.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto recording = dynamic_icp::datasets::open_dataset(argv[1]);
  const auto odometry = dynamic_icp::odometry::make_odometry();
  for (std::size_t i = 0; i < recording->size(); ++i) {
    const dynamic_icp::odometry::Frame frame = odometry->process(recording->scan(i));
    std::cout << verdict(frame.status) << "  position " << frame.T_world_sensor.translation().transpose()
              << " m  velocity " << frame.ego.velocity_sensor.transpose() << " m/s\n";
  }
}
