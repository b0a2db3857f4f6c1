// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/tracking_score.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

constexpr double kThreshold = 0.5;

/// A body with the id 1 that is reported with these ids in one scan after the other; 0: not at all.
std::vector<ScoredScan> one_body(const std::vector<std::int64_t>& ids, double similarity = 1.0) {
  std::vector<ScoredScan> scans;
  for (const std::int64_t id : ids) {
    ScoredScan scan;
    scan.true_ids = {1};
    if (id != 0) {
      scan.reported_ids = {id};
    }
    scan.similarity = Eigen::MatrixXd::Constant(1, id == 0 ? 0 : 1, similarity);
    scans.push_back(scan);
  }
  return scans;
}

TEST(TrackingScore, OfATrackWithoutErrorIsOne) {
  const TrackingScore score = score_tracking(one_body({7, 7, 7, 7}), kThreshold);
  EXPECT_NEAR(*score.hota, 1.0, 1e-12);
  EXPECT_NEAR(*score.localisation, 1.0, 1e-12);
  EXPECT_EQ(score.mota, 1.0);
  EXPECT_EQ(score.idf1, 1.0);
  EXPECT_EQ(score.found, 4U);
  EXPECT_EQ(score.id_switches, 0U);
}

TEST(TrackingScore, OfNothingIsNothing) {
  const TrackingScore none = score_tracking({}, kThreshold);
  EXPECT_FALSE(none.hota || none.mota || none.idf1);
  const TrackingScore missed = score_tracking(one_body({0, 0}), kThreshold);
  EXPECT_EQ(missed.hota, 0.0);
  EXPECT_EQ(missed.mota, 0.0);
  EXPECT_EQ(missed.idf1, 0.0);
  ScoredScan invented;
  invented.reported_ids = {3};
  invented.similarity.resize(0, 1);
  const TrackingScore false_ones = score_tracking({invented}, kThreshold);
  EXPECT_EQ(false_ones.false_bodies, 1U);
  EXPECT_FALSE(false_ones.mota) << "there is nothing to be found";
}

TEST(TrackingScore, CountsAnIdThatChanges) {
  // Found in all four scans, three of them with one id: MOTA loses a quarter, IDF1 too. Of the association three pairs
  // have 3 of 4 scans in common, one has 1 of 4: (3 * 3/4 + 1/4) / 4 = 5/8.
  const TrackingScore score = score_tracking(one_body({7, 7, 7, 8}), kThreshold);
  EXPECT_EQ(score.id_switches, 1U);
  EXPECT_NEAR(*score.mota, 0.75, 1e-12);
  EXPECT_NEAR(*score.idf1, 0.75, 1e-12);
  EXPECT_NEAR(*score.detection, 1.0, 1e-12);
  EXPECT_NEAR(*score.association, 0.625, 1e-12);
  EXPECT_NEAR(*score.hota, std::sqrt(0.625), 1e-12);
  EXPECT_EQ(score_tracking(one_body({7, 0, 7, 8, 7}), kThreshold).id_switches, 2U) << "there and back, not by a gap";
}

TEST(TrackingScore, PairsByTheThresholdsThatTheSimilarityReaches) {
  // 0.62 is reached by 12 of 19 thresholds.
  const TrackingScore score = score_tracking(one_body({7, 7}, 0.62), kThreshold);
  EXPECT_NEAR(*score.hota, 12.0 / 19.0, 1e-12);
  EXPECT_NEAR(*score.localisation, (12.0 * 0.62 + 7.0) / 19.0, 1e-12);
  EXPECT_EQ(score.mota, 1.0);
  const TrackingScore far_off = score_tracking(one_body({7, 7}, 0.4), kThreshold);
  EXPECT_EQ(far_off.mota, -1.0) << "missed and invented, twice";
  EXPECT_EQ(far_off.idf1, 0.0);
}

TEST(TrackingScore, KeepsAPairThatGoesOn) {
  // Two bodies side by side, the second scan fits the other way round a little better: no switch.
  ScoredScan first;
  first.true_ids = {1, 2};
  first.reported_ids = {10, 20};
  first.similarity = Eigen::MatrixXd::Identity(2, 2);
  ScoredScan second = first;
  second.similarity << 0.6, 0.7, 0.7, 0.6;
  EXPECT_EQ(score_tracking({first, second}, kThreshold).id_switches, 0U);
  second.similarity << 0.2, 0.7, 0.7, 0.2;  // pairs that cannot go on
  EXPECT_EQ(score_tracking({first, second}, kThreshold).id_switches, 2U);
}

TEST(TrackingScore, DetectionIsMissesAndInventionsTogether) {
  // Three scans: found, missed, found beside an invention: 2 of 2 + 1 + 1.
  std::vector<ScoredScan> scans = one_body({7, 0, 7});
  scans[2].reported_ids.push_back(9);
  scans[2].similarity = Eigen::RowVector2d(1.0, 0.0);
  const TrackingScore score = score_tracking(scans, kThreshold);
  EXPECT_NEAR(*score.detection, 0.5, 1e-12);
  EXPECT_NEAR(*score.association, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(*score.mota, 1.0 - 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(*score.idf1, 2.0 * 2.0 / (3.0 + 3.0), 1e-12);
  EXPECT_EQ(score.false_bodies, 1U);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
