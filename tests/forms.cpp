// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "tests/forms.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "testing/bags_by_hand.hpp"
#include "testing/ros_bytes.hpp"

namespace dynamic_icp::tests::forms {

using formats::NamedArray;

namespace {

std::string text_of(const Rows& rows, const std::string& delimiter, const std::string& header) {
  std::string text = header;
  for (const Row& row : rows) {
    text += fmt::format("{}\n", fmt::join(row, delimiter));
  }
  return text;
}

std::string pcd_of(const Rows& rows, const std::string& fields, std::size_t count) {
  std::string sizes;
  std::string types;
  for (std::size_t k = 0; k < count; ++k) {
    sizes += " 4";
    types += " F";
  }
  return fmt::format("VERSION 0.7\nFIELDS {}\nSIZE{}\nTYPE{}\nWIDTH {}\nHEIGHT 1\nPOINTS {}\nDATA binary\n", fields,
                     sizes, types, rows.size(), rows.size()) +
         bytes_of<float>(rows);
}

}  // namespace

Row xyzd(const RawScan& scan, std::size_t i) {
  const Eigen::Vector3d& p = scan.points[i];
  return {p.x(), p.y(), p.z(), scan.doppler[i]};
}

double intensity(std::size_t i) { return 0.01 * static_cast<double>(i * i % 97); }

Row xyzid(const RawScan& scan, std::size_t i) {
  const Eigen::Vector3d& p = scan.points[i];
  return {p.x(), p.y(), p.z(), intensity(i), scan.doppler[i]};
}

Row vod(const RawScan& scan, std::size_t i) {
  const Eigen::Vector3d& p = scan.points[i];
  return {p.x(), p.y(), p.z(), -10.0 - intensity(i), scan.doppler[i], 0.1 * std::sin(static_cast<double>(i)), 0.0};
}

Row eight(const RawScan& scan, std::size_t i) {
  const Eigen::Vector3d& p = scan.points[i];
  return {p.x(), p.y(), p.z(), 300.0 * intensity(i), 0.5, scan.doppler[i], static_cast<double>(i % 4), 90.0};
}

Rows rows_of(const RawScan& scan, const RowOf& row_of) {
  Rows rows;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    rows.push_back(row_of(scan, i));
  }
  return rows;
}

NamedArray array(const std::string& name, const Rows& rows) {
  std::vector<float> values;
  for (const Row& row : rows) {
    values.insert(values.end(), row.begin(), row.end());
  }
  std::vector<std::size_t> shape = {rows.size()};
  if (rows.front().size() > 1) {
    shape.push_back(rows.front().size());
  }
  return {name, formats::npy_array<float>(shape, values)};
}

Rows part(const Rows& rows, std::size_t begin, std::size_t end) {
  Rows result;
  for (const Row& row : rows) {
    result.emplace_back(row.begin() + static_cast<std::ptrdiff_t>(begin),
                        row.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return result;
}

void write(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  write_file(path, content);
}

fs::path write_scans(const Drive& drive, const fs::path& folder, const NameOf& name_of, const ContentOf& content_of) {
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    write(folder / name_of(i), content_of(drive.scans[i]));
  }
  return folder;
}

Writer counted(const std::string& pattern, const ContentOf& content_of) {
  return [=](const Drive& drive, const fs::path& folder) {
    return write_scans(
        drive, folder, [&](std::size_t i) { return fmt::format(fmt::runtime(pattern), i); }, content_of);
  };
}

ContentOf npz(const std::function<std::vector<NamedArray>(const Rows&)>& members, const RowOf& row_of) {
  return [=](const RawScan& scan) { return formats::npz_bytes(members(rows_of(scan, row_of))); };
}

ContentOf npy(const RowOf& row_of) {
  return [=](const RawScan& scan) { return formats::npy_bytes(array("", rows_of(scan, row_of)).array); };
}

ContentOf text(const RowOf& row_of, const std::string& delimiter, const std::string& header) {
  return [=](const RawScan& scan) { return text_of(rows_of(scan, row_of), delimiter, header); };
}

ContentOf pcd(const std::string& fields) {
  return [=](const RawScan& scan) { return pcd_of(rows_of(scan, xyzd), fields, 4); };
}

Writer single(const std::string& name, const ContentOf& content_of) {
  return [=](const Drive& drive, const fs::path& folder) {
    write(folder / name, content_of(drive.scans.front()));
    return folder / name;
  };
}

Writer foreign(const std::string& name, const std::string& content) {
  return [=](const Drive&, const fs::path& folder) {
    write(folder / name, content);
    return folder / name;
  };
}

std::string bag_of(const Drive& drive, const std::vector<CloudTopic>& topics) {
  std::vector<by_hand::Channel> channels = {{0, "/imu", "sensor_msgs/Imu", "of imu"}};
  std::vector<by_hand::Message> messages;
  for (const CloudTopic& topic : topics) {
    channels.push_back({static_cast<std::uint16_t>(channels.size()), topic.name, "sensor_msgs/PointCloud2", "clouds"});
  }
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + 100'000'000 * static_cast<std::int64_t>(i);
    messages.push_back({0, stamp_ns, std::string(100, '\0')});
    for (std::size_t k = 0; k < topics.size(); ++k) {
      std::vector<std::vector<float>> points;
      for (const Row& row : rows_of(drive.scans[i], topics[k].row_of)) {
        points.emplace_back(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(topics[k].fields.size()));
      }
      messages.push_back({static_cast<std::uint16_t>(k + 1), stamp_ns,
                          ros::float_cloud(stamp_ns, "lidar", topics[k].fields, points).bytes(ros::Wire::kRos1)});
    }
  }
  return by_hand::ros1_bag(channels, messages, {});
}

Writer bag(const std::vector<CloudTopic>& topics) {
  return [=](const Drive& drive, const fs::path& folder) {
    write(folder / "drive.bag", bag_of(drive, topics));
    return folder / "drive.bag";
  };
}

Writer converted(const std::string& format, const std::string& name) {
  return [=](const Drive& drive, const fs::path& folder) {
    const fs::path plain = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive, folder / "plain");
    const Outcome outcome =
        run_program(fmt::format("convert {} --to {} --output {}", plain.string(), format, (folder / name).string()));
    EXPECT_EQ(outcome.status, kDone) << outcome.text;
    return folder / name;
  };
}

Row mirrored(const RawScan& scan, std::size_t i) {
  const Eigen::Vector3d& p = scan.points[i];
  return {p.x(), -p.y(), p.z(), scan.doppler[i]};
}

std::vector<std::string> options_in(const std::string& message) {
  static const std::regex kOption(
      "--(columns|dtype|field|format|period|topic|doppler-scale|doppler-sign|point-scale) ('[^']*'|[^ ,;\n]+(,[^ "
      ",;\n]+)*)");
  const std::string proposal =
      message.substr(0, std::min({message.find("; or state"), message.find("\nor --"), message.find(", or with --")}));
  std::vector<std::string> options;
  for (std::sregex_iterator option(proposal.begin(), proposal.end(), kOption); option != std::sregex_iterator();
       ++option) {
    options.push_back(option->str());
  }
  return options;
}

datasets::InputSettings pasted(const std::string& message) {
  datasets::InputSettings settings;
  for (const std::string& option : options_in(message)) {
    const std::size_t blank = option.find(' ');
    std::string name = option.substr(2, blank - 2);
    std::string value = option.substr(blank + 1);
    if (value.size() >= 2 && value.starts_with('\'') && value.ends_with('\'')) {  // as a shell takes it
      value = value.substr(1, value.size() - 2);
    }
    if (name == "field") {
      name += "." + value.substr(0, value.find('='));
      value = value.substr(value.find('=') + 1);
    } else if (name == "topic") {
      name += ".1";
    }
    datasets::set(settings, name, value);
  }
  return settings;
}

const Drive& OpenDoor::drive() {
  static const Drive made = [] {
    const fs::path folder = fs::temp_directory_path() / fmt::format("open_door-{}", ::getpid());
    const Outcome outcome =
        run_program("simulate city --quiet --frames 6 --set lidar.columns=150 --set lidar.rows=20 --output " +
                    (folder / "drive").string());
    EXPECT_EQ(outcome.status, kDone) << outcome.text;
    Drive result;
    const auto dataset = datasets::open_dataset(folder / "drive");
    for (std::size_t i = 0; i < dataset->size(); ++i) {
      result.scans.push_back(dataset->scan(i));
    }
    result.poses = read_file(folder / "drive" / "ref_poses.txt");
    fs::remove_all(folder);
    return result;
  }();
  return made;
}

void OpenDoor::expect_same(const datasets::Dataset& dataset, std::size_t expected_scans) {
  ASSERT_EQ(dataset.size(), expected_scans);
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    const RawScan scan = dataset.scan(i);
    EXPECT_EQ(scan.points, drive().scans[i].points) << "scan " << i;
    EXPECT_EQ(scan.doppler, drive().scans[i].doppler) << "scan " << i;
    EXPECT_TRUE(i == 0 || dataset.stamp(i) > dataset.stamp(i - 1));
  }
}

}  // namespace dynamic_icp::tests::forms
