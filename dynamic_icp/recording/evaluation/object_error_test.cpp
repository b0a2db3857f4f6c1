// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_error.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::evaluation {
namespace {

const ObjectMatching kFromTheFirstScan{.warm_up_scans = 0};

/// A car of 4 m, 20 m ahead, driving at 10 m/s along x, seen by 100 points.
TrueObject car() { return {{10, 0, 0}, {20, 0, 0}, {4, 2, 1.5}, 100}; }

std::vector<TrueObjects> one_scan(const std::vector<TrueObject>& objects) { return {{0, objects}}; }

TEST(ObjectError, OfNothingIsNothing) {
  const ObjectError none = compare_objects({}, {});
  EXPECT_EQ(none.scans, 0u);
  EXPECT_FALSE(none.along_mae_mps || none.lateral_mae_mps || none.median_relative_error || none.estimated_share ||
               none.false_per_scan);
  const ObjectError missed = compare_objects(one_scan({car()}), {{0, {}}}, kFromTheFirstScan);
  EXPECT_EQ(missed.estimated_share, 0.0);
  EXPECT_EQ(missed.false_per_scan, 0.0);
  EXPECT_FALSE(missed.along_mae_mps);
}

TEST(ObjectError, SplitsTheErrorByTheDirectionOfMotion) {
  TrueObject object = car();
  object.velocity = {3, 4, 0};  // 5 m/s
  // 2 m/s too fast along (0.6, 0.8, 0); across it 1.5 along (-0.8, 0.6, 0) and 2 upwards: 2.5 together.
  const Eigen::Vector3d reported(3 + 1.2 - 1.2, 4 + 1.6 + 0.9, 2);
  const ObjectError error = compare_objects(one_scan({object}), {{0, {{reported, {20, 0, 0}}}}}, kFromTheFirstScan);
  EXPECT_NEAR(*error.along_mae_mps, 2.0, 1e-12);
  EXPECT_NEAR(*error.lateral_mae_mps, 2.5, 1e-12);
  EXPECT_NEAR(*error.median_relative_error, 0.4, 1e-12);
  EXPECT_EQ(error.estimated_share, 1.0);
}

TEST(ObjectError, TakesTheNearestWithinReach) {
  const ReportedObject near{{11, 0, 0}, {22, 0, 0}};
  const ReportedObject farther{{30, 0, 0}, {24, 0, 0}};
  const ReportedObject just_outside{{50, 0, 0}, {25, 0, 0}};  // reach: 3 m and half of 4 m
  const ObjectError error = compare_objects(one_scan({car()}), {{0, {just_outside, farther, near}}}, kFromTheFirstScan);
  EXPECT_NEAR(*error.along_mae_mps, 1.0, 1e-12);
  EXPECT_EQ(error.false_objects, 1u) << "only the one outside";
}

TEST(ObjectError, SmallSlowAndEarlyObjectsDoNotCountButAreNotFalseEither) {
  TrueObject few = car();
  few.points = 49;
  TrueObject slow = car();
  slow.velocity = {1.9, 0, 0};
  const std::vector<ReportedObjects> reported = {{0, {{{0, 0, 0}, {20, 0, 0}}}}};
  for (const TrueObject& object : {few, slow}) {
    const ObjectError error = compare_objects(one_scan({object}), reported, kFromTheFirstScan);
    EXPECT_EQ(error.true_objects, 0u);
    EXPECT_EQ(error.false_objects, 0u);
    EXPECT_FALSE(error.estimated_share);
  }
  EXPECT_EQ(compare_objects(one_scan({car()}), reported).true_objects, 0u) << "warming up";
}

TEST(ObjectError, PairsScansByTheirIndex) {
  TrueObject truck = car();
  truck.velocity = {20, 0, 0};
  const std::vector<TrueObjects> truth = {{0, {car()}}, {1, {truck}}};
  const std::vector<ReportedObjects> reported = {{1, {{{20, 0, 0}, {20, 0, 0}}}}, {7, {{{9, 9, 9}, {20, 0, 0}}}}};
  const ObjectError error = compare_objects(truth, reported, kFromTheFirstScan);
  EXPECT_EQ(error.scans, 1u) << "scan 7 has no truth";
  EXPECT_EQ(error.along_mae_mps, 0.0);
  EXPECT_EQ(error.false_objects, 0u);
}

class ObjectFiles : public ::testing::Test {
 protected:
  ~ObjectFiles() override { std::filesystem::remove(path_); }

  const std::filesystem::path& file(const std::string& content) {
    std::ofstream(path_) << content;
    return path_;
  }

  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("dynamic_icp_objects-" + std::to_string(::getpid()));
};

TEST_F(ObjectFiles, AreReadAsTheyAreWritten) {
  const auto truth = read_true_objects(
      file("{\"index\":3,\"timestamp\":0.1,\"objects\":[{\"id\":5,\"kind\":\"car\",\"velocity_sensor\":[1,2,3],"
           "\"center_sensor\":[4,5,6],\"size\":[7,8,9],\"points\":10}]}\n{\"index\":4,\"objects\":[]}\n"));
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_EQ(truth[0].index, 3);
  EXPECT_EQ(truth[0].objects[0].velocity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(truth[0].objects[0].center, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(truth[0].objects[0].size, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(truth[0].objects[0].points, 10u);
  EXPECT_TRUE(truth[1].objects.empty());
}

TEST_F(ObjectFiles, RefusalsNameTheLine) {
  for (const char* wrong : {"{", "[]", "{\"index\":0}",
                            "{\"index\":0,\"objects\":[{\"velocity_sensor\":[1,2],\"center_sensor\":[4,5,6],\"size\":["
                            "7,8,9],\"points\":1}]}",
                            "{\"index\":0,\"objects\":[{\"velocity_sensor\":[1,null,2],\"center_sensor\":[4,5,6],"
                            "\"size\":[7,8,9],\"points\":1}]}"}) {
    try {
      read_true_objects(file(std::string("{\"index\":0,\"objects\":[]}\n") + wrong + "\n"));
      ADD_FAILURE() << wrong;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(path_.string() + ", line 2"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_true_objects("/nowhere/objects.jsonl"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
