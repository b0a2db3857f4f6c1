// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/svg_rendering.hpp"

#include <cmath>
#include <memory>

#include <cairo-pdf.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::apps {
namespace {

struct Release {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

[[noreturn]] void fail(const char* reason) { throw DataError(fmt::format("a picture cannot be drawn: {}", reason)); }

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

constexpr double kPointsPerPx = 0.75;
constexpr double kPxPerInch = 96.0;
constexpr const char* kNoDate = "2000-01-01T00:00:00Z";  // the time of day is no part of a picture

/// A document and its size in px.
struct Picture {
  std::unique_ptr<RsvgHandle, Release> handle;
  double width = 0.0;
  double height = 0.0;
};

Picture read_svg(const std::string& document) {
  GError* error = nullptr;
  Picture picture;
  picture.handle.reset(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(document.data()), document.size(), &error));
  if (picture.handle != nullptr) {
    rsvg_handle_set_dpi(picture.handle.get(), kPxPerInch);  // of those who state their size in mm
  }
  if (picture.handle == nullptr ||
      rsvg_handle_get_intrinsic_size_in_pixels(picture.handle.get(), &picture.width, &picture.height) == FALSE) {
    fail(error != nullptr ? error->message : "it has no size");
  }
  return picture;
}

void render(const Picture& picture, double scale, cairo_surface_t* surface) {
  GError* error = nullptr;
  const std::unique_ptr<cairo_t, Release> context(cairo_create(surface));
  const RsvgRectangle viewport{0.0, 0.0, scale * picture.width, scale * picture.height};
  if (rsvg_handle_render_document(picture.handle.get(), context.get(), &viewport, &error) == FALSE) {
    fail(error->message);
  }
}

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    fail(cairo_status_to_string(status));
  }
}

}  // namespace

bool renders_svg() { return true; }

std::string png_of_svg(const std::string& document, double scale) {
  const Picture picture = read_svg(document);
  const std::unique_ptr<cairo_surface_t, Release> surface(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(scale * picture.width)),
                                 static_cast<int>(std::ceil(scale * picture.height))));
  render(picture, scale, surface.get());
  std::string png;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &png));
  return png;
}

std::string pdf_of_svg(const std::string& document) {
  const Picture picture = read_svg(document);
  std::string pdf;
  const std::unique_ptr<cairo_surface_t, Release> surface(
      cairo_pdf_surface_create_for_stream(append, &pdf, kPointsPerPx * picture.width, kPointsPerPx * picture.height));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, kNoDate);
  render(picture, kPointsPerPx, surface.get());
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return pdf;
}

}  // namespace dynamic_icp::apps
