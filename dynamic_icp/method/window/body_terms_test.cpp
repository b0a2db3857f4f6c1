// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/body_terms.hpp"

#include <cmath>
#include <random>
#include <utility>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

constexpr double kJamPeriod_s = 0.1;
constexpr double kJamSigma_mps = 0.05;
constexpr double kJamNoiseShare = 0.2;
constexpr std::size_t kField = 4;  // one column for each body, and one without

/// Lorries ahead, of which the rear and a side are seen. The Doppler of body k errs by theta[k].
class Jam {
 public:
  /// The sensor is believed to move by `sensor_error` (m/s) too fast, and so is all over ground.
  explicit Jam(const Eigen::Vector3d& sensor_error, unsigned seed = 1) : sensor_error_(sensor_error), random_(seed) {}

  std::vector<SeenBody> scan(int k, std::int64_t first_id = 1) {
    std::vector<SeenBody> bodies;
    const double time_s = k * kJamPeriod_s;
    for (int n = 0; n < 3; ++n) {
      const Eigen::Vector3d velocity = Eigen::Vector3d(1.0 + n, 0.0, 0.0) + sensor_error_;
      SeenBody body;
      body.id = first_id + n;
      body.time_s = time_s;
      body.centre = Eigen::Vector3d(15.0 + 8.0 * n, 6.0 * (n - 1), 0.0) + time_s * velocity;
      body.velocity = velocity - believed_off;
      for (const Eigen::Vector3d& point : points()) {
        body.points.push_back(body.centre + point);
        if (body.points.size() % 30 == 0) {
          BodyDoppler one;
          one.u = body.points.back().normalized();
          one.lever = point;
          one.columns.add(static_cast<std::size_t>(n), 1.0);
          one.s = one.u.dot(velocity) + error[n] + kJamSigma_mps * normal_(random_);
          body.doppler.push_back(one);
        }
      }
      bodies.push_back(std::move(body));
    }
    return bodies;
  }

  Eigen::Vector3d error{0.2, -0.3, 0.1};        ///< m/s
  Eigen::Vector3d believed_off{0.1, 0.1, 0.0};  ///< m/s, by how much the bodies are believed to be too slow

 private:
  std::vector<Eigen::Vector3d> points() {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Eigen::Vector3d> result;
    for (int k = 0; k < 400; ++k) {
      result.emplace_back(-4.0, 1.25 * uniform(random_), 1.5 * uniform(random_));
      result.emplace_back(4.0 * uniform(random_), -1.25, 1.5 * uniform(random_));
    }
    for (Eigen::Vector3d& point : result) {
      point += 0.01 * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
    }
    return result;
  }

  Eigen::Vector3d sensor_error_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

std::optional<FieldInformation> compare(BodyTerms& terms, std::vector<SeenBody> bodies,
                                        const Eigen::VectorXd& theta = Eigen::VectorXd::Zero(kField)) {
  return terms.compare(std::move(bodies), theta, kJamSigma_mps, kJamNoiseShare, Workers(1));
}

/// The change of theta, of which nothing else is known but that it is below some m/s.
Eigen::VectorXd told_change(const FieldInformation& told) {
  Eigen::MatrixXd H = told.H.selfadjointView<Eigen::Lower>();
  H.diagonal().array() += 1e-2;
  return H.ldlt().solve(-told.g);
}

std::optional<FieldInformation> told_after(Jam& jam, int scans, const Eigen::VectorXd& theta) {
  BodyTerms terms;
  std::optional<FieldInformation> told;
  for (int k = 0; k < scans; ++k) {
    told = compare(terms, jam.scan(k), theta);
  }
  return told;
}

TEST(BodyTerms, TellTheErrorOfTheDopplerHoweverTheSensorMoves) {
  for (const Eigen::Vector3d& sensor_error :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.3, -0.5, 0.0), Eigen::Vector3d(-1.0, 0.8, 0.1)}) {
    Jam jam(sensor_error);
    const auto told = told_after(jam, 8, Eigen::VectorXd::Zero(kField));
    ASSERT_TRUE(told);
    const Eigen::VectorXd found = told_change(*told);
    for (Eigen::Index n = 0; n < 3; ++n) {
      EXPECT_NEAR(found[n], jam.error[n], 0.05) << "body " << n << ", sensor off by " << sensor_error.transpose();
    }
    EXPECT_EQ(found[3], 0.0) << "no body shows it";
  }
}

TEST(BodyTerms, TellTheChangeOfWhatIsKnown) {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(kField);
  theta << 0.15, -0.1, 0.3, 0.0;
  Jam jam(Eigen::Vector3d::Zero());
  const auto told = told_after(jam, 8, theta);
  ASSERT_TRUE(told);
  const Eigen::VectorXd found = told_change(*told);
  for (Eigen::Index n = 0; n < 3; ++n) {
    EXPECT_NEAR(theta[n] + found[n], jam.error[n], 0.05);
  }
}

/// The variance that is stated holds: over many jams the squared errors over it are 1 or less in the mean.
TEST(BodyTerms, StateNoLessThanTheirErrors) {
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Jam jam(Eigen::Vector3d::Zero(), seed);
    const auto told = told_after(jam, 8, Eigen::VectorXd::Zero(kField));
    ASSERT_TRUE(told);
    const Eigen::VectorXd found = told_change(*told);
    for (Eigen::Index n = 0; n < 3; ++n) {
      squares += (found[n] - jam.error[n]) * (found[n] - jam.error[n]) * told->H(n, n);
      ++count;
    }
  }
  EXPECT_LT(squares / count, 1.0);
}

TEST(BodyTerms, NeedThreeScansBefore) {
  Jam jam(Eigen::Vector3d::Zero());
  EXPECT_FALSE(told_after(jam, 3, Eigen::VectorXd::Zero(kField)));
  EXPECT_TRUE(told_after(jam, 4, Eigen::VectorXd::Zero(kField)));
}

TEST(BodyTerms, CompareBodiesWithThemselvesAlone) {
  Jam jam(Eigen::Vector3d::Zero());
  BodyTerms terms;
  for (int k = 0; k < 6; ++k) {
    EXPECT_FALSE(compare(terms, jam.scan(k, 1 + 10 * k)));
  }
}

TEST(BodyTerms, AreNotToldByAnotherBody) {
  Jam jam(Eigen::Vector3d::Zero());
  BodyTerms terms;
  for (int k = 0; k < 6; ++k) {
    terms.remember(jam.scan(k));
  }
  std::vector<SeenBody> elsewhere = jam.scan(6);
  for (SeenBody& body : elsewhere) {
    for (Eigen::Vector3d& point : body.points) {
      point.x() += 3.0;
    }
  }
  EXPECT_FALSE(compare(terms, std::move(elsewhere)));
}

TEST(BodyTerms, TellTheSameWithAnyNumberOfThreads) {
  std::vector<FieldInformation> told;
  for (const int threads : {1, 3}) {
    Jam jam(Eigen::Vector3d::Zero());
    BodyTerms terms;
    const Workers workers(threads);
    for (int k = 0; k < 6; ++k) {
      terms.remember(jam.scan(k));
    }
    told.push_back(
        terms.compare(jam.scan(6), Eigen::VectorXd::Zero(kField), kJamSigma_mps, kJamNoiseShare, workers).value());
  }
  EXPECT_EQ(told[0].H, told[1].H);
  EXPECT_EQ(told[0].g, told[1].g);
}

TEST(BodyTerms, GoOnFromASavedState) {
  Jam jam(Eigen::Vector3d::Zero());
  BodyTerms terms;
  for (int k = 0; k < 6; ++k) {
    terms.remember(jam.scan(k));
  }
  StateArchive out;
  terms.state(out, kField);
  const std::string bytes = out.take();
  StateArchive in(bytes);
  BodyTerms again;
  again.state(in, kField);
  const std::vector<SeenBody> next = jam.scan(6);
  EXPECT_EQ(compare(terms, next).value().g, compare(again, next).value().g);

  StateArchive smaller(bytes);
  BodyTerms other;
  EXPECT_THROW(other.state(smaller, 2), DataError) << "columns beyond the field";
}

}  // namespace
}  // namespace dynamic_icp::window
