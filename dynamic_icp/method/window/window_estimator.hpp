// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/window/body_terms.hpp"
#include "dynamic_icp/method/window/doppler_cells.hpp"
#include "dynamic_icp/method/window/doppler_error_field.hpp"
#include "dynamic_icp/method/window/doppler_terms.hpp"
#include "dynamic_icp/method/window/field_elimination.hpp"
#include "dynamic_icp/method/window/learned_variance.hpp"
#include "dynamic_icp/method/window/motion_prior.hpp"
#include "dynamic_icp/method/window/plane_terms.hpp"
#include "dynamic_icp/method/window/rest_factor.hpp"
#include "dynamic_icp/method/window/scan_period.hpp"
#include "dynamic_icp/method/window/spline_trajectory.hpp"
#include "dynamic_icp/method/window/window_config.hpp"
#include "dynamic_icp/method/window/window_quadratic.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// What the estimator reads of a scan; all of it must outlive the call.
struct WindowScan {
  double stamp_s = 0.0;
  double begin_s = 0.0;  ///< of its points, after the stamp
  double end_s = 0.0;
  const Scan* whole = nullptr;
  const std::vector<double>* measured = nullptr;  ///< m/s, Doppler of each point of `whole` as measured; null: none
  const std::vector<std::uint8_t>* is_moving = nullptr;  ///< of each point of `whole`
  const Scan* static_points = nullptr;                   ///< thinned
};

/// The motion from the last scan to this one, and how well it is known.
struct WindowMotion {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< left perturbation [omega (rad); rho (m)], target axes
  PlaneQuality planes;
  std::size_t points = 0;
  int iterations = 0;
  bool converged = false;
  bool diverged = false;  ///< a step or the covariance is not finite, or a step beyond the reach of any scan
};

/// Whether a motion is believed, by its transform and what the planes say of it.
using IsBelieved = std::function<bool(const WindowMotion& motion)>;

/// What is known of the angular velocity of the first scan in a map.
struct StartOmega {
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< rad/s, sensor axes
  double sigma_rad_s = 0.0;                         ///< of each axis
};

/// Errors of the Doppler of each point of a scan, m/s.
struct FieldErrors {
  std::vector<double> learned;   ///< as `DopplerErrorField::own_error` has it, with what points of a cell share
  std::vector<double> credible;  ///< the same, by direction and range no larger than those of sensors in use
};

/// One estimator: the trajectory of the sensor in continuous time over the last two scans, the error field of its
/// Doppler and the error of the map, from Doppler and planes together. See docs/derivations/window.md.
///
/// With z = [theta; map error; stamp errors; coefficients; vibration] a scan minimises
///   sum_cells rho (s + u . v(t) - Phi theta)^2 / sigma^2  +  sum_points rho (plane residual)^2 / sigma^2
///   + sum_knots (jerk^2 / q + vibration drive^2 / r)  +  theta^T (tau^2 K)^-1 theta  +  past scans
/// by Gauss and Newton; then it joins the past.
class WindowEstimator {
 public:
  explicit WindowEstimator(const WindowConfig& config);

  /// Before anything else of a scan: its points that are averaged together. It must stay the same until the next one.
  void sort(const Scan& whole, const Workers& workers);

  /// Before the first scan: what is known of the sensor. Throws UsageError when the parts do not fit each other.
  void set_calibration(const SensorCalibration& calibration);

  /// What was learned of the sensor; nothing before the first scan and where nothing is learned.
  [[nodiscard]] std::optional<SensorCalibration> calibration() const;

  /// Whether a calibration was given.
  [[nodiscard]] bool is_calibrated() const { return is_calibrated_; }

  /// The first scan in a map; nothing of the past is kept but the error field. Velocities in sensor axes at the stamp.
  /// Throws UsageError when the calibration is that of another sensor.
  void begin(const WindowScan& scan, const Eigen::Isometry3d& T_map_sensor, const Eigen::Vector3d& velocity,
             const StartOmega& start, const Workers& workers);

  /// The next scan. `start` is its pose where it is known better than by going on evenly (the second scan in a map).
  /// The second scan shows how the first one turned: `map` is laid anew then. A motion that has diverged or is not
  /// believed teaches nothing of the sensor, and `begin` must follow.
  WindowMotion update(const WindowScan& scan, const Scan& first_points, mapping::PlaneMap& map,
                      const std::optional<Eigen::Isometry3d>& start, const IsBelieved& is_believed,
                      const Workers& workers);

  /// Adds the static points of the scan at hand to a map.
  std::vector<Eigen::Vector3d> add_to_map(const WindowScan& scan, mapping::PlaneMap& map, const Workers& workers);

  [[nodiscard]] const SplineTrajectory& trajectory() const { return trajectory_; }
  [[nodiscard]] int scans() const { return scans_; }
  /// When the scan at hand was taken: its stamp and the error of that, s.
  [[nodiscard]] double stamp_s() const { return stamp_s_ + stamp_errors_[1]; }

  /// How the sensor moved at the stamp of the scan at hand.
  [[nodiscard]] const motion::Twist& twist() const { return twist_; }

  /// Standard deviation of the Doppler of single points, the median over ranges, m/s; nothing before the first scan.
  [[nodiscard]] std::optional<double> point_noise() const;

  /// Errors of the Doppler of the scan that was sorted; points of a cell count as seen in one direction.
  void field_errors(const Scan& scan, const Workers& workers, FieldErrors& errors) const;

  /// The Doppler of each point of the scan at hand, had it no error, m/s.
  void static_doppler(const Scan& scan, const Workers& workers, std::vector<double>& predicted) const;

  /// Whether traffic hides so much of what stands that bodies that move are to tell of the Doppler.
  [[nodiscard]] bool asks_bodies() const;

  /// The columns of the error of one point of the scan at hand.
  [[nodiscard]] FieldColumns columns_of(const Scan& scan, std::size_t row) const;

  /// After a scan has joined the past: what its bodies say of the error of its Doppler. They are remembered.
  void learn_from(std::vector<SeenBody> bodies, const Workers& workers);

  [[nodiscard]] const std::optional<DopplerErrorField>& field() const { return field_; }
  [[nodiscard]] const Eigen::VectorXd& theta() const { return theta_; }

  /// What is known between two scans.
  void state(StateArchive& archive);

 private:
  /// Of all unknowns but theta.
  struct Problem {
    Eigen::MatrixXd H;  ///< the lower triangle
    Eigen::VectorXd g;
  };

  /// What a scan changes of what is known of the sensor, before it joins the past.
  struct Learned {
    MotionPrior motion;
    LearnedVariance pointing;
    LearnedVariance stamps;
    LearnedVariance periods;
    LearnedVariance scan_errors;
  };

  [[nodiscard]] Learned learned() const;
  void forget_scan(const Learned& before);
  static LearnedVariance::Prior stamp_prior(double sigma_s);
  static LearnedVariance::Prior period_prior(double sigma_s, double counts);
  static LearnedVariance::Prior scan_error_prior(double sigma_mps);
  static LearnedVariance::Prior pointing_prior();
  void take(const WindowScan& scan);
  void linearise_here();
  bool settle_first(const WindowScan& scan, double omega_sigma_rad_s, const Workers& workers);
  void advance(const WindowScan& scan);
  void iterate(const WindowScan& scan, const Scan& first_points, std::size_t first_new, mapping::PlaneMap& map,
               std::optional<PlaneTerms>& planes, WindowMotion& motion, const Workers& workers);
  void average_doppler(const WindowScan& scan, bool is_first_pass, const Workers& workers);
  void renew_doppler(const WindowScan& scan, bool is_first_pass, const Workers& workers);
  [[nodiscard]] bool is_averaged_here() const;
  [[nodiscard]] DopplerState doppler_state() const { return {trajectory_, theta_, scan_error_.value}; }
  void weigh_doppler(const WindowScan& scan, const Workers& workers);
  [[nodiscard]] SampledMotion sampled_motion() const;
  [[nodiscard]] Eigen::Vector2d pointing_variance(const Scan& points) const;
  void compare_with_planes(const Scan& points, bool adapt, const std::vector<Matrix6d>& displacements,
                           PlaneTerms& planes) const;
  double solve(const Problem& rest);
  void factor(const Problem& rest);
  void factor_tail(const Problem& rest);
  void predict(const WindowScan& scan, std::size_t first_new, const Workers& workers);
  void join(const Problem& rest, const Workers& workers);
  void lay_first_again(const Scan& first_points, mapping::PlaneMap& map, const Workers& workers);

  // window_problem.cpp
  void linearise();
  [[nodiscard]] Eigen::VectorXd linear_gradient();
  [[nodiscard]] double scan_error_variance() const;
  [[nodiscard]] Problem terms_of_rest(const PlaneTerms* planes, std::size_t first_new, double stamp_variance) const;
  [[nodiscard]] Problem start_terms(const WindowScan& scan, double omega_sigma_rad_s) const;
  [[nodiscard]] Problem scan_terms(const std::optional<PlaneTerms>& planes, std::size_t first_new) const;
  void add_period(const Layout& at, Problem& problem) const;
  void tie_map_to_first_sweep(Problem& problem) const;
  void take_in_sweep(double share);
  [[nodiscard]] LastSweep last_sweep() const;
  [[nodiscard]] Eigen::MatrixXd displacement_rows(double time_s, const Layout& layout) const;
  [[nodiscard]] Eigen::MatrixXd sweep_rows(double begin_s, double end_s, const Layout& layout) const;

  // window_learning.cpp
  void learn_field();
  void learn_motion(double from_s, double to_s);
  double learn_stamps();
  double learn_scan_errors();
  void learn_period();
  void learn_pointing(const PlaneTerms& planes);
  void learn_roughness(const PlaneQuality& planes);
  void learn_cell_variance(const Workers& workers);
  void walk_field(double distance_m);

  // window_calibration.cpp
  void check_calibration(std::size_t faces) const;

  // window_state.cpp
  void field_state(StateArchive& archive);
  void check_read(const StateArchive& archive) const;

  // window_uses.cpp
  [[nodiscard]] Matrix6d covariance_of(const Eigen::MatrixXd& rows) const;
  [[nodiscard]] std::vector<Matrix6d> displacement_covariances(const std::vector<double>& times) const;
  void motion_between(double source_s, WindowMotion& motion) const;
  void find_twist();
  [[nodiscard]] const Layout& layout() const { return quadratic_->layout(); }
  [[nodiscard]] Layout rest_layout() const { return {0, layout().coefficients, layout().vibrates}; }

  WindowConfig config_;
  SplineTrajectory trajectory_;
  std::optional<WindowQuadratic> quadratic_;
  std::optional<DopplerErrorField> field_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd map_error_ = Eigen::VectorXd::Zero(Layout::kMapError);
  std::vector<Vector6d> coefficients_0_;  ///< where the quadratic was linearised
  std::vector<Vector6d> vibration_0_;
  Eigen::VectorXd theta_0_;
  Eigen::VectorXd map_error_0_;
  Eigen::Vector2d stamp_errors_ = Eigen::Vector2d::Zero();  ///< s, of the last scan and of the one at hand
  Eigen::Vector2d stamp_errors_0_ = Eigen::Vector2d::Zero();
  DopplerCells cells_;
  std::vector<FieldColumns> columns_;            ///< of each cell
  std::vector<double> hidden_azimuths_;          ///< of each sensor
  std::optional<SampledMotion> averaged_along_;  ///< the motion that the cells were averaged around
  std::optional<DopplerTerms> doppler_;
  std::vector<double> predicted_;
  Eigen::MatrixXd linear_H_;  ///< of the past and the Doppler in the head (Layout), where it was last linearised
  FieldElimination elimination_;
  DopplerTerms::ScanError scan_error_;
  RestFactor rest_factor_;  ///< of [map error; stamp errors; coefficients; vibration]
  motion::Twist twist_;
  BodyTerms bodies_;
  Eigen::MatrixXd field_covariance_root_;
  MotionPrior motion_prior_;
  LearnedVariance pointing_variance_;  ///< rad^2, of azimuth and elevation of a whole scan
  LearnedVariance stamp_variance_;     ///< s^2
  KnownValue last_stamp_;              ///< s, as it was known before the scan at hand
  KnownValue this_stamp_;
  ScanPeriod period_;
  std::optional<KnownValue>
      interval_;                     ///< s, how the error of stamps has changed, had scans whole periods between them
  LearnedVariance period_variance_;  ///< s^2, of such a time from a whole number of periods
  LearnedVariance scan_error_variance_;  ///< (m/s)^2, of what all Doppler values of a scan have in common
  double cell_variance_ = 1e-4;          ///< (m/s)^2
  double model_sigma_m_ = 0.003;
  double map_age_ = 0.0;             ///< scans, by which the mean sweep of the map is older than the last one
  MotionInformation shown_motions_;  ///< by planes, so far; about the reference, its axes
  double last_middle_s_ = 0.0;       ///< of the last sweep, while the next is added
  double stamp_s_ = 0.0;
  double begin_s_ = 0.0;
  double end_s_ = 0.0;
  struct {
    double stamp_s = 0.0;
    double begin_s = 0.0;
    double end_s = 0.0;
  } first_;        ///< the first scan in the map
  int scans_ = 0;  ///< in the map
  int scans_ever_ = 0;
  bool is_calibrated_ = false;
};

}  // namespace dynamic_icp::window
