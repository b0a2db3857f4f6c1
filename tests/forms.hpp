// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

#include "tests/program.hpp"

// A simulated drive in the forms in which recordings lie around.
namespace dynamic_icp::tests::forms {

/// The drive of which every form is made.
struct Drive {
  std::vector<RawScan> scans;
  std::string poses;  ///< TUM
};

using Row = std::vector<double>;
using Rows = std::vector<Row>;

/// What a form stores of point i.
using RowOf = std::function<Row(const RawScan& scan, std::size_t i)>;

/// Writes a form into a folder; returns the input.
using Writer = std::function<fs::path(const Drive& drive, const fs::path& folder)>;

/// The content of the file of a scan.
using ContentOf = std::function<std::string(const RawScan& scan)>;

/// The name of the file of scan i.
using NameOf = std::function<std::string(std::size_t i)>;

enum class Door { kOpen, kWithAdvice, kRefused };

/// How the drive lies around.
struct Form {
  const char* name;
  Door door;
  Writer write;
  std::string said = {};  ///< part of the message of what is not open
};

/// All forms that are tried.
const std::vector<Form>& all_forms();

// What is stored of a point: x, y, z, Doppler; with an intensity before the Doppler; as View-of-Delft has it; eight
// numbers; with y on the right.
Row xyzd(const RawScan& scan, std::size_t i);
Row xyzid(const RawScan& scan, std::size_t i);
Row vod(const RawScan& scan, std::size_t i);
Row eight(const RawScan& scan, std::size_t i);
Row mirrored(const RawScan& scan, std::size_t i);

double intensity(std::size_t i);

Rows rows_of(const RawScan& scan, const RowOf& row_of);

/// The columns [begin, end).
Rows part(const Rows& rows, std::size_t begin, std::size_t end);

/// float32 of shape (rows, columns), or (rows) of one column.
formats::NamedArray array(const std::string& name, const Rows& rows);

template <class Number>
std::string bytes_of(const Rows& rows) {
  std::string bytes;
  for (const Row& row : rows) {
    for (const double value : row) {
      formats::append_value(bytes, static_cast<Number>(value));
    }
  }
  return bytes;
}

/// Records of these numbers.
template <class Number>
ContentOf records(const RowOf& row_of) {
  return [=](const RawScan& scan) { return bytes_of<Number>(rows_of(scan, row_of)); };
}

ContentOf npz(const std::function<std::vector<formats::NamedArray>(const Rows&)>& members, const RowOf& row_of = xyzd);
ContentOf npy(const RowOf& row_of);
ContentOf text(const RowOf& row_of, const std::string& delimiter, const std::string& header = "");
ContentOf pcd(const std::string& fields);

/// A file of this content, with the folders above it.
void write(const fs::path& path, const std::string& content);

fs::path write_scans(const Drive& drive, const fs::path& folder, const NameOf& name_of, const ContentOf& content_of);

/// A form of files that count, of these contents.
Writer counted(const std::string& pattern, const ContentOf& content_of);

/// The first scan alone.
Writer single(const std::string& name, const ContentOf& content_of);

/// A file that is no recording.
Writer foreign(const std::string& name, const std::string& content);

/// A topic of clouds, and what it has of each point.
struct CloudTopic {
  std::string name;
  std::vector<std::string> fields;
  RowOf row_of = xyzd;
};

/// A ROS 1 bag of these topics, with a message of another kind beside each cloud.
std::string bag_of(const Drive& drive, const std::vector<CloudTopic>& topics);
Writer bag(const std::vector<CloudTopic>& topics);

/// What the program makes of plain records.
Writer converted(const std::string& format, const std::string& name);

/// The options that a message proposes, as it spells them.
std::vector<std::string> options_in(const std::string& message);

/// The same put in force.
datasets::InputSettings pasted(const std::string& message);

class OpenDoor : public ProgramTest {
 protected:
  static const Drive& drive();

  /// The numbers of the drive, in order.
  static void expect_same(const datasets::Dataset& dataset, std::size_t expected_scans);
};

}  // namespace dynamic_icp::tests::forms
