// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"
#include "dynamic_icp/recording/diagnosis/evidence.hpp"

// One function a question, each in the file of its name.
namespace dynamic_icp::diagnosis {

/// Positive away from the sensor? The way by the Doppler against the way by the reference.
Finding doppler_sign(const Evidence& evidence);

/// Relative or compensated? A static scene that seems to move shows the sensor's own motion; one that is static
/// while the reference moves shows that it was taken out.
Finding doppler_kind(const Evidence& evidence);

/// What the Doppler of the static scene has in common beside the velocity.
Finding doppler_bias(const Evidence& evidence);

/// m/s? Sizes no vehicle has, and a speed that is the reference's times the factor between two usual units.
Finding doppler_units(const Evidence& evidence);

/// m? Distances no LiDAR measures.
Finding point_units(const Evidence& evidence);

/// x, y, z, Doppler? The Doppler is what a velocity explains; z is the direction in which a LiDAR sees least.
Finding columns(const Evidence& evidence);

/// How the sensor is turned against the way it moves, and against the ground truth.
Finding mounting(const Evidence& evidence);

/// Where the sensors of a rig sit: static points must show one motion to all of them.
Finding rig_mountings(const Evidence& evidence);

/// Times of points: there, and within a scan?
Finding point_times(const Evidence& evidence);

/// Do speed by the Doppler and speed by the reference agree? If not, and no unit explains it, the stamps are wrong.
Finding time_scale(const Evidence& evidence);

/// Stamps that increase, without gaps.
Finding stamps(const Evidence& evidence);

/// Points that are not finite or at the sensor itself.
Finding unusable_points(const Evidence& evidence);

}  // namespace dynamic_icp::diagnosis
