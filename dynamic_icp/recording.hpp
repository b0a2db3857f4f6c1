// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

/// Recordings as sequences of scans, component `io`: open, diagnose, run, evaluate, convert.
#include "dynamic_icp/recording/conversion/conversion.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/read_ahead.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"
#include "dynamic_icp/recording/evaluation/evaluation.hpp"
#include "dynamic_icp/recording/evaluation/run_accuracy.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"
