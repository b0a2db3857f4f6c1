// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/svg.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/base64.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"

namespace dynamic_icp::drawing {
namespace {

bool all_finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

bool is_finite(Pixel pixel) { return all_finite({pixel.x, pixel.y}); }

std::string paint_attributes(const Paint& paint) {
  std::string text = fmt::format(" fill=\"{}\"", paint.fill.empty() ? "none" : escape_markup(paint.fill));
  if (!paint.stroke.empty()) {
    text += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", escape_markup(paint.stroke), compact_number(paint.width));
    if (!paint.dash.empty()) {
      text += fmt::format(" stroke-dasharray=\"{}\"", escape_markup(paint.dash));
    }
  }
  if (paint.opacity < 1.0) {
    text += fmt::format(" opacity=\"{}\"", compact_number(paint.opacity));
  }
  return text;
}

std::string pixel_list(std::span<const Pixel> pixels) {
  std::string list;
  for (const Pixel& pixel : pixels) {
    list += fmt::format("{}{},{}", list.empty() ? "" : " ", compact_number(pixel.x), compact_number(pixel.y));
  }
  return list;
}

}  // namespace

Svg::Svg(double width, double height, std::string_view description)
    : width_(width), height_(height), description_(description) {}

void Svg::shape(std::string_view tag_and_geometry, const Paint& paint) {
  const std::string_view tag = tag_and_geometry.substr(0, tag_and_geometry.find(' '));
  body_ += fmt::format("<{}{}", tag_and_geometry, paint_attributes(paint));
  body_ += paint.title.empty() ? "/>\n" : fmt::format("><title>{}</title></{}>\n", escape_markup(paint.title), tag);
}

void Svg::line(Pixel from, Pixel to, const Paint& paint) {
  if (is_finite(from) && is_finite(to)) {
    shape(fmt::format("line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"", compact_number(from.x), compact_number(from.y),
                      compact_number(to.x), compact_number(to.y)),
          paint);
  }
}

void Svg::polyline(std::span<const Pixel> pixels, const Paint& paint) {
  auto begin = pixels.begin();
  while (begin != pixels.end()) {
    const auto end = std::find_if_not(begin, pixels.end(), is_finite);
    if (end - begin == 1) {
      circle(*begin, paint.width, {.fill = paint.stroke, .opacity = paint.opacity});
    } else if (end != begin) {
      shape(fmt::format("polyline stroke-linejoin=\"round\" stroke-linecap=\"round\" points=\"{}\"",
                        pixel_list({begin, end})),
            paint);
    }
    begin = std::find_if(end, pixels.end(), is_finite);
  }
}

void Svg::polygon(std::span<const Pixel> pixels, const Paint& paint) {
  if (!pixels.empty() && std::all_of(pixels.begin(), pixels.end(), is_finite)) {
    shape(fmt::format("polygon stroke-linejoin=\"round\" points=\"{}\"", pixel_list(pixels)), paint);
  }
}

void Svg::rectangle(const PixelBox& box, const Paint& paint, double corner_radius) {
  if (!all_finite({box.left, box.top, box.width, box.height}) || box.width < 0.0 || box.height < 0.0) {
    return;
  }
  std::string geometry = fmt::format("rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", compact_number(box.left),
                                     compact_number(box.top), compact_number(box.width), compact_number(box.height));
  if (corner_radius > 0.0) {
    geometry += fmt::format(" rx=\"{}\"", compact_number(corner_radius));
  }
  shape(geometry, paint);
}

void Svg::image(const PixelBox& box, const Raster& raster) {
  if (!is_finite({box.left, box.top}) || !is_finite({box.width, box.height})) {
    return;
  }
  body_ += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
      compact_number(box.left), compact_number(box.top), compact_number(box.width), compact_number(box.height),
      formats::base64(png(raster)));
}

void Svg::circle(Pixel centre, double radius, const Paint& paint) {
  if (is_finite(centre) && std::isfinite(radius) && radius >= 0.0) {
    shape(fmt::format("circle cx=\"{}\" cy=\"{}\" r=\"{}\"", compact_number(centre.x), compact_number(centre.y),
                      compact_number(radius)),
          paint);
  }
}

void Svg::text(Pixel at, std::string_view text, const TextStyle& style) {
  if (!is_finite(at) || text.empty()) {
    return;
  }
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\" font-size=\"{}\"", compact_number(at.x),
                       compact_number(at.y), escape_markup(style.colour), compact_number(style.size));
  if (style.anchor != Anchor::kStart) {
    body_ += fmt::format(" text-anchor=\"{}\"", kAnchors[static_cast<int>(style.anchor)]);
  }
  if (style.bold) {
    body_ += " font-weight=\"600\"";
  }
  if (style.vertical) {
    body_ += fmt::format(" transform=\"rotate(-90 {} {})\"", compact_number(at.x), compact_number(at.y));
  }
  if (!style.halo.empty()) {
    body_ += fmt::format(" stroke=\"{}\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                         escape_markup(style.halo));
  }
  body_ += fmt::format(">{}</text>\n", escape_markup(text));
}

void Svg::arrow(Pixel from, Pixel to, const Paint& paint) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!std::isfinite(length) || length < 1.0) {
    return;  // no direction to point to
  }
  const double ux = (to.x - from.x) / length;
  const double uy = (to.y - from.y) / length;
  const double head = 3.0 + 2.5 * paint.width;
  const double wing = 0.45 * head;
  const Pixel neck{to.x - head * ux, to.y - head * uy};
  if (length > head) {
    line(from, neck, paint);
  }
  const Pixel tip[] = {to, {neck.x - wing * uy, neck.y + wing * ux}, {neck.x + wing * uy, neck.y - wing * ux}};
  polygon(tip, {.fill = paint.stroke, .opacity = paint.opacity});
}

void Svg::dots(std::span<const Pixel> centres, double diameter, const std::string& colour) {
  // Zero-length lines with round caps, in relative moves of tenths of a pixel: the fewest bytes SVG offers a dot.
  constexpr double kFarAway = 1e6;  // px; beyond any picture, and still exact as an integer
  std::string moves;
  long x = 0;
  long y = 0;
  for (const Pixel& centre : centres) {
    if (!(std::abs(centre.x) < kFarAway && std::abs(centre.y) < kFarAway)) {
      continue;
    }
    const long next_x = std::lround(10.0 * centre.x);
    const long next_y = std::lround(10.0 * centre.y);
    moves += fmt::format("m{}{}{}h0", next_x - x, next_y < y ? "" : " ", next_y - y);
    x = next_x;
    y = next_y;
  }
  if (!moves.empty()) {
    body_ += fmt::format(
        "<path transform=\"scale(.1)\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" "
        "d=\"{}\"/>\n",
        escape_markup(colour), compact_number(10.0 * diameter), moves);
  }
}

void Svg::begin_clip(const PixelBox& box) {
  // A nested picture clips without the identifiers that a clip path needs, which would clash within one page.
  const std::string geometry = fmt::format("{} {} {} {}", compact_number(box.left), compact_number(box.top),
                                           compact_number(box.width), compact_number(box.height));
  body_ += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"{}\" overflow=\"hidden\">\n",
                       compact_number(box.left), compact_number(box.top), compact_number(box.width),
                       compact_number(box.height), geometry);
}

void Svg::end_clip() { body_ += "</svg>\n"; }

std::string Svg::element() const {
  const auto size_of = [&](double px) {
    return px_per_mm_ ? compact_number(px / *px_per_mm_) + "mm" : compact_number(px);
  };
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{4}\" height=\"{5}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "aria-label=\"{2}\" font-family=\"system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif\">\n"
      "{3}</svg>\n",
      compact_number(width_), compact_number(height_), escape_markup(description_), body_, size_of(width_),
      size_of(height_));
}

std::string Svg::document() const { return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + element(); }

double estimated_width(std::string_view text, double size) {
  const auto characters =
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; });
  constexpr double kMeanWidth = 0.6;  // of the font size, for sans-serif faces
  return kMeanWidth * size * static_cast<double>(characters);
}

}  // namespace dynamic_icp::drawing
