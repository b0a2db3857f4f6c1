// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What `info` shows of what a run learned of its sensor.
#include <string>

#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/runs/calibration_file.hpp"

#include "testing/sensor_calibration.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class CalibrationInfo : public ProgramTest {
 protected:
  fs::path known_error() {
    const fs::path file = folder_ / "known.yaml";
    write_file(file, runs::calibration_text(window::half_and_half()));
    return file;
  }

  fs::path run(const std::string& more) {
    run_and_summarise(street().string() + " " + more);
    return folder_ / "out";
  }

  static void expect(const Outcome& outcome, int status, const std::string& words) {
    EXPECT_EQ(outcome.status, status) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
  }

  static std::string picture_of(const std::string& text) {
    const std::size_t begin = text.find("error by elevation");
    return begin == std::string::npos ? "" : text.substr(begin, text.find("unknown", begin) - begin);
  }
};

TEST_F(CalibrationInfo, ShowsAnErrorWhereItIs) {
  const Outcome shown = run_program("info " + known_error().string());
  ASSERT_EQ(shown.status, kDone) << shown.text;
  std::string row = "|";
  for (int column = 0; column < 48; ++column) {
    row += column < 24 ? "█" : "≡";
  }
  EXPECT_NE(shown.text.find(row + "|"), std::string::npos) << "too much on the left: " << shown.text;
  EXPECT_NE(shown.text.find("0.1000 m/s RMS over the view"), std::string::npos) << shown.text;
  for (const char* part : {"\nazimuth ", "\ncross ", "\nconstant ", "\nrange and intensity ", "\nvelocity "}) {
    EXPECT_NE(shown.text.find(part), std::string::npos) << part << shown.text;
  }
}

TEST_F(CalibrationInfo, SaysItAsJson) {
  const Outcome shown = run_program("info --json " + known_error().string());
  ASSERT_EQ(shown.status, kDone) << shown.text;
  const json about = json::parse(shown.text);
  EXPECT_EQ(about["format"], "calibration");
  EXPECT_EQ(about["stamp_sigma_s"], 1e-4);
  ASSERT_EQ(about["sensors"].size(), 1U);
  const json& sensor = about["sensors"][0];
  EXPECT_NEAR(sensor["error"]["rms_mps"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(sensor["parts"][0]["name"], "azimuth");
  EXPECT_NEAR(sensor["parts"][0]["median_sigma_mps"].get<double>(), 0.01, 1e-9);
  ASSERT_EQ(sensor["error_mps"].size(), sensor["elevations_rad"].size());
  ASSERT_EQ(sensor["error_mps"][0].size(), sensor["azimuths_rad"].size());
  EXPECT_GT(sensor["azimuths_rad"].back(), 0.9) << "to the left";
  EXPECT_NEAR(sensor["error_mps"][0].back().get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(sensor["error_mps"][0][0].get<double>(), -0.1, 1e-9);
}

TEST_F(CalibrationInfo, IsThatOfTheRun) {
  const fs::path out = run("");
  const Outcome of_run = run_program("info " + out.string());
  ASSERT_EQ(of_run.status, kDone) << of_run.text;
  EXPECT_NE(of_run.text.find("dynamic-icp plot " + out.string()), std::string::npos) << of_run.text;
  const Outcome of_file = run_program("info " + (out / "calibration.yaml").string());
  EXPECT_FALSE(picture_of(of_run.text).empty()) << of_run.text;
  EXPECT_EQ(picture_of(of_file.text), picture_of(of_run.text));
  EXPECT_EQ(of_file.text.find("dynamic-icp plot"), std::string::npos) << "a file alone is no run";
}

TEST_F(CalibrationInfo, ShowsEachSensorOfARig) {
  const fs::path drive = folder_ / "drive";
  const Outcome made =
      run_program("simulate street --sensor front-pair --layout aevascenes --frames 4 --quiet " +
                  std::string("--set lidar.columns=200 --set lidar.rows=16 --output ") + drive.string());
  ASSERT_EQ(made.status, kDone) << made.text;
  run_and_summarise(drive.string());
  const std::string out = (folder_ / "out").string();
  const Outcome shown = run_program("info " + out);
  expect(shown, kDone, "\nsensor 0 ");
  expect(shown, kDone, "\nsensor 1 ");
  EXPECT_EQ(run_program("plot " + out).status, kDone);
}

TEST_F(CalibrationInfo, OfARunThatLearnedNothingIsRefused) {
  const fs::path out = run("--preset paper");
  expect(run_program("info " + out.string()), kFailed, out.string() + ": this run learned nothing of its sensor");
}

TEST_F(CalibrationInfo, RefusesDamagedFilesByNameAndLine) {
  const fs::path file = known_error();
  const std::string whole = read_file(file);
  std::string text = whole;
  write_file(file, text.replace(text.find("version: 1"), 10, "version: 2"));
  expect(run_program("info " + file.string()), kWrongUsage, file.string() + ": line 3: 'version' is '2'");
  text = whole;
  write_file(file, text.replace(text.find("name: cross"), 11, "name: other"));
  expect(run_program("info " + file.string()), kWrongUsage,
         file.string() + ": the parts of the calibration do not fit");
  expect(run_program("info " + (folder_ / "none.yaml").string()), kFailed, "none.yaml: ");
}

TEST_F(CalibrationInfo, OptionsForRecordingsAreWrongUse) {
  expect(run_program("info --doppler-sign away " + known_error().string()), kWrongUsage, "'doppler-sign'");
}

TEST_F(CalibrationInfo, ARecordingStaysOne) {
  const fs::path recording = folder_ / "recording";
  fs::copy(street(), recording, fs::copy_options::recursive);
  fs::copy_file(known_error(), recording / "calibration.yaml");
  expect(run_program("info " + recording.string()), kDone, "format       dicp");
}

}  // namespace
}  // namespace dynamic_icp::tests
