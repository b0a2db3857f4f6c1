// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/svg_to_png.hpp"

#include <cmath>
#include <memory>

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

[[noreturn]] void fail(const char* reason) {
  throw DataError(fmt::format("a picture cannot be drawn as PNG: {}", reason));
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

bool has_png() { return true; }

void require_png() {}

std::string png_of_svg(const std::string& document, double scale) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, Release> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(document.data()), document.size(), &error));
  double width = 0.0;
  double height = 0.0;
  if (handle == nullptr || rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height) == FALSE) {
    fail(error != nullptr ? error->message : "it has no size");
  }
  const std::unique_ptr<cairo_surface_t, Release> surface(cairo_image_surface_create(
      CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(scale * width)), static_cast<int>(std::ceil(scale * height))));
  const std::unique_ptr<cairo_t, Release> context(cairo_create(surface.get()));
  const RsvgRectangle viewport{0.0, 0.0, scale * width, scale * height};
  if (rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error) == FALSE) {
    fail(error->message);
  }
  std::string png;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &png);
  if (status != CAIRO_STATUS_SUCCESS) {
    fail(cairo_status_to_string(status));
  }
  return png;
}

}  // namespace dynamic_icp::apps
