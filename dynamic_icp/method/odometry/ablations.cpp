// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

// The parts of the pipelines that can be switched off.
#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/config.hpp"

namespace dynamic_icp::odometry {
namespace {

/// A part that can be switched off.
template <class PipelineConfig>
struct Part {
  std::string_view name;
  void (*switch_off)(PipelineConfig& config);
};

constexpr Part<PaperConfig> kPaperParts[] = {
    {"none", [](PaperConfig&) {}},
    {"no-vf", [](PaperConfig& config) { config.ego_motion.filter.enabled = false; }},
    {"no-dpp", [](PaperConfig& config) { config.dynamics.predict = false; }},
    {"no-dr", [](PaperConfig& config) { config.registration.doppler_weight = 0.0; }}};

constexpr Part<WindowOdometryConfig> kWindowParts[] = {
    {"none", [](WindowOdometryConfig&) {}},
    {"no-vf", [](WindowOdometryConfig& config) { config.ego_motion.filter.enabled = false; }},
    {"no-dpp", [](WindowOdometryConfig& config) { config.track_objects = false; }},
    {"no-dr", [](WindowOdometryConfig& config) { config.window.use_doppler = false; }},
    {"no-bias", [](WindowOdometryConfig& config) { config.window.learn_field = false; }},
    {"no-planes", [](WindowOdometryConfig& config) { config.window.use_planes = false; }},
    {"no-support", [](WindowOdometryConfig& config) { config.find_support = false; }},
    {"no-vibration", [](WindowOdometryConfig& config) { config.window.learn_vibration = false; }},
    {"no-pointing", [](WindowOdometryConfig& config) { config.window.learn_pointing = false; }},
    {"no-deskew", [](WindowOdometryConfig& config) { config.sweep.deskew = false; }},
    {"no-map", [](WindowOdometryConfig& config) { config.mapping.memory_scans = 0.0; }},
    {"no-search", [](WindowOdometryConfig& config) { config.search_start = false; }}};

// The baselines are compared as a whole.
template <class PipelineConfig>
constexpr Part<PipelineConfig> kNoParts[] = {{"none", [](PipelineConfig&) {}}};

std::span<const Part<PaperConfig>> parts_of(const PaperConfig& /*config*/) { return kPaperParts; }
std::span<const Part<WindowOdometryConfig>> parts_of(const WindowOdometryConfig& /*config*/) { return kWindowParts; }
template <class PipelineConfig>
std::span<const Part<PipelineConfig>> parts_of(const PipelineConfig& /*config*/) {
  return kNoParts<PipelineConfig>;
}

template <class Parts>
bool is_part(const Parts& parts, std::string_view name) {
  return std::ranges::any_of(parts, [&](const auto& part) { return part.name == name; });
}

template <class PipelineConfig>
void switch_off(PipelineConfig& config, std::string_view name) {
  const auto parts = parts_of(config);
  const auto part = std::ranges::find(parts, name, &Part<PipelineConfig>::name);
  if (part != parts.end()) {
    part->switch_off(config);
    return;
  }
  const std::string own = fmt::format("{}", fmt::join(ablation_names(config), ", "));
  if (is_part(kWindowParts, name)) {
    throw UsageError(
        fmt::format("ablation '{}' is about a part that this pipeline does not have; it has: {}", name, own));
  }
  throw UsageError(fmt::format("unknown ablation '{}'; those of this pipeline are: {}", name, own));
}

}  // namespace

void apply_ablation(Config& config, std::string_view name) {
  std::visit([&](auto& pipeline) { switch_off(pipeline, name); }, config);
}

void apply_ablation(PaperConfig& config, std::string_view name) { switch_off(config, name); }

void apply_ablation(WindowOdometryConfig& config, std::string_view name) { switch_off(config, name); }

std::vector<std::string_view> ablation_names(const Config& config) {
  return std::visit(
      [](const auto& pipeline) {
        std::vector<std::string_view> names;
        for (const auto& part : parts_of(pipeline)) {
          names.push_back(part.name);
        }
        return names;
      },
      config);
}

}  // namespace dynamic_icp::odometry
