// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/tracking_score.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "dynamic_icp/recording/evaluation/assignment.hpp"

namespace dynamic_icp::evaluation {
namespace {

constexpr int kThresholds = 19;  // 0.05, 0.1, ... 0.95
constexpr double kReached = 1e-9;

// What continues a pair goes before any similarity.
constexpr double kContinued = 1000.0;

/// Ids as numbers from 0 on.
class Numbers {
 public:
  std::size_t of(std::int64_t id) { return number_.try_emplace(id, number_.size()).first->second; }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(number_.size()); }

 private:
  std::map<std::int64_t, std::size_t> number_;
};

/// A scan with numbers for ids.
struct NumberedScan {
  std::vector<Eigen::Index> truth;
  std::vector<Eigen::Index> reported;
  const Eigen::MatrixXd* similarity = nullptr;
};

struct Sequence {
  std::vector<NumberedScan> scans;
  Eigen::VectorXd true_counts;  ///< scans in which each body is there
  Eigen::VectorXd reported_counts;
};

Sequence numbered(const std::vector<ScoredScan>& scans) {
  Sequence sequence;
  Numbers truth;
  Numbers reported;
  for (const ScoredScan& scan : scans) {
    NumberedScan& now = sequence.scans.emplace_back();
    now.similarity = &scan.similarity;
    for (const std::int64_t id : scan.true_ids) {
      now.truth.push_back(static_cast<Eigen::Index>(truth.of(id)));
    }
    for (const std::int64_t id : scan.reported_ids) {
      now.reported.push_back(static_cast<Eigen::Index>(reported.of(id)));
    }
  }
  sequence.true_counts = Eigen::VectorXd::Zero(truth.size());
  sequence.reported_counts = Eigen::VectorXd::Zero(reported.size());
  for (const NumberedScan& scan : sequence.scans) {
    for (const Eigen::Index body : scan.truth) {
      ++sequence.true_counts[body];
    }
    for (const Eigen::Index body : scan.reported) {
      ++sequence.reported_counts[body];
    }
  }
  return sequence;
}

/// counts(i, j) over the scans in which i or j are there, counts: those with both as a pair.
Eigen::MatrixXd jaccard(const Sequence& sequence, const Eigen::MatrixXd& counts) {
  Eigen::MatrixXd result = counts;
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      result(i, j) /= sequence.true_counts[i] + sequence.reported_counts[j] - counts(i, j);
    }
  }
  return result;
}

/// How well bodies go together over all scans, each pair with its part of the similarity in its scan.
Eigen::MatrixXd alignment(const Sequence& sequence) {
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(sequence.true_counts.size(), sequence.reported_counts.size());
  for (const NumberedScan& scan : sequence.scans) {
    const Eigen::MatrixXd& s = *scan.similarity;
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      for (std::size_t j = 0; j < scan.reported.size(); ++j) {
        const auto row = static_cast<Eigen::Index>(i);
        const auto column = static_cast<Eigen::Index>(j);
        if (s(row, column) > 0.0) {
          counts(scan.truth[i], scan.reported[j]) +=
              s(row, column) / (s.row(row).sum() + s.col(column).sum() - s(row, column));
        }
      }
    }
  }
  return jaccard(sequence, counts);
}

struct Pair {
  Eigen::Index truth = 0;
  Eigen::Index reported = 0;
  double similarity = 0.0;
};

/// The pairs of a scan that are best by these scores.
std::vector<Pair> pairs_of(const NumberedScan& scan, const Eigen::MatrixXd& scores) {
  std::vector<Pair> pairs;
  const auto columns = best_assignment(scores);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i]) {
      pairs.push_back({scan.truth[i], scan.reported[*columns[i]],
                       (*scan.similarity)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*columns[i]))});
    }
  }
  return pairs;
}

template <class Score>
Eigen::MatrixXd scores_of(const NumberedScan& scan, const Score& score) {
  return Eigen::MatrixXd::NullaryExpr(
      scan.similarity->rows(), scan.similarity->cols(), [&](Eigen::Index i, Eigen::Index j) {
        return score(scan.truth[static_cast<std::size_t>(i)], scan.reported[static_cast<std::size_t>(j)],
                     (*scan.similarity)(i, j));
      });
}

void add_hota(const Sequence& sequence, TrackingScore& result) {
  const Eigen::MatrixXd together = alignment(sequence);
  std::vector<Pair> pairs;
  for (const NumberedScan& scan : sequence.scans) {
    const auto found =
        pairs_of(scan, scores_of(scan, [&](Eigen::Index i, Eigen::Index j, double s) { return together(i, j) * s; }));
    pairs.insert(pairs.end(), found.begin(), found.end());
  }
  const double all = sequence.true_counts.sum() + sequence.reported_counts.sum();
  double hota = 0.0, detection = 0.0, association = 0.0, localisation = 0.0;
  for (int k = 1; k <= kThresholds; ++k) {
    const double threshold = 0.05 * k - kReached;
    Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(sequence.true_counts.size(), sequence.reported_counts.size());
    double similarity = 0.0;
    for (const Pair& pair : pairs) {
      if (pair.similarity >= threshold) {
        ++counts(pair.truth, pair.reported);
        similarity += pair.similarity;
      }
    }
    const double found = counts.sum();
    const double det = found / (all - found);
    const double ass = found > 0.0 ? counts.cwiseProduct(jaccard(sequence, counts)).sum() / found : 0.0;
    hota += std::sqrt(det * ass) / kThresholds;
    detection += det / kThresholds;
    association += ass / kThresholds;
    localisation += (found > 0.0 ? similarity / found : 1.0) / kThresholds;
  }
  result.hota = hota;
  result.detection = detection;
  result.association = association;
  result.localisation = localisation;
}

/// Pairs of the scan before go on where they may.
void add_clear_mot(const Sequence& sequence, double threshold, TrackingScore& result) {
  std::map<Eigen::Index, Eigen::Index> last;    // the reported body that each true one had when it was found last
  std::map<Eigen::Index, Eigen::Index> before;  // in the scan before
  for (const NumberedScan& scan : sequence.scans) {
    const auto pairs = pairs_of(scan, scores_of(scan, [&](Eigen::Index i, Eigen::Index j, double s) {
                                  const auto had = before.find(i);
                                  const bool is_continued = had != before.end() && had->second == j;
                                  return s < threshold - kReached ? 0.0 : s + (is_continued ? kContinued : 0.0);
                                }));
    before.clear();
    for (const Pair& pair : pairs) {
      const auto [had, is_new] = last.try_emplace(pair.truth, pair.reported);
      if (!is_new && had->second != pair.reported) {
        ++result.id_switches;
        had->second = pair.reported;
      }
      before[pair.truth] = pair.reported;
    }
    result.true_bodies += scan.truth.size();
    result.found += pairs.size();
    result.false_bodies += scan.reported.size() - pairs.size();
  }
  if (result.true_bodies > 0) {
    const std::size_t errors = result.true_bodies - result.found + result.false_bodies + result.id_switches;
    result.mota = 1.0 - static_cast<double>(errors) / static_cast<double>(result.true_bodies);
  }
}

/// One reported body for each true one, over all scans.
void add_idf1(const Sequence& sequence, double threshold, TrackingScore& result) {
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(sequence.true_counts.size(), sequence.reported_counts.size());
  for (const NumberedScan& scan : sequence.scans) {
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      for (std::size_t j = 0; j < scan.reported.size(); ++j) {
        const double s = (*scan.similarity)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        counts(scan.truth[i], scan.reported[j]) += s >= threshold - kReached ? 1.0 : 0.0;
      }
    }
  }
  double found = 0.0;
  const auto columns = best_assignment(counts);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    found += columns[i] ? counts(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*columns[i])) : 0.0;
  }
  result.idf1 = 2.0 * found / (sequence.true_counts.sum() + sequence.reported_counts.sum());
}

}  // namespace

TrackingScore score_tracking(const std::vector<ScoredScan>& scans, double threshold) {
  const Sequence sequence = numbered(scans);
  TrackingScore result;
  add_clear_mot(sequence, threshold, result);
  if (sequence.true_counts.size() + sequence.reported_counts.size() > 0) {
    add_hota(sequence, result);
    add_idf1(sequence, threshold, result);
  }
  return result;
}

}  // namespace dynamic_icp::evaluation
