// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// A recorded 4D radar in the hand, 40 s, that stays where it is for its first 14 s: all its Doppler is 0 there.
#include <cstdio>
#include <sstream>

#include <nlohmann/json.hpp>

#include "testing/ros1_bag.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

constexpr std::size_t kAtRest = 130;  // scans

class RadarBag : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const fs::path bag = source_folder() / ".." / "shared" / "data" / "radar-ti" / "demo_ti_mmwave_rospkg_format.bag";
    if (!fs::exists(bag)) {
      GTEST_SKIP() << "no recording beside the sources";
    }
    clouds_ = ros1::clouds_of(read_file(bag));
    ASSERT_EQ(clouds_.size(), 412U);
  }

  /// The first scans as *.pcd, named by the times of their messages: their stamps are 0.
  fs::path pcd_folder(const std::string& name, std::size_t scans) const {
    fs::create_directories(folder_ / name);
    for (std::size_t k = 0; k < scans; ++k) {
      const ros1::BagCloud& cloud = clouds_[k];
      std::ostringstream text;
      text << "FIELDS x y z intensity velocity\nSIZE 4 4 4 4 4\nTYPE F F F F F\nPOINTS " << cloud.values("x").size()
           << "\nDATA ascii\n";
      for (std::size_t i = 0; i < cloud.values("x").size(); ++i) {
        for (const char* field : {"x", "y", "z", "intensity", "velocity"}) {
          char number[32];
          std::snprintf(number, sizeof number, "%.9g ", static_cast<double>(cloud.values(field)[i]));
          text << number;
        }
        text << '\n';
      }
      write_file(folder_ / name / (std::to_string(cloud.recorded_ns) + ".pcd"), text.str());
    }
    return folder_ / name;
  }

  [[nodiscard]] Outcome run(const fs::path& recording) const {
    return run_program("run " + recording.string() + " --output " + recording.string() + "-run");
  }

  std::vector<ros1::BagCloud> clouds_;
};

TEST_F(RadarBag, ABeginAtRestIsNoReasonToRefuseTheDoppler) {
  const fs::path whole = pcd_folder("whole", clouds_.size());
  const Outcome ran = run(whole);
  // It is not refused; that 41 points a scan give no planes is another matter.
  ASSERT_EQ(ran.status, kMostScansLost) << ran.text;
  EXPECT_NE(ran.text.find("of 412 scans: 41 points a scan give no planes"), std::string::npos) << ran.text;
  const json summary = json::parse(read_file(whole.string() + "-run/summary.json"));
  EXPECT_EQ(summary["frames"], clouds_.size()) << summary;

  const Outcome refused = run(pcd_folder("rest", kAtRest));
  EXPECT_EQ(refused.status, 1) << refused.text;
  EXPECT_NE(refused.text.find("are exactly zero"), std::string::npos) << refused.text;
}

}  // namespace
}  // namespace dynamic_icp::tests
