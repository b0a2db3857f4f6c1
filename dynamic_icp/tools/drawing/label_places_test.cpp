// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/label_places.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::drawing {
namespace {

constexpr double kSize = 12.0;

/// The box of a text that starts at `at`, from its baseline up.
PixelBox box_of(Pixel at, std::string_view text) { return {at.x, at.y - kSize, estimated_width(text, kSize), kSize}; }

bool overlap(const PixelBox& a, const PixelBox& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

TEST(LabelPlaces, StayInsideOfTheArea) {
  const PixelBox area{0.0, 0.0, 400.0, 300.0};
  for (const Pixel corner : {Pixel{0.0, 0.0}, Pixel{390.0, 0.0}, Pixel{0.0, 290.0}, Pixel{390.0, 290.0}}) {
    LabelPlaces places(area);
    const PixelBox label = box_of(places.place({corner.x, corner.y, 10.0, 10.0}, "some label", kSize), "some label");
    EXPECT_GE(label.left, 0.0);
    EXPECT_LE(label.right(), 400.0);
    EXPECT_GE(label.top, 0.0);
    EXPECT_LE(label.bottom(), 300.0);
  }
}

TEST(LabelPlaces, KeepAwayFromEachOtherAndFromWhatIsBlocked) {
  LabelPlaces places({0.0, 0.0, 400.0, 300.0});
  const PixelBox thing{180.0, 140.0, 20.0, 20.0};
  places.block(thing);
  places.block_line({0.0, 150.0}, {400.0, 150.0});
  std::vector<PixelBox> labels;
  for (const char* text : {"first", "second", "third"}) {
    labels.push_back(box_of(places.place(thing, text, kSize), text));
  }
  for (std::size_t a = 0; a < labels.size(); ++a) {
    EXPECT_FALSE(overlap(labels[a], thing));
    EXPECT_FALSE(overlap(labels[a], {0.0, 149.0, 400.0, 2.0})) << "the line is not crossed";
    for (std::size_t b = a + 1; b < labels.size(); ++b) {
      EXPECT_FALSE(overlap(labels[a], labels[b]));
    }
  }
}

TEST(LabelPlaces, AtTheEdgeALongLabelStaysAboveItsOwnThing) {
  LabelPlaces places({0.0, 0.0, 400.0, 300.0});
  const PixelBox thing{5.0, 150.0, 12.0, 12.0};
  places.block_line({11.0, 156.0}, {90.0, 156.0});
  places.block({110.0, 125.0, 30.0, 18.0});
  const PixelBox label = box_of(places.place(thing, "sensor and its speed", kSize), "sensor and its speed");
  EXPECT_LT(label.left, thing.right());
  EXPECT_TRUE(label.bottom() < thing.top || label.top > thing.bottom());
}

TEST(LabelPlaces, LinesWithoutEndAreIgnored) {
  LabelPlaces places({0.0, 0.0, 400.0, 300.0});
  places.block_line({0.0, 0.0}, {std::numeric_limits<double>::quiet_NaN(), 0.0});
  places.block_line({0.0, 0.0}, {std::numeric_limits<double>::infinity(), 0.0});
  places.block_line({0.0, 0.0}, {1e300, 0.0});
  EXPECT_NO_THROW(places.place({10.0, 10.0, 5.0, 5.0}, "label", kSize));
}

}  // namespace
}  // namespace dynamic_icp::drawing
