// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the program says and does about a recording whose numbers are wrong.
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class DiagnosisProgram : public ProgramTest {
 protected:
  /// The street again with its Doppler changed, and no ground truth.
  [[nodiscard]] fs::path changed(const std::string& name, const std::function<float(float)>& change) const {
    fs::create_directories(folder_ / name / "point_clouds");
    for (const fs::directory_entry& entry : fs::directory_iterator(street() / "point_clouds")) {
      std::string bytes = read_file(entry.path());
      for (std::size_t at = 12; at + 4 <= bytes.size(); at += 16) {
        float doppler = 0.0F;
        std::memcpy(&doppler, bytes.data() + at, 4);
        doppler = change(doppler);
        std::memcpy(bytes.data() + at, &doppler, 4);
      }
      std::ofstream(folder_ / name / "point_clouds" / entry.path().filename(), std::ios::binary) << bytes;
    }
    return folder_ / name;
  }

  [[nodiscard]] Outcome run(const fs::path& recording, const std::string& output, const std::string& more = "") const {
    return run_program("run --quiet " + recording.string() + " --output " + (folder_ / output).string() + " " + more);
  }
};

TEST_F(DiagnosisProgram, InfoSaysItAsJson) {
  const json healthy = json::parse(run_program("info --json " + street().string()).text);
  ASSERT_EQ(healthy["diagnosis"].size(), 12u);
  for (const json& finding : healthy["diagnosis"]) {
    EXPECT_NE(finding["verdict"], "wrong") << finding;
    EXPECT_NE(finding["verdict"], "suspicious") << finding;
  }
  const json turned = json::parse(run_program("info --json --doppler-sign towards " + street().string()).text);
  EXPECT_EQ(turned["diagnosis"][0]["question"], "doppler_sign");
  EXPECT_EQ(turned["diagnosis"][0]["verdict"], "wrong");
  EXPECT_EQ(turned["diagnosis"][0]["fix"], "--doppler-sign away");
}

TEST_F(DiagnosisProgram, TheJsonHoldsWhatTheTextShows) {
  const json about = json::parse(run_program("info --json " + street().string()).text);
  EXPECT_NEAR(about["time"]["period_s"].get<double>(), 0.1, 1e-6);
  EXPECT_TRUE(about["time"]["gaps"].empty());
  const json& points = about["points"];
  EXPECT_GT(points["range_m"][0].get<double>(), 0.0);
  EXPECT_GT(points["range_m"][1].get<double>(), points["range_m"][0].get<double>() + 10.0);
  EXPECT_LT(points["doppler_mps"][0].get<double>(), -5.0) << "it drives towards what it sees";
  EXPECT_LE(points["least"].get<int>(), points["median"].get<int>());
  EXPECT_LE(points["median"].get<int>(), points["most"].get<int>());
  const std::string text = run_program("info " + street().string()).text;
  EXPECT_NE(text.find(std::to_string(points["median"].get<int>())), std::string::npos) << text;
}

TEST_F(DiagnosisProgram, RunRefusesAReflectanceInPlaceOfTheDoppler) {
  for (const auto& [name, most] : {std::pair{"unit", 1.0F}, std::pair{"byte", 255.0F}}) {
    unsigned state = 1;
    const float scale = most;
    const fs::path grey = changed(name, [&state, scale](float) {
      state = state * 1664525U + 1013904223U;
      const float share = static_cast<float>(state >> 8U) / 16777216.0F;
      return scale * share * share;  // most surfaces are dark
    });
    const Outcome refused = run(grey, std::string("out-") + name);
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.text.find("there is no Doppler: of "), std::string::npos) << refused.text;
    const json about = json::parse(run_program("info --json " + grey.string()).text);
    for (const json& finding : about["diagnosis"]) {
      if (finding["question"] == "columns" || finding["question"] == "doppler_kind") {
        EXPECT_EQ(finding["verdict"], "wrong") << finding;
      } else {
        EXPECT_NE(finding["verdict"], "wrong") << finding;
      }
    }
  }
}

TEST_F(DiagnosisProgram, RunRefusesATurnedSignUntilItIsSaid) {
  const fs::path turned = changed("turned", [](float doppler) { return -doppler; });
  const Outcome refused = run(turned, "out");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.text.find("--doppler-sign towards"), std::string::npos) << refused.text;
  EXPECT_FALSE(fs::exists(folder_ / "out"));

  EXPECT_EQ(run(turned, "out", "--doppler-sign towards").status, 0);
  const json record = json::parse(read_file(folder_ / "out" / "run.json"));
  EXPECT_EQ(record["input"]["options"]["doppler-sign"], "towards");
  const fs::path whole = changed("whole", [](float doppler) { return doppler; });
  EXPECT_EQ(run(whole, "out2").status, 0);
  EXPECT_EQ(read_file(folder_ / "out2" / "trajectory.tum"), read_file(folder_ / "out" / "trajectory.tum"))
      << "mended on the way in, it is the same drive";

  EXPECT_EQ(run(turned, "out3", "--doppler-sign away").status, 0) << "what was said is believed";
}

TEST_F(DiagnosisProgram, RunRefusesOtherUnitsUntilTheyAreStated) {
  const fs::path kmh = changed("kmh", [](float doppler) { return 3.6F * doppler; });
  const Outcome refused = run(kmh, "out");
  EXPECT_EQ(refused.status, 1);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  const std::size_t fix = refused.text.find("Run with ");
  ASSERT_NE(fix, std::string::npos) << refused.text;
  const std::string options = refused.text.substr(fix + 9, refused.text.find(';', fix) - fix - 9);
  EXPECT_EQ(options, "--doppler-scale 0.277778");
  EXPECT_EQ(run(kmh, "out", options).status, 0) << "what is advised helps";
  EXPECT_LT(json::parse(read_file(folder_ / "out" / "summary.json"))["rte_rmse_m"], 0.02);

  EXPECT_NE(refused.text.find("--doppler-scale 1\n"), std::string::npos) << refused.text;
  const Outcome believed = run(kmh, "out2", "--doppler-scale 1");
  EXPECT_NE(believed.status, 1) << believed.text;
  EXPECT_TRUE(fs::exists(folder_ / "out2" / "run.json"));
}

TEST_F(DiagnosisProgram, RunWarnsOfWhatItCanLiveWith) {
  const fs::path biased = changed("biased", [](float doppler) { return doppler + 0.3F; });
  EXPECT_EQ(run(biased, "out").status, 0);
  const json record = json::parse(read_file(folder_ / "out" / "run.json"));
  EXPECT_NE(record["warnings"].dump().find("doppler_bias"), std::string::npos) << record["warnings"];
}

// A real drive of a 4D radar: relative, positive away, 12 Hz, the poses of its ground truth now and then repeated.
TEST_F(DiagnosisProgram, ARecordedRadarIsWhatItIs) {
  const fs::path recording = source_folder() / ".." / "shared" / "data" / "radar-campus";
  if (!fs::exists(recording)) {
    GTEST_SKIP() << "no recording beside the sources";
  }
  const auto findings = [&](const std::string& options) {
    json by_question;
    const json about = json::parse(run_program("info --json " + options + recording.string()).text);
    for (const json& finding : about["diagnosis"]) {
      by_question[finding["question"].get<std::string>()] = finding["verdict"];
    }
    return by_question;
  };
  const json healthy = findings("");
  for (const char* question : {"doppler_sign", "doppler_kind", "doppler_units", "point_units", "columns", "mounting",
                               "time_scale", "stamps", "unusable_points"}) {
    EXPECT_EQ(healthy[question], "ok") << question;
  }
  EXPECT_EQ(healthy["doppler_bias"], "cannot_tell") << "it sees ahead only: an error looks like speed";
  const Outcome ran = run_program("run " + recording.string() + " --output " + (folder_ / "out").string());
  for (const char* said : {"12.00 Hz", "relative, ", "positive away from the sensor: "}) {
    EXPECT_NE(ran.text.find(said), std::string::npos) << said << "\n" << ran.text;
  }
  EXPECT_EQ(findings("--doppler-sign towards ")["doppler_sign"], "wrong");
  EXPECT_EQ(findings("--time-scale 1.2 ")["time_scale"], "wrong") << "as if it came at 10 Hz";
  EXPECT_EQ(findings("--point-scale 1000 ")["point_units"], "wrong");
}

// Without the sensor's own motion in the Doppler nothing shows the way along smooth walls, but the noise of the points:
// no frame may claim to know it.
TEST_F(DiagnosisProgram, CompensatedDopplerInATunnelLeavesTheWayUnknown) {
  const auto frames_of = [&](const std::string& scene) {
    const fs::path drive = folder_ / scene;
    EXPECT_EQ(run_program("simulate " + scene + " --frames 10 --instant --quiet --layout aevascenes --output " +
                          drive.string())
                  .status,
              0);
    const Outcome ran = run(drive / "pointcloud_compensated", "out-" + scene);
    EXPECT_EQ(ran.status, 0) << ran.text;
    std::vector<json> frames;
    std::istringstream lines(read_file(folder_ / ("out-" + scene) / "frames.jsonl"));
    for (std::string line; std::getline(lines, line);) {
      frames.push_back(json::parse(line));
    }
    return frames;
  };
  const std::vector<json> tunnel = frames_of("tunnel");
  ASSERT_EQ(tunnel.size(), 10u);
  for (std::size_t i = 1; i < tunnel.size(); ++i) {
    EXPECT_EQ(tunnel[i]["status"], "degenerate") << i;
    ASSERT_EQ(tunnel[i]["degenerate"].size(), 1u) << i;
    EXPECT_GT(std::abs(tunnel[i]["degenerate"][0]["direction"][3].get<double>()), 0.99) << tunnel[i]["degenerate"];
  }
  for (const json& frame : frames_of("street")) {
    EXPECT_EQ(frame["status"], "ok") << frame["index"];
  }
  EXPECT_LT(json::parse(read_file(folder_ / "out-street" / "summary.json"))["rte_rmse_m"].get<double>(), 0.02);
}

TEST_F(DiagnosisProgram, MountingsThatContradictTheDopplerAreReported) {
  const fs::path drive = folder_ / "rig";
  ASSERT_EQ(run_program("simulate street --sensor front-pair --layout aevascenes --frames 10 --quiet --set "
                        "lidar.columns=300 --output " +
                        drive.string())
                .status,
            0);
  const auto finding = [&] {
    const json about = json::parse(run_program("info --json " + drive.string()).text);
    for (const json& one : about["diagnosis"]) {
      if (one["question"] == "rig_mountings") {
        return one;
      }
    }
    return json();
  };
  EXPECT_EQ(finding()["verdict"], "ok") << finding();
  json sequence = json::parse(read_file(drive / "sequence.json"));
  json& extrinsics = sequence["metadata"]["vehicle_to_lidar_extrinsics"];
  ASSERT_TRUE(extrinsics.contains("front_narrow_lidar")) << sequence["metadata"];
  extrinsics["front_narrow_lidar"]["rotation"] = {{"w", std::sqrt(0.5)}, {"x", 0}, {"y", 0}, {"z", -std::sqrt(0.5)}};
  std::ofstream(drive / "sequence.json") << sequence;
  EXPECT_EQ(finding()["verdict"], "wrong");
  EXPECT_NE(finding()["sentence"].get<std::string>().find("sensor 1 moves 9"), std::string::npos) << finding();
  const Outcome lost = run(drive, "out-rig");
  EXPECT_EQ(lost.status, kMostScansLost) << lost.text;
  EXPECT_NE(lost.text.find("ODOMETRY FAILED on "), std::string::npos) << lost.text;
  const json record = json::parse(read_file(folder_ / "out-rig" / "run.json"));
  EXPECT_NE(record["warnings"].dump().find("rig_mountings: the mountings contradict"), std::string::npos)
      << record["warnings"];
}

TEST_F(DiagnosisProgram, WrongOptionsAreWrongUse) {
  for (const char* options : {"--doppler-sign up", "--doppler-kind raw", "--columns x,y,z", "--time-scale 0",
                              "--point-scale nan", "--field doppler", "--period -1"}) {
    const Outcome outcome = run_program("info " + street().string() + " " + options);
    EXPECT_EQ(outcome.status, 2) << options << outcome.text;
  }
}

}  // namespace
}  // namespace dynamic_icp::tests
