// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "dynamic_icp/tools/drawing/svg.hpp"

// For tests of pictures: where their texts are.
namespace dynamic_icp::drawing {

/// A text of a picture, and about where it is: letters are 0.6 of their size wide.
struct PlacedText {
  std::string text;
  double size = 0.0;  ///< px
  PixelBox box = {};
};

/// The value of an attribute of the element that begins at `at`; empty without it.
inline std::string attribute_of(const std::string& svg, std::size_t at, const std::string& name) {
  const std::size_t end = svg.find('>', at);
  const std::size_t found = svg.find(" " + name + "=\"", at);
  if (found > end) {
    return {};
  }
  const std::size_t begin = found + name.size() + 3;
  return svg.substr(begin, svg.find('"', begin) - begin);
}

/// The texts of a picture without nested ones, in their order.
inline std::vector<PlacedText> texts_of(const std::string& svg) {
  std::vector<PlacedText> texts;
  for (std::size_t at = svg.find("<text"); at != std::string::npos; at = svg.find("<text", at + 1)) {
    const std::size_t begin = svg.find('>', at) + 1;
    PlacedText text{.text = svg.substr(begin, svg.find('<', begin) - begin),
                    .size = std::strtod(attribute_of(svg, at, "font-size").c_str(), nullptr)};
    const double x = std::strtod(attribute_of(svg, at, "x").c_str(), nullptr);
    const double y = std::strtod(attribute_of(svg, at, "y").c_str(), nullptr);
    const double width = estimated_width(text.text, text.size);
    const std::string anchor = attribute_of(svg, at, "text-anchor");
    const double before = anchor == "middle" ? 0.5 * width : anchor == "end" ? width : 0.0;
    text.box = {x - before, y - 0.75 * text.size, width, text.size};
    if (!attribute_of(svg, at, "transform").empty()) {  // turned about its place, read from below
      text.box = {x - 0.75 * text.size, y - before, text.size, width};
    }
    texts.push_back(text);
  }
  return texts;
}

}  // namespace dynamic_icp::drawing
