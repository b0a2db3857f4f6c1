// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The forms in which recordings lie around: each made of the same simulated drive, and read with the same numbers, or
// refused by a sentence whose options, pasted back, have it read with the same numbers.
#include <cmath>
#include <functional>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

#include "testing/bags_by_hand.hpp"
#include "testing/ros_bytes.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using datasets::InputSettings;
using formats::NamedArray;

/// The drive, and where a form of it is to be written.
struct Drive {
  std::vector<RawScan> scans;
  std::string poses;  ///< TUM
};

enum class Door { kOpen, kWithAdvice, kRefused };

/// How the drive lies around.
struct Form {
  const char* name;
  Door door;
  std::function<fs::path(const Drive& drive, const fs::path& folder)> write;  ///< returns the input
  std::string said = {};  ///< part of the message of what is not open
};

using Row = std::vector<double>;
using Rows = std::vector<Row>;

/// What a form stores of point i.
using RowOf = std::function<Row(const RawScan& scan, std::size_t i)>;

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

std::string text_of(const Rows& rows, const std::string& delimiter, const std::string& header = "") {
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

void write(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  write_file(path, content);
}

/// Writes a file a scan.
using ContentOf = std::function<std::string(const RawScan& scan)>;
using NameOf = std::function<std::string(std::size_t i)>;

fs::path write_scans(const Drive& drive, const fs::path& folder, const NameOf& name_of, const ContentOf& content_of) {
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    write(folder / name_of(i), content_of(drive.scans[i]));
  }
  return folder;
}

/// A form of files that count, of these contents.
std::function<fs::path(const Drive&, const fs::path&)> counted(const std::string& pattern,
                                                               const ContentOf& content_of) {
  return [=](const Drive& drive, const fs::path& folder) {
    return write_scans(
        drive, folder, [&](std::size_t i) { return fmt::format(fmt::runtime(pattern), i); }, content_of);
  };
}

template <class Number>
ContentOf records(const RowOf& row_of) {
  return [=](const RawScan& scan) { return bytes_of<Number>(rows_of(scan, row_of)); };
}

ContentOf npz(const std::function<std::vector<NamedArray>(const Rows&)>& members, const RowOf& row_of = xyzd) {
  return [=](const RawScan& scan) { return formats::npz_bytes(members(rows_of(scan, row_of))); };
}

ContentOf npy(const RowOf& row_of) {
  return [=](const RawScan& scan) { return formats::npy_bytes(array("", rows_of(scan, row_of)).array); };
}

ContentOf text(const RowOf& row_of, const std::string& delimiter, const std::string& header = "") {
  return [=](const RawScan& scan) { return text_of(rows_of(scan, row_of), delimiter, header); };
}

ContentOf pcd(const std::string& fields) {
  return [=](const RawScan& scan) { return pcd_of(rows_of(scan, xyzd), fields, 4); };
}

/// The first scan alone.
std::function<fs::path(const Drive&, const fs::path&)> single(const std::string& name, const ContentOf& content_of) {
  return [=](const Drive& drive, const fs::path& folder) {
    write(folder / name, content_of(drive.scans.front()));
    return folder / name;
  };
}

std::function<fs::path(const Drive&, const fs::path&)> foreign(const std::string& name, const std::string& content) {
  return [=](const Drive&, const fs::path& folder) {
    write(folder / name, content);
    return folder / name;
  };
}

/// A topic of clouds, and what it has of each point.
struct CloudTopic {
  std::string name;
  std::vector<std::string> fields;
  RowOf row_of = xyzd;
};

/// A ROS 1 bag of these topics, with a message of another kind beside each cloud.
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

std::function<fs::path(const Drive&, const fs::path&)> bag(const std::vector<CloudTopic>& topics) {
  return [=](const Drive& drive, const fs::path& folder) {
    write(folder / "drive.bag", bag_of(drive, topics));
    return folder / "drive.bag";
  };
}

/// What the program makes of plain records.
std::function<fs::path(const Drive&, const fs::path&)> converted(const std::string& format, const std::string& name) {
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

const std::vector<Form>& forms() {
  const std::string plain = "x y z doppler";
  const auto nanoseconds = [](std::size_t i) {
    return fmt::format("{}.{:09d}", 1700000000 + i / 2, 500'000'000 * (i % 2));
  };
  static const std::vector<Form> all = {
      {"records of x, y, z, Doppler", Door::kOpen, counted("point_clouds/{:05d}.bin", records<float>(xyzd))},
      {"the same in a folder of their own", Door::kOpen, counted("{:06d}.bin", records<float>(xyzd))},
      {"PCD named by pcl_ros", Door::kOpen,
       [=](const Drive& drive, const fs::path& folder) {
         return write_scans(
             drive, folder, [&](std::size_t i) { return nanoseconds(i) + ".pcd"; }, pcd(plain));
       }},
      {"records named by seconds and nanoseconds beside poses", Door::kOpen,
       [=](const Drive& drive, const fs::path& folder) {
         write(folder / "ref_poses.txt", drive.poses);
         return write_scans(
             drive, folder, [&](std::size_t i) { return "point_clouds/" + nanoseconds(i) + ".bin"; },
             records<float>(xyzd));
       }},
      {"PCD named by seconds and milliseconds", Door::kOpen, counted("17000000{:02d}.100.pcd", pcd(plain))},
      {"PCD with a number behind the one that counts", Door::kOpen, counted("cloud_{}_run2.pcd", pcd(plain))},
      {"PCD whose names have no number", Door::kOpen,
       [=](const Drive& drive, const fs::path& folder) {
         return write_scans(
             drive, folder, [](std::size_t i) { return std::string(1, static_cast<char>('a' + i)) + ".pcd"; },
             pcd(plain));
       }},
      {"NPZ of one array of four columns", Door::kOpen,
       counted("{}.npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("points", rows)}; }))},
      {"NPZ of numpy.savez(points)", Door::kOpen,
       counted("{}.npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("arr_0", rows)}; }))},
      {"NPZ of numpy.savez(points, doppler)", Door::kOpen,
       counted("{}.npz", npz([](const Rows& rows) {
                 return std::vector<NamedArray>{array("arr_0", part(rows, 0, 3)), array("arr_1", part(rows, 3, 4))};
               }))},
      {"NPZ with radial_speed", Door::kOpen,
       counted(
           "{}.npz", npz([](const Rows& rows) {
             return std::vector<NamedArray>{array("XYZ", part(rows, 0, 3)), array("Radial_Speed", part(rows, 3, 4))};
           }))},
      {"NPY of four columns", Door::kOpen, counted("{}.npy", npy(xyzd))},
      {"CSV with names", Door::kOpen, counted("{}.csv", text(xyzd, ",", "x,y,z,doppler\n"))},
      {"CSV with semicolons, quotes and units", Door::kOpen,
       counted("{}.csv", text(xyzd, ";", "\"X\";\"Y\";\"Z\";\"Velocity [m/s]\"\n"))},
      {"CSV without names", Door::kOpen, counted("{}.csv", text(xyzd, ","))},
      {"CSV with more columns", Door::kOpen, counted("{}.csv", text(xyzid, ",", "x,y,z,intensity,vr\n"))},
      {"text with tabs", Door::kOpen, counted("{}.txt", text(xyzd, "\t", "x\ty\tz\tdoppler\n"))},
      {"text with blanks and a comment of names", Door::kOpen,
       counted("scan{}.txt", text(xyzd, "  ", "# x y z v_r\n"))},
      {"text with blanks alone", Door::kOpen, counted("{}.txt", text(xyzd, " "))},
      {"the radar of View-of-Delft", Door::kOpen, counted("radar/training/velodyne/{:05d}.bin", records<float>(vod))},
      {"a scan in records", Door::kOpen, single("0.bin", records<float>(xyzd))},
      {"a scan of a recording", Door::kOpen, single("point_clouds/00001.bin", records<float>(xyzd))},
      {"a scan as PCD", Door::kOpen, single("scan.pcd", pcd(plain))},
      {"a scan as NPY", Door::kOpen, single("scan.npy", npy(xyzd))},
      {"a scan as CSV", Door::kOpen, single("scan.csv", text(xyzd, ",", "x,y,z,doppler\n"))},

      {"a ROS 1 bag", Door::kOpen, bag({{"/lidar/points", {"x", "y", "z", "velocity"}}})},
      {"a bag whose other clouds have no Doppler", Door::kOpen,
       bag({{"/camera/points", {"x", "y", "z"}}, {"/lidar/points", {"x", "y", "z", "doppler"}}})},
      {"MCAP as it is written", Door::kOpen, converted("mcap", "drive.mcap")},
      {"NPZ as it is written", Door::kOpen, converted("npz", "npz")},
      {"a bag of two clouds", Door::kWithAdvice,
       bag({{"/left", {"x", "y", "z", "doppler"}}, {"/right", {"x", "y", "z", "doppler"}, mirrored}}),
       "holds several clouds of points with Doppler"},
      {"a bag whose Doppler has an unknown name", Door::kWithAdvice, bag({{"/points", {"x", "y", "z", "foo"}}}),
       "--field doppler=foo"},
      {"two clouds in a bag, and unknown names", Door::kWithAdvice,
       bag({{"/lidar", {"x", "y", "z", "noise", "foo"}, xyzid}, {"/other", {"x", "y", "z"}}}),
       "--topic /lidar --field doppler=foo"},
      {"a bag without Doppler", Door::kRefused, bag({{"/points", {"x", "y", "z"}}}), "no column of Doppler"},

      {"records of five numbers", Door::kWithAdvice, counted("point_clouds/{:05d}.bin", records<float>(xyzid)),
       "records of 5 float32 a point"},
      {"records of eight numbers", Door::kWithAdvice, counted("point_clouds/{:05d}.bin", records<float>(eight)),
       "records of 8 float32 a point"},
      {"records of float64", Door::kWithAdvice, counted("point_clouds/{:05d}.bin", records<double>(xyzd)),
       "records of 4 float64 a point"},
      {"records of five float64", Door::kWithAdvice, counted("{:05d}.bin", records<double>(xyzid)),
       "records of 5 float64 a point"},
      {"a folder of records of five numbers", Door::kWithAdvice, counted("{}.bin", records<float>(xyzid)),
       "records of 5 float32 a point"},
      {"a folder of records of eight numbers", Door::kWithAdvice, counted("{}.bin", records<float>(eight)),
       "records of 8 float32 a point"},
      {"a scan of five numbers", Door::kWithAdvice, single("0.bin", records<float>(xyzid)), "records of 5 float32"},
      {"a folder velodyne of five numbers", Door::kWithAdvice, counted("velodyne/{}.bin", records<float>(xyzid)),
       "records of 5 float32 a point"},
      {"NPY of five columns", Door::kWithAdvice, counted("{}.npy", npy(xyzid)), "has 5 columns without names"},
      {"NPZ of eight columns", Door::kWithAdvice,
       counted("{}.npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("points", rows)}; }, eight)),
       "has 8 columns without names"},
      {"NPZ of unknown names", Door::kWithAdvice,
       counted("{}.npz", npz([](const Rows& rows) {
                 return std::vector<NamedArray>{array("noise", part(rows, 0, 1)), array("cloud", part(rows, 0, 3)),
                                                array("foo", part(rows, 3, 4))};
               })),
       "--field points=cloud --field doppler=foo"},
      {"NPZ of an unknown name of four columns", Door::kWithAdvice,
       counted("{}.npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("cloud", rows)}; })),
       "--field points=cloud"},
      {"NPZ of columns with other names", Door::kWithAdvice,
       counted("{}.npz", npz([](const Rows& rows) {
                 return std::vector<NamedArray>{array("cartesianX", part(rows, 0, 1)),
                                                array("cartesianY", part(rows, 1, 2)),
                                                array("cartesianZ", part(rows, 2, 3)), array("foo", part(rows, 3, 4))};
               })),
       "--field x=cartesianX"},
      {"PCD with an unknown name", Door::kWithAdvice, counted("{}.pcd", pcd("x y z foo")), "--field doppler=foo"},
      {"CSV with an unknown name", Door::kWithAdvice, counted("{}.csv", text(xyzd, ",", "x,y,z,foo\n")),
       "--field doppler=foo"},
      {"CSV of five columns without names", Door::kWithAdvice, counted("{}.csv", text(xyzid, ",")),
       "has 5 columns without names"},

      {"LAS", Door::kRefused, foreign("scan.las", "LASF" + std::string(300, '\0')), "laspy.read"},
      {"E57", Door::kRefused, foreign("scan.e57", "ASTM-E57" + std::string(300, '\0')), "PCD, PLY or text"},
      {"HDF5", Door::kRefused, foreign("scan.h5", "\x89HDF\r\n\x1A\n" + std::string(300, '\0')), "h5py"},
      {"MATLAB", Door::kRefused, foreign("scan.mat", "MATLAB 5.0 MAT-file" + std::string(300, ' ')), "scipy.io"},
  };
  return all;
}

/// The options that a message proposes, as it spells them.
std::vector<std::string> options_in(const std::string& message) {
  static const std::regex kOption(
      "--(columns|dtype|field|format|period|topic|doppler-scale|doppler-sign|point-scale) ('[^']*'|[^ ,;\n]+(,[^ "
      ",;\n]+)*)");
  const std::string proposal = message.substr(0, message.find("; or state"));
  std::vector<std::string> options;
  for (std::sregex_iterator option(proposal.begin(), proposal.end(), kOption); option != std::sregex_iterator();
       ++option) {
    options.push_back(option->str());
  }
  return options;
}

/// The same put in force.
InputSettings pasted(const std::string& message) {
  InputSettings settings;
  for (const std::string& option : options_in(message)) {
    const std::size_t blank = option.find(' ');
    std::string name = option.substr(2, blank - 2);
    std::string value = option.substr(blank + 1);
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

class OpenDoor : public ProgramTest {
 protected:
  static const Drive& drive() {
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

  static void expect_same(const datasets::Dataset& dataset, std::size_t expected_scans) {
    ASSERT_EQ(dataset.size(), expected_scans);
    for (std::size_t i = 0; i < dataset.size(); ++i) {
      const RawScan scan = dataset.scan(i);
      EXPECT_EQ(scan.points, drive().scans[i].points) << "scan " << i;
      EXPECT_EQ(scan.doppler, drive().scans[i].doppler) << "scan " << i;
      EXPECT_TRUE(i == 0 || dataset.stamp(i) > dataset.stamp(i - 1));
    }
  }
};

TEST_F(OpenDoor, EveryFormIsReadOrSaysHow) {
  std::size_t number = 0;
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    const fs::path input = form.write(drive(), folder_ / fmt::format("form_{}", ++number) / "data");
    const bool is_bag = input.extension() == ".bag" || input.extension() == ".mcap";
    const std::size_t scans = fs::is_directory(input) || is_bag ? drive().scans.size() : 1;
    try {
      const auto dataset = datasets::open_input(input, {});
      EXPECT_EQ(form.door, Door::kOpen);
      expect_same(*dataset, scans);
      continue;
    } catch (const DataError& error) {
      EXPECT_NE(form.door, Door::kOpen) << error.what();
    }
    const Outcome refused = run_program("info " + input.string());  // which spells the options
    const std::string& message = refused.text;
    EXPECT_EQ(refused.status, kFailed) << message;
    EXPECT_NE(message.find(form.said), std::string::npos) << message;
    EXPECT_EQ(options_in(message).empty(), form.door != Door::kWithAdvice) << message;
    if (form.door == Door::kWithAdvice) {
      try {
        expect_same(*datasets::open_input(input, pasted(message)), scans);
      } catch (const std::exception& error) {
        ADD_FAILURE() << "the advice of\n" << message << "\nhas it say\n" << error.what();
      }
    }
  }
  EXPECT_GE(number, 49U);
}

// By the program, with its own words on both streams.
TEST_F(OpenDoor, TheProgramTakesItsOwnAdvice) {
  const fs::path plain = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  const fs::path five = counted("point_clouds/{:05d}.bin", records<float>(xyzid))(drive(), folder_ / "five");
  for (const fs::path& folder : {plain, five}) {
    write(folder / "ref_poses.txt", drive().poses);
  }
  const Outcome refused = run_program("info " + five.string());
  ASSERT_EQ(refused.status, kFailed) << refused.text;
  std::smatch advice;
  ASSERT_TRUE(std::regex_search(refused.text, advice, std::regex("--columns [^ \n]+"))) << refused.text;
  EXPECT_EQ(refused.text.find("--doppler-sign"), std::string::npos) << "only this is said";
  const std::string words = advice.str();
  EXPECT_EQ(run_program("info " + five.string() + " " + words).status, kDone);
  for (const char* format : {"", " --format bin"}) {
    const std::string out = (folder_ / fmt::format("out{}", std::string(format).size())).string();
    const Outcome run = run_program("run --quiet " + five.string() + " " + words + format + " --output " + out);
    ASSERT_EQ(run.status, kDone) << run.text;
    const Outcome reference =
        run_program("run --quiet --force " + plain.string() + " --output " + (folder_ / "reference").string());
    ASSERT_EQ(reference.status, kDone) << reference.text;
    EXPECT_EQ(read_file(fs::path(out) / "trajectory.tum"), read_file(folder_ / "reference" / "trajectory.tum"));
  }
}

// Numbers that are read but cannot be what they are taken for stop a run, and what it says then mends them.
TEST_F(OpenDoor, WrongNumbersAreMendedByTheAdvice) {
  const auto changed = [](double point, double doppler) {
    return [=](const RawScan& scan, std::size_t i) -> Row {
      const Eigen::Vector3d p = point * scan.points[i];
      return {p.x(), p.y(), p.z(), doppler * scan.doppler[i]};
    };
  };
  struct Wrong {
    const char* name;
    RowOf row_of;
    const char* advice;
  };
  const Wrong all[] = {{"plain", xyzd, nullptr},
                       {"kmh", changed(1.0, 3.6), "--doppler-scale 0.27"},
                       {"mm", changed(1000.0, 1.0), "--point-scale 0.001"},
                       {"towards", changed(1.0, -1.0), "--doppler-sign towards"}};
  for (const Wrong& wrong : all) {
    SCOPED_TRACE(wrong.name);
    const fs::path input = folder_ / wrong.name;
    counted("point_clouds/{:05d}.bin", records<float>(wrong.row_of))(drive(), input);
    write(input / "ref_poses.txt", drive().poses);
    std::string command = fmt::format("run --quiet {} --output {}", input.string(), (input / "out").string());
    if (wrong.advice != nullptr) {
      const Outcome refused = run_program(command);
      EXPECT_EQ(refused.status, kFailed) << refused.text;
      EXPECT_NE(refused.text.find(wrong.advice), std::string::npos) << refused.text;
      EXPECT_FALSE(fs::exists(input / "out"));
      command += fmt::format(" {}", fmt::join(options_in(refused.text), " "));
    }
    const Outcome mended = run_program(command);
    ASSERT_EQ(mended.status, kDone) << mended.text;
    EXPECT_LT(nlohmann::json::parse(read_file(input / "out" / "summary.json")).at("rte_rmse_m").get<double>(), 0.05);
  }
}

TEST_F(OpenDoor, PointsWithoutTimesAreSpokenOf) {
  const fs::path input = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  write(input / "ref_poses.txt", drive().poses);
  const Outcome outcome = run_program(fmt::format("run {} --output {}", input.string(), (folder_ / "out").string()));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_NE(outcome.text.find("the points have no times"), std::string::npos) << outcome.text;
}

TEST_F(OpenDoor, ABagThatWasCutIsReadUpToThere) {
  const std::string whole = bag_of(drive(), {{"/points", {"x", "y", "z", "doppler"}}});
  const fs::path file = folder_ / "cut.bag";
  write_file(file, whole.substr(0, whole.size() * 6 / 10));
  const auto dataset = datasets::open_input(file, {});
  ASSERT_GE(dataset->size(), 2U);
  ASSERT_LT(dataset->size(), drive().scans.size());
  expect_same(*dataset, dataset->size());
  const Outcome info = run_program("info " + file.string());
  EXPECT_EQ(info.status, kDone) << info.text;
  EXPECT_TRUE(std::regex_search(info.text, std::regex("cut.bag: [^\n]*(byte|offset) [0-9]+"))) << info.text;
}

TEST_F(OpenDoor, ATableOfSeveralScansIsTakenApartByItsRecipe) {
  std::string table = "frame,x,y,z,doppler\n";
  for (std::size_t i = 0; i < drive().scans.size(); ++i) {
    for (const Row& row : rows_of(drive().scans[i], xyzd)) {
      table += fmt::format("{},{}\n", i, fmt::join(row, ","));
    }
  }
  write_file(folder_ / "all.csv", table);
  const Outcome refused = run_program("info " + (folder_ / "all.csv").string());
  EXPECT_EQ(refused.status, kFailed) << refused.text;
  EXPECT_NE(refused.text.find("holds several scans, told apart by its column 'frame' (0, 1, ...)"), std::string::npos)
      << refused.text;
  const std::size_t recipe = refused.text.find("mkdir scans; awk");
  ASSERT_NE(recipe, std::string::npos) << refused.text;
  const Outcome done = run_shell("cd '" + folder_.string() + "' && { " + refused.text.substr(recipe) + "\n} 2>&1");
  ASSERT_EQ(done.status, 0) << done.text;
  expect_same(*datasets::open_input(folder_ / "scans", {}), drive().scans.size());
}

TEST_F(OpenDoor, OneScanIsToldWhatToDoWithTwo) {
  const fs::path scan = single("scan.pcd", pcd("x y z doppler"))(drive(), folder_);
  const Outcome info = run_program("info " + scan.string());
  EXPECT_NE(info.text.find("one scan: there is no motion to find; `register` aligns two"), std::string::npos)
      << info.text;
  const Outcome run = run_program(fmt::format("run {} --output {}", scan.string(), (folder_ / "out").string()));
  EXPECT_EQ(run.status, kDone) << run.text;
  EXPECT_NE(run.text.find("one scan: there is no motion to find"), std::string::npos) << run.text;
}

// x and Doppler of a record of five numbers in each other's place, stated in the wrong order.
TEST_F(OpenDoor, ColumnsThatChangedPlacesAreSaidOfTheWholeRecord) {
  const auto doppler_first = [](const RawScan& scan, std::size_t i) -> Row {
    const Eigen::Vector3d& p = scan.points[i];
    return {scan.doppler[i], p.y(), p.z(), intensity(i), p.x()};
  };
  const fs::path input = counted("{}.bin", records<float>(doppler_first))(drive(), folder_ / "scans");
  const Outcome info = run_program("info " + input.string() + " --columns x,y,z,_,doppler");
  ASSERT_EQ(info.status, kDone) << info.text;
  ASSERT_NE(info.text.find("fix with --columns doppler,y,z,_,x"), std::string::npos) << info.text;
  InputSettings settings;
  datasets::set(settings, "columns", "doppler,y,z,_,x");
  expect_same(*datasets::open_input(input, settings), drive().scans.size());
}

TEST_F(OpenDoor, RegisterReadsEveryForm) {
  const std::vector<RawScan>& scans = drive().scans;
  const std::pair<const char*, ContentOf> kinds[] = {
      {"bin", records<float>(xyzd)},
      {"pcd", pcd("x y z doppler")},
      {"npz", npz([](const Rows& rows) { return std::vector<NamedArray>{array("points", rows)}; })},
      {"npy", npy(xyzd)},
      {"csv", text(xyzd, ",", "x,y,z,doppler\n")}};
  std::string expected;
  for (const auto& [ending, content_of] : kinds) {
    SCOPED_TRACE(ending);
    std::string files;
    for (std::size_t i = 0; i < 2; ++i) {
      const fs::path file = folder_ / fmt::format("{}.{}", i, ending);
      write(file, content_of(scans[i]));
      files += " " + file.string();
    }
    const Outcome outcome = run_program("register --preset paper" + files + " 2>/dev/null");
    ASSERT_EQ(outcome.status, kDone) << outcome.text;
    const nlohmann::json pair = nlohmann::json::parse(outcome.text);
    const std::string transform = pair.at("T_target_source").dump();
    expected = expected.empty() ? transform : expected;
    EXPECT_EQ(transform, expected);
  }
  const fs::path records_of_five = folder_ / "five.bin";
  write(records_of_five, records<float>(xyzid)(scans[0]));
  const std::string five = records_of_five.string();
  EXPECT_EQ(run_program("register " + five + " " + five).status, kFailed);
  EXPECT_EQ(run_program("register " + five + " " + five + " --columns x,y,z,intensity,doppler").status, kDone);
}

/// The poses of the drive as KITTI has them.
std::string kitti_of(const formats::Trajectory& poses) {
  std::string text;
  for (const formats::StampedPose& pose : poses) {
    const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows = pose.T_world_sensor.matrix().topRows<3>();
    std::vector<double> numbers(rows.data(), rows.data() + rows.size());
    text += fmt::format("{}\n", fmt::join(numbers, " "));
  }
  return text;
}

TEST_F(OpenDoor, GroundTruthOfKittiAndTablesIsFoundAndTaken) {
  const fs::path plain = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  write(plain / "ref_poses.txt", drive().poses);
  const auto reference = datasets::open_dataset(plain);
  const formats::Trajectory& truth = reference->ground_truth();
  std::string table = "timestamp,x,y,z,qx,qy,qz,qw\n";
  std::istringstream lines(drive().poses);
  for (std::string line; std::getline(lines, line);) {
    table += line.front() == '#' ? "" : std::regex_replace(line, std::regex(" +"), ",") + "\n";
  }
  const std::pair<const char*, std::string> files[] = {{"poses.txt", kitti_of(truth)}, {"gt.csv", table}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const fs::path beside = counted("{:05d}.bin", records<float>(xyzd))(drive(), folder_ / name / "scans");
    write(beside / name, content);
    const auto found = datasets::open_dataset(beside);
    ASSERT_EQ(found->ground_truth().size(), truth.size());
    EXPECT_EQ(found->ground_truth_file().filename(), name);
    EXPECT_LT((found->ground_truth().back().T_world_sensor.matrix() - truth.back().T_world_sensor.matrix()).norm(),
              1e-6);
    const fs::path file = folder_ / "truths" / name;
    write(file, content);
    const std::string out = (folder_ / fmt::format("run_{}", name)).string();
    const Outcome run =
        run_program(fmt::format("run --quiet {} --ground-truth {} --output {}", plain.string(), file.string(), out));
    ASSERT_EQ(run.status, kDone) << run.text;
    EXPECT_LT(nlohmann::json::parse(read_file(fs::path(out) / "summary.json")).at("rte_rmse_m").get<double>(), 0.05);
    const Outcome evaluated = run_program(fmt::format("evaluate {}/trajectory.tum {}", out, file.string()));
    EXPECT_EQ(evaluated.status, kDone) << evaluated.text;
  }
  fs::remove(folder_ / "poses.txt" / "scans" / "00005.bin");
  const auto misfit = datasets::open_dataset(folder_ / "poses.txt" / "scans");
  EXPECT_TRUE(misfit->ground_truth().empty());
  EXPECT_NE(fmt::format("{}", fmt::join(misfit->assumptions(), "\n")).find("poses.txt: is not used as ground truth"),
            std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::tests
