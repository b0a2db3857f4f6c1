// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "tests/damaged_recordings.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

#include "testing/npz_by_hand.hpp"

namespace dynamic_icp::tests {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

template <class Number>
void append(std::string& bytes, Number value, bool turned = false) {
  std::string own(reinterpret_cast<const char*>(&value), sizeof(value));
  bytes += turned ? std::string(own.rbegin(), own.rend()) : own;
}

/// x, y, z and Doppler of a scan.
std::string numbers_of(const RawScan& scan, Numbers numbers, const std::function<bool(int column)>& wanted,
                       bool by_columns = false) {
  std::string bytes;
  const std::size_t rows = scan.points.size();
  const auto add = [&](std::size_t i, int column) {
    const double value = column < 3 ? scan.points[i][column] : scan.doppler[i];
    if (wanted(column)) {
      append(bytes, numbers == Numbers::kNan ? kNotANumber : static_cast<float>(value),
             numbers == Numbers::kOtherByteOrder);
    }
  };
  for (std::size_t k = 0; k < 4 * rows; ++k) {
    by_columns ? add(k % rows, static_cast<int>(k / rows)) : add(k / 4, static_cast<int>(k % 4));
  }
  return bytes;
}

bool all(int) { return true; }

std::string pcd_header(std::size_t points, const std::string& encoding) {
  std::ostringstream text;
  text << "VERSION 0.7\nFIELDS x y z doppler\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " << points
       << "\nHEIGHT 1\nPOINTS " << points << "\nDATA " << encoding << "\n";
  return text.str();
}

std::string ascii_rows(const RawScan& scan, Numbers numbers) {
  std::ostringstream text;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (numbers == Numbers::kNan) {
      text << "nan nan nan nan\n";
    } else {
      text << scan.points[i].transpose() << ' ' << scan.doppler[i] << '\n';
    }
  }
  return text.str();
}

/// LZF without any compression: runs of literals.
std::string packed(const std::string& bytes) {
  std::string literals;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    literals += static_cast<char>(run.size() - 1);
    literals += run;
  }
  std::string block;
  append(block, static_cast<std::uint32_t>(literals.size()));
  append(block, static_cast<std::uint32_t>(bytes.size()));
  return block + literals;
}

std::string npy(std::vector<std::size_t> shape, const std::string& bytes) {
  formats::NpyArray array{formats::NpyType::kFloat32, std::move(shape), bytes, ""};
  return formats::npy_bytes(array);
}

/// Other numbers of the same scan.
void write_numbers(const Layout& layout, const fs::path& file, const RawScan& scan, Numbers numbers) {
  if (layout.record_bytes == 0) {
    write_file(file, file_of(layout.name, scan, numbers));
    return;
  }
  std::string bytes = read_file(file);
  for (std::size_t at = 0; at + layout.record_bytes <= bytes.size(); at += layout.record_bytes) {
    for (std::size_t k = 0; k < 12; k += 4) {
      if (numbers == Numbers::kNan) {
        std::memcpy(bytes.data() + at + k, &kNotANumber, 4);
      } else {
        std::swap(bytes[at + k], bytes[at + k + 3]);
        std::swap(bytes[at + k + 1], bytes[at + k + 2]);
      }
    }
  }
  write_file(file, bytes);
}

/// The lines of a file, changed.
void change_lines(const fs::path& file, const std::function<void(std::vector<std::string>&)>& change) {
  std::istringstream text(read_file(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    lines.push_back(line);
  }
  change(lines);
  std::string content;
  for (const std::string& line : lines) {
    content += line + "\n";
  }
  write_file(file, content);
}

/// An NPY array of as many rows that says it has many more; as long as it was.
std::string with_huge_shape(const std::string& bytes, const std::string& rows) {
  const std::string was = "(" + rows + ", 3), }" + std::string(11, ' ');
  std::string is = "(99999999999999, 3), }";
  is.resize(was.size(), ' ');
  return replaced(bytes, was, is);
}

/// The same of the first array of an archive, with its checksum.
std::string with_huge_array(std::string archive, const std::string& rows) {
  const std::string content = formats::stored_members(archive).front().second;
  std::string was;
  std::string is;
  append(was, formats::crc32_of(content));
  append(is, formats::crc32_of(with_huge_shape(content, rows)));
  archive = replaced(std::move(archive), was, is);  // before the content
  archive = replaced(std::move(archive), was, is);  // in the directory
  return with_huge_shape(archive, rows);
}

}  // namespace

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> all = {{"dicp", "point_clouds", ".bin", 16, "ref_poses.txt", "calibration.json"},
                                          {"hercules", "LiDAR/Aeva", ".bin", 29, "PR_GT/Aeva_gt.txt", "Calibration"},
                                          {"helipr", "LiDAR/Aeva", ".bin", 25, "LiDAR_GT/Aeva_gt.txt", ""},
                                          {"boreas", "aeva", ".bin", 40, "applanix/aeva_poses.csv", "calib"},
                                          {"aevascenes", "pointcloud_raw", ".npz", 0, "", "sequence.json"},
                                          {"npz", ".", ".npz", 0, "ref_poses.txt", ""},
                                          {"npy-pair", ".", ".npy", 0, "ref_poses.txt", ""},
                                          {"pcd-ascii", ".", ".pcd", 0, "ref_poses.txt", ""},
                                          {"pcd-binary", ".", ".pcd", 0, "ref_poses.txt", ""},
                                          {"pcd-compressed", ".", ".pcd", 0, "ref_poses.txt", ""},
                                          {"ply", ".", ".ply", 0, "ref_poses.txt", ""},
                                          {"bin", ".", ".bin", 16, "", ""}};
  return all;
}

const Layout& layout_of(const std::string& name) {
  for (const Layout& layout : layouts()) {
    if (layout.name == name) {
      return layout;
    }
  }
  throw std::out_of_range(name);
}

std::vector<fs::path> scan_files(const Layout& layout, const fs::path& recording) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(recording / layout.scans)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(layout.extension) && !name.ends_with("_dop.npy")) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string format_of(const Layout& layout) {
  return layout.name.starts_with("pcd") ? "pcd" : layout.name == "npy-pair" ? "npz" : layout.name;
}

std::string file_of(const std::string& layout, const RawScan& scan, Numbers numbers) {
  const std::size_t points = scan.points.size();
  const auto is_coordinate = [](int column) { return column < 3; };
  const auto is_doppler = [](int column) { return column == 3; };
  const std::string xyz = numbers_of(scan, numbers, is_coordinate);
  const std::string doppler = numbers_of(scan, numbers, is_doppler);
  if (layout == "bin") {
    return numbers_of(scan, numbers, all);
  }
  if (layout == "npy-pair") {
    return npy({points, 3}, xyz);
  }
  if (layout == "npz") {
    return formats::npz_bytes(
        std::vector<formats::NpzMember>{{"points", {formats::NpyType::kFloat32, {points, 3}, xyz, ""}},
                                        {"doppler", {formats::NpyType::kFloat32, {points}, doppler, ""}}});
  }
  if (layout == "aevascenes") {
    return formats::npz_bytes(
        std::vector<formats::NpzMember>{{"xyz", {formats::NpyType::kFloat32, {points, 3}, xyz, ""}},
                                        {"velocity", {formats::NpyType::kFloat32, {points, 1}, doppler, ""}}});
  }
  if (layout == "pcd-ascii") {
    return pcd_header(points, "ascii") + ascii_rows(scan, numbers);
  }
  if (layout == "pcd-binary") {
    return pcd_header(points, "binary") + numbers_of(scan, numbers, all);
  }
  if (layout == "pcd-compressed") {
    return pcd_header(points, "binary_compressed") + packed(numbers_of(scan, numbers, all, true));
  }
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float doppler\nend_header\n" +
         numbers_of(scan, numbers, all);
}

std::string doppler_file_of(const RawScan& scan) {
  return npy({scan.points.size()}, numbers_of(scan, Numbers::kAsMeasured, [](int column) { return column == 3; }));
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

const std::vector<std::pair<std::string, Damage>>& damages() {
  static const std::vector<std::pair<std::string, Damage>> all_damages = {
      {"truncated",
       [](const Layout&, const fs::path&, const fs::path& file, const RawScan&) {
         const std::string bytes = read_file(file);
         write_file(file, bytes.substr(0, bytes.size() * 6 / 10 / 4 * 4 + 3));
         return true;
       }},
      {"empty file",
       [](const Layout&, const fs::path&, const fs::path& file, const RawScan&) {
         write_file(file, "");
         return true;
       }},
      {"wrong size",
       [](const Layout&, const fs::path&, const fs::path& file, const RawScan&) {
         write_file(file, read_file(file) + "junk!");
         return true;
       }},
      {"other byte order",
       [](const Layout& layout, const fs::path&, const fs::path& file, const RawScan& scan) {
         if (layout.name == "pcd-ascii") {
           return false;
         }
         write_numbers(layout, file, scan, Numbers::kOtherByteOrder);
         return true;
       }},
      {"NaN",
       [](const Layout& layout, const fs::path&, const fs::path& file, const RawScan& scan) {
         write_numbers(layout, file, scan, Numbers::kNan);
         return true;
       }},
      {"duplicate stamps",
       [](const Layout& layout, const fs::path& recording, const fs::path& file, const RawScan&) {
         if (layout.name == "dicp") {
           change_lines(recording / layout.truth, [](auto& lines) {
             lines[lines.size() - 1] = replaced(lines[lines.size() - 1], lines[lines.size() - 1].substr(0, 12),
                                                lines[lines.size() - 2].substr(0, 12));
           });
         } else if (layout.name == "aevascenes") {
           write_file(recording / "sequence.json",
                      replaced(read_file(recording / "sequence.json"), "\"timestamp_ns\": 1735689600200000000",
                               "\"timestamp_ns\": 1735689600100000000"));
         } else {
           // The same number written another way.
           const std::string copy = "copy_" + file.filename().string();
           fs::copy_file(file, file.parent_path() / copy);
           if (layout.name == "npy-pair") {
             fs::copy_file(file.parent_path() / (file.stem().string() + "_dop.npy"),
                           file.parent_path() / ("copy_" + file.stem().string() + "_dop.npy"));
           }
         }
         return true;
       }},
      {"unsorted stamps",
       [](const Layout& layout, const fs::path& recording, const fs::path&, const RawScan&) {
         if (layout.name == "aevascenes") {
           std::string text = read_file(recording / "sequence.json");
           text = replaced(text, "\"timestamp_ns\": 1735689600200000000", "\"timestamp_ns\": 1735689599200000000");
           write_file(recording / "sequence.json", text);
           return true;
         }
         if (layout.truth.empty()) {
           return false;
         }
         change_lines(recording / layout.truth,
                      [](auto& lines) { std::swap(lines[lines.size() - 1], lines[lines.size() - 2]); });
         return true;
       }},
      {"missing truth",
       [](const Layout& layout, const fs::path& recording, const fs::path&, const RawScan&) {
         if (layout.name == "aevascenes") {
           change_lines(recording / "sequence.json", [](auto& lines) {
             for (std::string& line : lines) {
               line = replaced(line, "\"ego_pose\"", "\"no_pose\"");
             }
           });
           return true;
         }
         return !layout.truth.empty() && fs::remove(recording / layout.truth);
       }},
      {"missing metadata",
       [](const Layout& layout, const fs::path& recording, const fs::path& file, const RawScan&) {
         if (layout.name.starts_with("pcd")) {
           const std::string bytes = read_file(file);
           write_file(file, bytes.substr(bytes.find("DATA")));
           return true;
         }
         if (layout.name == "ply") {
           write_file(file, replaced(read_file(file), "property float doppler\n", ""));
           return true;
         }
         if (layout.name == "npy-pair") {
           return fs::remove(file.parent_path() / (file.stem().string() + "_dop.npy"));
         }
         return !layout.metadata.empty() && fs::exists(recording / layout.metadata) &&
                fs::remove_all(recording / layout.metadata) > 0;
       }},
      {"spoiled metadata",
       [](const Layout& layout, const fs::path& recording, const fs::path&, const RawScan&) {
         const std::map<std::string, std::string> files = {{"dicp", "calibration.json"},
                                                           {"hercules", "Calibration/IMU_LiDAR.txt"},
                                                           {"boreas", "calib/T_applanix_lidar.txt"},
                                                           {"aevascenes", "sequence.json"}};
         const auto found = files.find(layout.name);
         if (found == files.end()) {
           return false;
         }
         write_file(recording / found->second, "{\"T_V_to_S\": Tr_lidar_to_imu: 1 2 three");
         if (layout.name == "boreas") {
           write_file(recording / "calib" / "T_aeva_lidar.txt", "1 0 0 0 0 1 0 0 0 0 1 0");
         }
         return true;
       }},
      {"spoiled truth",
       [](const Layout& layout, const fs::path& recording, const fs::path&, const RawScan&) {
         if (layout.truth.empty()) {
           return false;
         }
         change_lines(recording / layout.truth, [](auto& lines) {
           lines.back() = replaced(lines.back(), lines.back().substr(lines.back().size() - 4), "nan!");
         });
         return true;
       }},
      {"huge count", [](const Layout& layout, const fs::path&, const fs::path& file, const RawScan& scan) {
         const std::string count = std::to_string(scan.points.size());
         std::string bytes = read_file(file);
         if (layout.name.starts_with("pcd")) {
           bytes = replaced(replaced(bytes, "WIDTH " + count, "WIDTH 99999999999999"), "POINTS " + count,
                            "POINTS 99999999999999");
           if (layout.name == "pcd-compressed") {
             const std::size_t at = bytes.find("binary_compressed\n") + 18;
             bytes.replace(at, 8, std::string(8, '\xFF'));
           }
         } else if (layout.name == "ply") {
           bytes = replaced(bytes, "vertex " + count, "vertex 99999999999999");
         } else if (layout.name == "npy-pair") {
           bytes = with_huge_shape(bytes, count);
         } else if (layout.extension == ".npz") {
           bytes = with_huge_array(bytes, count);
         } else {
           return false;
         }
         write_file(file, bytes);
         return true;
       }}};
  return all_damages;
}

}  // namespace dynamic_icp::tests
