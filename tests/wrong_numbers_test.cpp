// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Numbers that are read, but are not what they are taken for.
#include <cmath>
#include <numbers>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tests/forms.hpp"

namespace dynamic_icp::tests::forms {
namespace {

TEST_F(OpenDoor, WrongNumbersAreMendedByTheAdvice) {
  const auto changed = [](double point, double doppler) {
    return [=](const RawScan& scan, std::size_t i) -> Row {
      const Eigen::Vector3d p = point * scan.points[i];
      return {p.x(), p.y(), p.z(), doppler * scan.doppler[i]};
    };
  };
  const auto spherical = [](double per_radian) {
    return [=](const RawScan& scan, std::size_t i) -> Row {
      const Eigen::Vector3d& p = scan.points[i];
      return {per_radian * std::atan2(p.y(), p.x()), per_radian * std::atan2(p.z(), p.head<2>().norm()), p.norm(),
              scan.doppler[i]};
    };
  };
  const auto range_first = [&](const RawScan& scan, std::size_t i) -> Row {
    const Row row = spherical(180.0 / std::numbers::pi)(scan, i);
    return {row[2], row[0], row[1], row[3]};
  };
  struct Wrong {
    const char* name;
    RowOf row_of;
    const char* advice;
  };
  const Wrong all[] = {
      {"plain", xyzd, nullptr},
      {"kmh", changed(1.0, 3.6), "--doppler-scale 0.27"},
      {"mm", changed(1000.0, 1.0), "--point-scale 0.001"},
      {"degrees", spherical(180.0 / std::numbers::pi), "--columns azimuth_deg,elevation_deg,range,doppler"},
      {"radians", spherical(1.0), "--columns azimuth_rad,elevation_rad,range,doppler"},
      {"range first", range_first, "--columns range,azimuth_deg,elevation_deg,doppler"},
      {"towards", changed(1.0, -1.0), "--doppler-sign towards"}};
  for (const Wrong& wrong : all) {
    SCOPED_TRACE(wrong.name);
    const fs::path input = folder_ / wrong.name;
    counted("point_clouds/{:05d}.bin", records<float>(wrong.row_of))(drive(), input);
    write(input / "ref_poses.txt", drive().poses);
    std::string command = fmt::format("run --quiet '{}' --output '{}'", input.string(), (input / "out").string());
    if (wrong.advice != nullptr) {
      const Outcome refused = run_program(command);
      EXPECT_EQ(refused.status, kFailed) << refused.text;
      EXPECT_NE(refused.text.find(wrong.advice), std::string::npos) << refused.text;
      EXPECT_FALSE(fs::exists(input / "out"));
      command += fmt::format(" {}", fmt::join(options_in(refused.text), " "));
    }
    const Outcome mended = run_program(command);
    ASSERT_EQ(mended.status, kDone) << mended.text;
    EXPECT_LT(nlohmann::json::parse(read_file(input / "out" / "summary.json")).at("rte_rmse_m").get<double>(), 0.05);
  }
}

TEST_F(OpenDoor, AnglesOfASensorAtRestAreMendedByTheAdvice) {
  const std::string cartesian = (folder_ / "cartesian").string();
  ASSERT_EQ(run_program("simulate stationary --frames 2 --quiet --output " + cartesian).status, kDone);
  const RawScan expected = datasets::open_input(cartesian, {})->scan(0);
  for (const double per_radian : {1.0, 180.0 / std::numbers::pi}) {
    SCOPED_TRACE(per_radian);
    const auto range_first = [&](const RawScan& scan, std::size_t i) -> Row {
      const Eigen::Vector3d& p = scan.points[i];
      return {p.norm(), per_radian * std::atan2(p.y(), p.x()), per_radian * std::atan2(p.z(), p.head<2>().norm()),
              scan.doppler[i]};
    };
    const fs::path input = folder_ / fmt::format("{}", per_radian);
    write(input / "0.bin", records<double>(range_first)(expected));
    const std::string command = fmt::format("info '{}' --dtype float64", input.string());
    const Outcome suspected = run_program(command);
    ASSERT_EQ(suspected.status, kDone) << suspected.text;
    std::smatch advice;
    ASSERT_TRUE(std::regex_search(suspected.text, advice, std::regex("--columns ([a-z_,]+)"))) << suspected.text;
    const Outcome mended = run_program(command + " " + advice.str());
    EXPECT_EQ(mended.text.find("look like spherical"), std::string::npos) << mended.text;
    datasets::InputSettings settings;
    datasets::set(settings, "dtype", "float64");
    datasets::set(settings, "columns", advice.str(1));
    const RawScan scan = datasets::open_input(input, settings)->scan(0);
    ASSERT_EQ(scan.points.size(), expected.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      EXPECT_LT((scan.points[i] - expected.points[i]).norm(), 1e-9 * (1.0 + expected.points[i].norm()));
    }
  }
}

TEST_F(OpenDoor, AnotherColumnIsNamedAsTheDopplerInTheWayThatItCanBe) {
  const auto with_reflectance = [](const RawScan& scan, std::size_t i) -> Row {
    const Eigen::Vector3d& p = scan.points[i];
    return {p.x(), p.y(), p.z(), 40.0 + 20.0 * std::sin(12.9898 * static_cast<double>(i)), scan.doppler[i]};
  };
  struct Form {
    Writer write;
    const char* stated;
    const char* advice;
  };
  const Form all[] = {
      {counted("{}.csv", text(with_reflectance, ",", "x,y,z,doppler,foo\n")), "", "--field doppler=foo"},
      {counted("{}.csv", text(with_reflectance, ",")), "x,y,z,doppler,_", "--columns x,y,z,_,doppler"},
      {counted("{}.npy", npy(with_reflectance)), "x,y,z,doppler,_", "--columns x,y,z,_,doppler"},
      {counted("{}.bin", records<float>(with_reflectance)), "x,y,z,doppler,_", "--columns x,y,z,_,doppler"}};
  std::size_t number = 0;
  for (const Form& form : all) {
    SCOPED_TRACE(number);
    const fs::path input = form.write(drive(), folder_ / fmt::format("{}", ++number));
    const std::string stated = *form.stated == '\0' ? "" : fmt::format(" --columns {}", form.stated);
    const Outcome info = run_program(fmt::format("info {}{}", input.string(), stated));
    ASSERT_EQ(info.status, kDone) << info.text;
    ASSERT_NE(info.text.find(fmt::format("fix with {}\n", form.advice)), std::string::npos) << info.text;
    expect_same(*datasets::open_input(input, pasted(form.advice)), drive().scans.size());
  }
}

TEST_F(OpenDoor, ColumnsWithNamesThatAreStatedInTheirOrderAreSaidByTheirNames) {
  const fs::path input = counted("{}.csv", text(xyzid, ",", "a,b,c,d,e\n"))(drive(), folder_ / "named");
  const Outcome refused = run_program("info " + input.string() + " --columns x,y,z,_,doppler");
  EXPECT_EQ(refused.status, kFailed) << refused.text;
  ASSERT_NE(refused.text.find("--field x=a --field y=b --field z=c --field doppler=e"), std::string::npos)
      << refused.text;
  expect_same(*datasets::open_input(input, pasted(refused.text)), drive().scans.size());
  const fs::path half = counted("{}.csv", text(xyzd, ",", "a,b,c,foo\n"))(drive(), folder_ / "half");
  const Outcome unclear = run_program("info " + half.string() + " --field x=a --field y=b --field z=c");
  EXPECT_EQ(unclear.status, kFailed) << unclear.text;
  expect_same(*datasets::open_input(half, pasted(unclear.text)), drive().scans.size());
}

TEST_F(OpenDoor, SphericalColumnsWithNamesAreReadOrSayHow) {
  const auto angles = [](double per_radian, bool from_zenith) {
    return [=](const RawScan& scan, std::size_t i) -> Row {
      const Eigen::Vector3d& p = scan.points[i];
      const double elevation = std::atan2(p.z(), p.head<2>().norm());
      return {p.norm(), per_radian * std::atan2(p.y(), p.x()),
              per_radian * (from_zenith ? std::numbers::pi / 2.0 - elevation : elevation), scan.doppler[i]};
    };
  };
  const RowOf degrees = angles(180.0 / std::numbers::pi, false);
  const RowOf radians = angles(1.0, false);
  struct Form {
    const char* name;
    ContentOf content;
    const char* advice;
  };
  const Form all[] = {
      {"degrees.csv", text(degrees, ",", "range,azimuth,elevation,velocity\n"), nullptr},
      {"named.csv", text(radians, ",", "Range_m,Azimuth_rad,Elevation_rad,Doppler\n"), nullptr},
      {"brackets.csv", text(radians, ";", "Range [m];Azimuth [rad];Elevation [rad];Doppler [m/s]\n"), nullptr},
      {"polar.txt", text(angles(180.0 / std::numbers::pi, true), " ", "# r phi theta v_r\n"), nullptr},
      {"radians.csv", text(radians, ",", "range,azimuth,elevation,velocity\n"),
       "--field azimuth_rad=azimuth --field elevation_rad=elevation"},
      {"theta.csv", text(angles(1.0, true), ",", "r,phi,theta,velocity\n"),
       "--field azimuth_rad=phi --field polar_rad=theta"}};
  for (const Form& form : all) {
    SCOPED_TRACE(form.name);
    const fs::path input = single(form.name, form.content)(drive(), folder_ / "spherical");
    datasets::InputSettings settings;
    if (form.advice != nullptr) {
      const Outcome refused = run_program("info " + input.string());
      EXPECT_EQ(refused.status, kFailed) << refused.text;
      EXPECT_NE(refused.text.find(form.advice), std::string::npos) << refused.text;
      settings = pasted(refused.text);
    }
    const RawScan scan = datasets::open_input(input, settings)->scan(0);
    const RawScan& expected = drive().scans.front();
    ASSERT_EQ(scan.points.size(), expected.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      EXPECT_LT((scan.points[i] - expected.points[i]).norm(), 1e-9 * (1.0 + expected.points[i].norm()));
    }
    EXPECT_EQ(scan.doppler, expected.doppler);
    const Outcome twice = run_program("info " + input.string() + " --columns azimuth_deg,elevation_deg,range,doppler");
    EXPECT_NE(twice.status, kDone) << twice.text;
    EXPECT_NE(twice.text.find("by their names"), std::string::npos) << twice.text;
  }
}

TEST_F(OpenDoor, PointsWithoutTimesAreSpokenOf) {
  const fs::path input = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  write(input / "ref_poses.txt", drive().poses);
  const Outcome outcome = run_program(fmt::format("run {} --output {}", input.string(), (folder_ / "out").string()));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_NE(outcome.text.find("the points have no times"), std::string::npos) << outcome.text;
}

TEST_F(OpenDoor, ColumnsThatChangedPlacesAreSaidOfTheWholeRecord) {
  const auto doppler_first = [](const RawScan& scan, std::size_t i) -> Row {
    const Eigen::Vector3d& p = scan.points[i];
    return {scan.doppler[i], p.y(), p.z(), intensity(i), p.x()};
  };
  const fs::path input = counted("{}.bin", records<float>(doppler_first))(drive(), folder_ / "scans");
  const Outcome info = run_program("info " + input.string() + " --columns x,y,z,_,doppler");
  ASSERT_EQ(info.status, kDone) << info.text;
  ASSERT_NE(info.text.find("fix with --columns doppler,y,z,_,x"), std::string::npos) << info.text;
  datasets::InputSettings settings;
  datasets::set(settings, "columns", "doppler,y,z,_,x");
  expect_same(*datasets::open_input(input, settings), drive().scans.size());
}

}  // namespace
}  // namespace dynamic_icp::tests::forms
