// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/object_figure.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/wall_drive.hpp"
#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

std::vector<Figure> worst_of(const runs::TestFolder& folder, std::size_t count) {
  return draw_worst_objects(runs::read_run(folder.path() / "run"), count, drawing::theme(drawing::Ground::kLight));
}

/// The car of the drive in the sixth scan, the first after the warm-up, 22.5 m ahead, and a second one; the run has the
/// box of the first a metre too far and that of the second half a metre.
void write_objects(const runs::TestFolder& folder) {
  std::string truth;
  std::string reported;
  for (int k = 0; k < 6; ++k) {
    const std::string start = fmt::format(R"({{"index":{},"timestamp":100.{},"objects":[)", k, k);
    const char* const kTrue = R"({{"id":{},"velocity_sensor":[15,0,0],"center_sensor":[{},0,-0.75],"size":[4,2,1.5],)"
                              R"("orientation_sensor_xyzw":[0,0,0,1],"points":90}})";
    const char* const kReported = R"({{"id":{},"velocity":[14,0,0],"centroid":[{},0,-0.75],"extent":[4,2,1.5],)"
                                  R"("points":90,"box":{{"center":[{},0,-0.75],"size":[4,2,1.5],)"
                                  R"("orientation_xyzw":[0,0,0,1]}}}})";
    truth +=
        start + fmt::format(fmt::runtime(kTrue), 3, 24.5) + "," + fmt::format(fmt::runtime(kTrue), 4, 40.0) + "]}\n";
    reported += start + fmt::format(fmt::runtime(kReported), 1, 25.5, 25.5) + "," +
                fmt::format(fmt::runtime(kReported), 2, 40.5, 40.5) + "]}\n";
  }
  folder.write("drive/objects.jsonl", truth);
  folder.write("run/objects.jsonl", reported);
}

TEST(ObjectFigure, TheWorstComeFirst) {
  const runs::TestFolder folder;
  report::WallDrive().write(folder);
  write_objects(folder);
  const std::vector<Figure> figures = worst_of(folder, 10);
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[0].name, "worst_object_1");
  EXPECT_EQ(figures[1].name, "worst_object_2");
  const std::string worst = figures[0].svg.document();
  EXPECT_EQ(drawing::WellFormed::fault_of(worst), "");
  EXPECT_FALSE(drawing::holds_non_finite(worst));
  // Of edges of 4 m 3 m are common: 3 / (4 + 4 - 3).
  for (const char* text : {"Scan 5", "body 3, object 1", "overlap 0.60", "centre 1.00 m", "velocity 1.00 m/s"}) {
    EXPECT_NE(worst.find(text), std::string::npos) << text;
  }
  EXPECT_NE(figures[1].svg.document().find("overlap 0.78"), std::string::npos) << "3.5 / 4.5";
  EXPECT_EQ(worst_of(folder, 1).size(), 1U);
}

TEST(ObjectFigure, RefusesARecordingWithoutTruth) {
  const runs::TestFolder folder;
  report::WallDrive().write(folder);
  try {
    worst_of(folder, 1);
    ADD_FAILURE();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("drive/objects.jsonl"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::figures
