// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The forms in which recordings lie around: each made of the same simulated drive, and read with the same numbers, or
// refused by a sentence whose options, pasted back, have it read with the same numbers.
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"

#include "tests/forms.hpp"

namespace dynamic_icp::tests::forms {
namespace {

TEST_F(OpenDoor, EveryFormIsReadOrSaysHow) {
  std::size_t number = 0;
  for (const Form& form : all_forms()) {
    SCOPED_TRACE(form.name);
    const fs::path input = form.write(drive(), folder_ / fmt::format("form_{}", ++number) / "data");
    const bool is_bag = input.extension() == ".bag" || input.extension() == ".mcap";
    const std::size_t scans = fs::is_directory(input) || is_bag ? drive().scans.size() : 1;
    try {
      const auto dataset = datasets::open_input(input, {});
      EXPECT_EQ(form.door, Door::kOpen);
      expect_same(*dataset, scans);
      continue;
    } catch (const DataError& error) {
      EXPECT_NE(form.door, Door::kOpen) << error.what();
    }
    const Outcome refused = run_program("info " + input.string());  // which spells the options
    const std::string& message = refused.text;
    EXPECT_EQ(refused.status, kFailed) << message;
    EXPECT_NE(message.find(form.said), std::string::npos) << message;
    EXPECT_EQ(options_in(message).empty(), form.door != Door::kWithAdvice) << message;
    if (form.door == Door::kWithAdvice) {
      try {
        expect_same(*datasets::open_input(input, pasted(message)), scans);
      } catch (const std::exception& error) {
        ADD_FAILURE() << "the advice of\n" << message << "\nhas it say\n" << error.what();
      }
    }
  }
  EXPECT_GE(number, 55U);
}

TEST_F(OpenDoor, TheProgramTakesItsOwnAdvice) {
  const fs::path plain = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  const fs::path five = counted("point_clouds/{:05d}.bin", records<float>(xyzid))(drive(), folder_ / "five");
  for (const fs::path& folder : {plain, five}) {
    write(folder / "ref_poses.txt", drive().poses);
  }
  const Outcome refused = run_program("info " + five.string());
  ASSERT_EQ(refused.status, kFailed) << refused.text;
  std::smatch advice;
  ASSERT_TRUE(std::regex_search(refused.text, advice, std::regex("--columns [^ \n]+"))) << refused.text;
  EXPECT_EQ(refused.text.find("--doppler-sign"), std::string::npos) << "only this is said";
  const std::string words = advice.str();
  EXPECT_EQ(run_program("info " + five.string() + " " + words).status, kDone);
  for (const char* format : {"", " --format bin"}) {
    const std::string out = (folder_ / fmt::format("out{}", std::string(format).size())).string();
    const Outcome run = run_program("run --quiet " + five.string() + " " + words + format + " --output " + out);
    ASSERT_EQ(run.status, kDone) << run.text;
    const Outcome reference =
        run_program("run --quiet --force " + plain.string() + " --output " + (folder_ / "reference").string());
    ASSERT_EQ(reference.status, kDone) << reference.text;
    EXPECT_EQ(read_file(fs::path(out) / "trajectory.tum"), read_file(folder_ / "reference" / "trajectory.tum"));
  }
}

TEST_F(OpenDoor, ABagThatWasCutIsReadUpToThere) {
  const std::string whole = bag_of(drive(), {{"/points", {"x", "y", "z", "doppler"}}});
  const fs::path file = folder_ / "cut.bag";
  write_file(file, whole.substr(0, whole.size() * 6 / 10));
  const auto dataset = datasets::open_input(file, {});
  ASSERT_GE(dataset->size(), 2U);
  ASSERT_LT(dataset->size(), drive().scans.size());
  expect_same(*dataset, dataset->size());
  const Outcome info = run_program("info " + file.string());
  EXPECT_EQ(info.status, kDone) << info.text;
  EXPECT_TRUE(std::regex_search(info.text, std::regex("cut.bag: [^\n]*(byte|offset) [0-9]+"))) << info.text;
}

TEST_F(OpenDoor, ATableOfSeveralScansIsTakenApartByItsRecipe) {
  std::string table = "frame,x,y,z,doppler\n";
  for (std::size_t i = 0; i < drive().scans.size(); ++i) {
    for (const Row& row : rows_of(drive().scans[i], xyzd)) {
      table += fmt::format("{},{}\n", i, fmt::join(row, ","));
    }
  }
  write_file(folder_ / "all.csv", table);
  const Outcome refused = run_program("info " + (folder_ / "all.csv").string());
  EXPECT_EQ(refused.status, kFailed) << refused.text;
  EXPECT_NE(refused.text.find("holds several scans, told apart by its column 'frame' (0, 1, ...)"), std::string::npos)
      << refused.text;
  const std::size_t recipe = refused.text.find("mkdir scans; awk");
  ASSERT_NE(recipe, std::string::npos) << refused.text;
  const Outcome done = run_shell("cd '" + folder_.string() + "' && { " + refused.text.substr(recipe) + "\n} 2>&1");
  ASSERT_EQ(done.status, 0) << done.text;
  expect_same(*datasets::open_input(folder_ / "scans", {}), drive().scans.size());
}

TEST_F(OpenDoor, OneScanIsToldWhatToDoWithTwo) {
  const fs::path scan = single("scan.pcd", pcd("x y z doppler"))(drive(), folder_);
  const Outcome info = run_program("info " + scan.string());
  EXPECT_NE(info.text.find("one scan: there is no motion to find; `register` aligns two"), std::string::npos)
      << info.text;
  const Outcome run = run_program(fmt::format("run {} --output {}", scan.string(), (folder_ / "out").string()));
  EXPECT_EQ(run.status, kDone) << run.text;
  EXPECT_NE(run.text.find("one scan: there is no motion to find"), std::string::npos) << run.text;
}

TEST_F(OpenDoor, RegisterReadsEveryForm) {
  const std::vector<RawScan>& scans = drive().scans;
  const std::pair<const char*, ContentOf> kinds[] = {
      {"bin", records<float>(xyzd)},
      {"pcd", pcd("x y z doppler")},
      {"npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("points", rows)}; })},
      {"npy", npy(xyzd)},
      {"csv", text(xyzd, ",", "x,y,z,doppler\n")}};
  std::string expected;
  for (const auto& [ending, content_of] : kinds) {
    SCOPED_TRACE(ending);
    std::string files;
    for (std::size_t i = 0; i < 2; ++i) {
      const fs::path file = folder_ / fmt::format("{}.{}", i, ending);
      write(file, content_of(scans[i]));
      files += " " + file.string();
    }
    const Outcome outcome = run_program("register --preset paper" + files + " 2>/dev/null");
    ASSERT_EQ(outcome.status, kDone) << outcome.text;
    const nlohmann::json pair = nlohmann::json::parse(outcome.text);
    const std::string transform = pair.at("T_target_source").dump();
    expected = expected.empty() ? transform : expected;
    EXPECT_EQ(transform, expected);
  }
  const fs::path records_of_five = folder_ / "five.bin";
  write(records_of_five, records<float>(xyzid)(scans[0]));
  const std::string five = records_of_five.string();
  EXPECT_EQ(run_program("register " + five + " " + five).status, kFailed);
  EXPECT_EQ(run_program("register " + five + " " + five + " --columns x,y,z,intensity,doppler").status, kDone);
}

}  // namespace
}  // namespace dynamic_icp::tests::forms
