// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/scan_arrays.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::python {

DopplerKind doppler_kind_of(const std::string& word) {
  if (word != "relative" && word != "compensated") {
    throw UsageError(fmt::format("doppler_kind is '{}', expected relative or compensated", word));
  }
  return word == "relative" ? DopplerKind::kRelative : DopplerKind::kCompensated;
}

const char* word_of(DopplerKind kind) { return kind == DopplerKind::kRelative ? "relative" : "compensated"; }

py::array ScanArrays::array(const py::object& scan, const char* name) {
  const py::object member = scan.attr(name);
  if (!py::isinstance<py::array>(member)) {
    throw UsageError(fmt::format("{} is no array", name));
  }
  kept_.push_back(member.cast<py::array>());
  return kept_.back();
}

template <class Number>
std::span<const Number> ScanArrays::channel(const py::object& scan, const char* name) {
  if (scan.attr(name).is_none()) {
    return {};
  }
  const py::array numbers = array(scan, name);
  if (!py::isinstance<py::array_t<Number, py::array::c_style>>(numbers) || numbers.ndim() != 1) {
    throw UsageError(fmt::format("{} must be a contiguous array of type {} and shape (N,)", name,
                                 py::str(py::dtype::of<Number>()).template cast<std::string>()));
  }
  return {static_cast<const Number*>(numbers.data()), static_cast<std::size_t>(numbers.size())};
}

ScanArrays::ScanArrays(const py::object& scan) {
  view_.stamp = Stamp{scan.attr("stamp_ns").cast<std::int64_t>()};
  view_.points = vectors_of(array(scan, "points"), "points");
  view_.doppler = column_of(array(scan, "doppler"), "doppler");
  if (!scan.attr("times").is_none()) {
    view_.times = column_of(array(scan, "times"), "times");
  }
  if (!scan.attr("directions").is_none()) {
    view_.directions = vectors_of(array(scan, "directions"), "directions");
  }
  view_.sensor = channel<std::uint8_t>(scan, "sensor");
  view_.line = channel<std::uint16_t>(scan, "line");
  view_.face = channel<std::uint8_t>(scan, "face");
  view_.intensity = channel<float>(scan, "intensity");
  view_.return_number = channel<std::uint8_t>(scan, "return_number");
  view_.is_unusable = channel<std::uint8_t>(scan, "is_unusable");
  if (!scan.attr("mountings").is_none()) {
    mountings_ = poses_of(array(scan, "mountings"), "mountings");
    view_.mountings = mountings_;
  }
  view_.doppler_kind = doppler_kind_of(scan.attr("doppler_kind").cast<std::string>());
}

py::dict scan_members(RawScan scan) {
  py::dict members;
  members["stamp_ns"] = scan.stamp.ns;
  members["points"] = moved(std::move(scan.points));
  members["doppler"] = moved(std::move(scan.doppler));
  members["times"] = moved_or_none(std::move(scan.times));
  members["directions"] = moved_or_none(std::move(scan.directions));
  members["sensor"] = moved_or_none(std::move(scan.channels.sensor));
  members["line"] = moved_or_none(std::move(scan.channels.line));
  members["face"] = moved_or_none(std::move(scan.channels.face));
  members["intensity"] = moved_or_none(std::move(scan.channels.intensity));
  members["return_number"] = moved_or_none(std::move(scan.channels.return_number));
  members["is_unusable"] = moved_or_none(std::move(scan.is_unusable));
  members["mountings"] = scan.mountings.empty() ? py::object(py::none()) : py::object(copied(scan.mountings));
  members["doppler_kind"] = word_of(scan.doppler_kind);
  members["warning"] = scan.warning;
  return members;
}

}  // namespace dynamic_icp::python
