// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// dynamic-icp-speed on tiny simulated drives: that it keeps working, not how fast it is.
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

class SequenceRunner : public ProgramTest {
 protected:
  /// A city of five scans with so many columns of rays.
  [[nodiscard]] std::string drive(int columns) const {
    const fs::path path = folder_ / ("city-" + std::to_string(columns));
    const Outcome made =
        run_program("simulate city --instant --quiet --frames 5 --set lidar.rows=32 --set lidar.columns=" +
                    std::to_string(columns) + " --output '" + path.string() + "'");
    EXPECT_EQ(made.status, 0) << made.text;
    return "'" + path.string() + "'";
  }

  /// A program that always prints this.
  [[nodiscard]] std::string program_that_prints(const std::string& text) const {
    const fs::path path = folder_ / "prints.sh";
    write_file(path, "#!/bin/sh\ntest -s \"$1\" && echo '" + text + "'\n");
    fs::permissions(path, fs::perms::owner_all);
    return "'" + path.string() + "'";
  }

  static Outcome speed(const std::string& arguments) {
    return run_shell(std::string("'") + DYNAMIC_ICP_SPEED_PROGRAM + "' --quiet " + arguments);
  }
};

TEST_F(SequenceRunner, MeasuresEveryCombinationAndWritesIt) {
  const fs::path file = folder_ / "speed.json";
  const Outcome outcome =
      speed(drive(200) + " " + drive(400) + " --threads 1,2 --presets default,paper --repeat 2 --growth" +
            " --reference " + program_that_prints("12.5") + " --output '" + file.string() + "'");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("to the power of"), std::string::npos) << outcome.text;
  const nlohmann::json json = nlohmann::json::parse(read_file(file));
  EXPECT_EQ(json.at("reference").at("ms"), 12.5);
  EXPECT_EQ(json.at("growth").size(), 4U);  // presets times threads
  ASSERT_EQ(json.at("rows").size(), 8U);
  for (const nlohmann::json& row : json.at("rows")) {
    EXPECT_EQ(row.at("scans"), 2);  // five but the first three
    EXPECT_EQ(row.at("runs"), 2);
    EXPECT_EQ(row.at("warm_up_ms").size(), 3U);
    EXPECT_EQ(row.at("lost"), 0);
    const double p50 = row.at("p50_ms");
    EXPECT_GT(p50, 0.0);
    EXPECT_LE(row.at("p50_ms_least_of_runs"), p50);
    EXPECT_GE(row.at("p50_ms_largest_of_runs"), p50);
    EXPECT_GE(row.at("max_ms"), p50);
    EXPECT_GT(row.at("cpu_ms"), 0.0);
    EXPECT_DOUBLE_EQ(row.at("ratio"), p50 / 12.5);
    EXPECT_GT(row.at("speed_up"), 0.0);
    EXPECT_GT(row.at("points_mean"), row.at("points_used_mean"));
    EXPECT_GT(row.at("points_used_mean"), 100.0);
    double stages = 0.0;
    for (const auto& [name, ms] : row.at("stage_p50_ms").items()) {
      stages += ms.get<double>();
    }
    EXPECT_GT(stages, 0.0);
  }
}

TEST_F(SequenceRunner, WrongUseAndWrongDataAreToldApart) {
  const std::string city = drive(200);
  EXPECT_EQ(speed("").status, 2);
  EXPECT_EQ(speed(city + " --presets fastest").status, 2);
  EXPECT_EQ(speed(city + " --methods magic").status, 2);
  EXPECT_EQ(speed(city + " --threads 0").status, 2);
  EXPECT_EQ(speed(city + " --output '" + (folder_ / "missing" / "a.json").string() + "'").status, 2);
  EXPECT_EQ(speed("'" + (folder_ / "nothing").string() + "'").status, 1);
  EXPECT_EQ(speed(city + " --reference " + program_that_prints("fast")).status, 1);
}

TEST_F(SequenceRunner, ARecordingThatIsAllWarmUpIsRefused) {
  const fs::path path = folder_ / "short";
  ASSERT_EQ(run_program("simulate street --instant --quiet --frames 3 --output '" + path.string() + "'").status, 0);
  const Outcome outcome = speed("'" + path.string() + "'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("3 scans"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace dynamic_icp::tests
