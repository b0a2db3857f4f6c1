// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/scenes/scene.hpp"

// The builders behind the table of scenes, each in the file of its name.
namespace dynamic_icp::scenes {

Scene build_street(const SceneRequest& request);
Scene build_city(const SceneRequest& request);
Scene build_highway(const SceneRequest& request);
Scene build_tunnel(const SceneRequest& request);
Scene build_curved_walls(const SceneRequest& request);
Scene build_bridge(const SceneRequest& request);
Scene build_jam(const SceneRequest& request);
Scene build_roundabout(const SceneRequest& request);
Scene build_freight(const SceneRequest& request);
Scene build_car_park(const SceneRequest& request);
Scene build_off_road(const SceneRequest& request);

}  // namespace dynamic_icp::scenes
