// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/colour_map.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace dynamic_icp::drawing {
namespace {

/// Linear light of an sRGB colour, components 0 to 1 (IEC 61966-2-1).
Eigen::Vector3d linear_light(Rgb colour) {
  Eigen::Vector3d light(colour.red, colour.green, colour.blue);
  for (double& value : light) {
    value /= 255.0;
    value = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return light;
}

/// CIE L*a*b* (white D65) of linear light.
Eigen::Vector3d lab(const Eigen::Vector3d& light) {
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d white(0.9505, 1.0, 1.089);
  Eigen::Vector3d f = (to_xyz * light).cwiseQuotient(white);
  for (double& value : f) {
    value = value > 0.008856 ? std::cbrt(value) : 7.787 * value + 16.0 / 116.0;
  }
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

/// What a reader without red or without green cones sees, in linear light (Machado et al. 2009, severity 1).
Eigen::Vector3d without_red_cones(const Eigen::Vector3d& light) {
  Eigen::Matrix3d seen;
  seen << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  return (seen * light).cwiseMax(0.0);
}
Eigen::Vector3d without_green_cones(const Eigen::Vector3d& light) {
  Eigen::Matrix3d seen;
  seen << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  return (seen * light).cwiseMax(0.0);
}

double difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (lab(a) - lab(b)).norm(); }

constexpr Ground kGrounds[] = {Ground::kLight, Ground::kDark};

TEST(ColourMap, MiddleIsGreyAndEndsAreBlueAndRed) {
  for (const Ground ground : kGrounds) {
    const Rgb middle = diverging_colour(0.0, ground);
    EXPECT_LT(std::abs(middle.red - middle.blue), 25);
    const Rgb low = diverging_colour(-1.0, ground);
    EXPECT_GT(low.blue, low.red + 60);
    const Rgb high = diverging_colour(1.0, ground);
    EXPECT_GT(high.red, high.blue + 60);
  }
}

TEST(ColourMap, OutsideIsClampedAndNaNIsTheMiddle) {
  for (const Ground ground : kGrounds) {
    EXPECT_EQ(diverging_colour(-7.0, ground), diverging_colour(-1.0, ground));
    EXPECT_EQ(diverging_colour(std::numeric_limits<double>::infinity(), ground), diverging_colour(1.0, ground));
    EXPECT_EQ(diverging_colour(std::numeric_limits<double>::quiet_NaN(), ground), diverging_colour(0.0, ground));
  }
}

TEST(ColourMap, MagnitudeMovesTheLightnessAwayFromTheGround) {
  for (const Ground ground : kGrounds) {
    const double away = ground == Ground::kLight ? -1.0 : 1.0;  // darker on light, lighter on dark
    for (const double sign : {-1.0, 1.0}) {
      for (double value = 0.1; value < 1.01; value += 0.1) {
        const double before = lab(linear_light(diverging_colour(sign * (value - 0.1), ground)))[0];
        const double after = lab(linear_light(diverging_colour(sign * value, ground)))[0];
        EXPECT_GT(away * (after - before), 0.0) << sign * value;
      }
    }
    const double low = lab(linear_light(diverging_colour(-1.0, ground)))[0];
    const double high = lab(linear_light(diverging_colour(1.0, ground)))[0];
    EXPECT_LT(std::abs(low - high), 15.0) << "neither sign may look stronger";
  }
}

TEST(ColourMap, SignsStayApartForColourBlindReaders) {
  for (const Ground ground : kGrounds) {
    for (const double value : {0.5, 0.75, 1.0}) {
      const Eigen::Vector3d low = linear_light(diverging_colour(-value, ground));
      const Eigen::Vector3d high = linear_light(diverging_colour(value, ground));
      EXPECT_GT(difference(without_red_cones(low), without_red_cones(high)), 40.0) << value;
      EXPECT_GT(difference(without_green_cones(low), without_green_cones(high)), 40.0) << value;
    }
  }
}

TEST(ColourMap, FirstCategoriesStayApartForColourBlindReaders) {
  const auto parse = [](const std::string& text) {
    const auto part = [&](std::size_t at) {
      return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return Rgb{part(1), part(3), part(5)};
  };
  for (const Ground ground : kGrounds) {
    const std::vector<std::string>& colours = categorical_colours(ground);
    ASSERT_GE(colours.size(), 6u);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const Eigen::Vector3d first = linear_light(parse(colours[a]));
        const Eigen::Vector3d second = linear_light(parse(colours[b]));
        EXPECT_GT(difference(without_red_cones(first), without_red_cones(second)), 20.0) << colours[a] << colours[b];
        EXPECT_GT(difference(without_green_cones(first), without_green_cones(second)), 20.0)
            << colours[a] << colours[b];
      }
    }
  }
}

TEST(ColourMap, BinsAreSymmetricAboutZero) {
  constexpr std::size_t kCount = 21;
  EXPECT_EQ(diverging_bin(0.0, 10.0, kCount), 10u);
  EXPECT_EQ(diverging_bin(-10.0, 10.0, kCount), 0u);
  EXPECT_EQ(diverging_bin(10.0, 10.0, kCount), 20u);
  EXPECT_EQ(diverging_bin(1e300, 10.0, kCount), 20u);
  for (double value = 0.03; value < 12.0; value += 0.37) {
    EXPECT_EQ(diverging_bin(value, 10.0, kCount) + diverging_bin(-value, 10.0, kCount), 20u) << value;
  }
  EXPECT_EQ(diverging_bin(std::numeric_limits<double>::quiet_NaN(), 10.0, kCount), 10u);
  EXPECT_EQ(diverging_bin(0.0, 0.0, kCount), 10u);
  EXPECT_EQ(diverging_bins(kCount, Ground::kLight)[10], css(diverging_colour(0.0, Ground::kLight)));
}

TEST(ColourMap, WritesCss) {
  EXPECT_EQ(css({0, 0, 0}), "#000000");
  EXPECT_EQ(css({255, 16, 1}), "#ff1001");
}

TEST(SequentialColour, GetsLighterAllTheWay) {
  const auto lightness = [](Rgb c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(lightness(sequential_colour(0.01 * i)), lightness(sequential_colour(0.01 * (i + 1))));
  }
  EXPECT_EQ(sequential_colour(-3.0), sequential_colour(0.0));
  EXPECT_EQ(sequential_colour(7.0), sequential_colour(1.0));
}

TEST(Rgb, ReadsWhatCssWrites) {
  EXPECT_EQ(rgb(css({1, 128, 255})), (Rgb{1, 128, 255}));
  EXPECT_EQ(rgb("var(--ink)"), Rgb{});
}

}  // namespace
}  // namespace dynamic_icp::drawing
