// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/tools/drawing/raster.hpp"

namespace dynamic_icp::drawing {

/// A place in a picture: px, x to the right, y down.
struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

/// An area of a picture in px.
struct PixelBox {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

/// How a shape is painted. Colours are anything CSS takes ("#0072b2", "var(--ink)"); empty: not painted.
struct Paint {
  std::string fill = {};
  std::string stroke = {};
  double width = 1.0;      ///< of the stroke, px
  double opacity = 1.0;    ///< 0 to 1
  std::string dash = {};   ///< lengths of dash and gap in px, e.g. "4 3"; empty: a full line
  std::string title = {};  ///< what a browser shows when the mouse rests on the shape
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextStyle {
  std::string colour = {};
  double size = 13.0;  ///< px
  Anchor anchor = Anchor::kStart;
  bool bold = false;
  bool vertical = false;  ///< turned by 90 degrees, read from below
  std::string halo = {};  ///< colour of an outline that keeps the text readable on top of a drawing; empty: none
};

/// Writes one SVG picture. Elements appear in the order of the calls, later ones on top. An element with a coordinate
/// that is not finite is left out; lines break there. Coordinates are rounded to a hundredth of a pixel.
class Svg {
 public:
  /// `description` is read out to those who do not see the picture.
  Svg(double width, double height, std::string_view description);

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  /// The file says how large the picture is on paper: so many px of the drawing a mm. Without this a px is one of the
  /// screen.
  void set_px_per_mm(double px_per_mm) { px_per_mm_ = px_per_mm; }

  void line(Pixel from, Pixel to, const Paint& paint);
  void polyline(std::span<const Pixel> pixels, const Paint& paint);
  void polygon(std::span<const Pixel> pixels, const Paint& paint);
  void rectangle(const PixelBox& box, const Paint& paint, double corner_radius = 0.0);
  void circle(Pixel centre, double radius, const Paint& paint);
  void text(Pixel at, std::string_view text, const TextStyle& style);

  /// Pixels in a box, without smoothing, as part of the file.
  void image(const PixelBox& box, const Raster& raster);

  /// A line with a head at `to`; only the head when the line is shorter than that.
  void arrow(Pixel from, Pixel to, const Paint& paint);

  /// Round dots of one colour as one element, rounded to a tenth of a pixel: about 8 bytes a dot.
  void dots(std::span<const Pixel> centres, double diameter, const std::string& colour);

  /// What is drawn until `end_clip` is seen inside of `box` only.
  void begin_clip(const PixelBox& box);
  void end_clip();

  /// The picture as a file of its own or, without the XML declaration, inside of a page.
  [[nodiscard]] std::string document() const;
  [[nodiscard]] std::string element() const;

 private:
  void shape(std::string_view tag_and_geometry, const Paint& paint);

  double width_;
  double height_;
  std::optional<double> px_per_mm_;
  std::string description_;
  std::string body_;
};

/// About how wide `text` will be in px: the width of the font on the reader's machine is not known here.
double estimated_width(std::string_view text, double size);

}  // namespace dynamic_icp::drawing
