// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/align_config.hpp"

#include <algorithm>
#include <iterator>

namespace dynamic_icp::registration {

ConfigFields fields(MatchingConfig& config) {
  return {
      {"max_correspondence_distance_m", &config.max_correspondence_distance_m, 1e-3, 1e3, "m",
       "a point farther than this from its nearest target point has no correspondence"},
      {"max_iterations", &config.max_iterations, 1, 10000, "", "maximum number of Gauss-Newton steps (I_max)"},
      {"tolerance", &config.tolerance, 1e-12, 1.0, "",
       "the alignment has converged when fitness and inlier RMSE (m) both change by less (epsilon)"},
      {"min_correspondences", &config.min_correspondences, 6, 1000000, "", "fewer correspondences are a failure"},
      {"rank_tolerance", &config.rank_tolerance, 0.0, 0.1, "",
       "a direction with less than this share of the best direction's information is degenerate"},
  };
}

ConfigFields fields(AlignConfig& config) {
  ConfigFields all = {
      {"doppler_weight", &config.doppler_weight, 0.0, 0.999, "",
       "share of the Doppler term in the objective (lambda_v); 0 leaves it out"},
      {"tukey_geometry_m", &config.tukey_geometry_m, 1e-6, 1e3, "m",
       "point-to-plane residuals beyond this have no weight (rho_g)"},
      {"tukey_doppler_mps", &config.tukey_doppler_mps, 1e-6, 1e3, "m/s",
       "Doppler residuals beyond this have no weight (rho_v)"},
      {"correspondence_range_scale", &config.correspondence_range_scale, 0.0, 1.0, "m/m",
       "growth of max_correspondence_distance_m with the distance of the point from the sensor"},
  };
  std::ranges::copy(fields(static_cast<MatchingConfig&>(config)), std::back_inserter(all));
  return all;
}

}  // namespace dynamic_icp::registration
