// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Small valid files for the fuzzers to begin with: fuzz_seeds DIR writes DIR/<target>/<name>.
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

#include "fuzz/yaml_seeds.hpp"
#include "testing/bags_by_hand.hpp"
#include "testing/db3_by_hand.hpp"
#include "testing/npz_by_hand.hpp"
#include "testing/ros_bytes.hpp"

namespace dynamic_icp::fuzz {
namespace {

namespace fs = std::filesystem;
using formats::NamedArray;

template <class Number>
NamedArray array(const char* name, std::vector<std::size_t> shape, const std::vector<Number>& values) {
  return {name, formats::npy_array<Number>(std::move(shape), values)};
}

/// Two points.
std::vector<NamedArray> table() {
  return {array<float>("x", {2}, {1, 2}),
          array<float>("y", {2}, {3, -4}),
          array<float>("z", {2}, {0.5F, 0.25F}),
          array<float>("doppler", {2}, {-1.5F, 2}),
          array<int>("time_offset_ns", {2}, {0, 99}),
          array<std::uint8_t>("line", {2}, {1, 2})};
}

/// A header of PCD with these data.
std::string pcd(const std::string& encoding, const std::string& data) {
  return "FIELDS x y z v t\nSIZE 4 4 4 4 8\nTYPE F F F F U\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA " + encoding + "\n" +
         data;
}

/// An archive with another number at this place of each entry of its directory.
template <class Number>
std::string with_entries(std::string archive, std::size_t at, Number number) {
  for (const std::size_t entry : formats::central_entries(archive)) {
    std::memcpy(archive.data() + entry + at, &number, sizeof(number));
  }
  return archive;
}

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  void write(const std::string& target, const std::string& content) {
    formats::make_folder(folder_ / target);
    formats::write_bytes(folder_ / target / fmt::format("seed-{}", ++written_), std::as_bytes(std::span(content)));
  }

  void write_all() {
    for (const char pipeline : {'\0', '\1', '\2', '\3', '\4', '\5'}) {
      write("states", std::string{pipeline, '\4'} + std::string(64, '\x5b'));  // four edits
    }
    write("scans", std::string(400, '\x40'));  // choices of the generator, none of them the first
    const NamedArray points = array<double>("points", {2, 3}, {1, 2, 3, 4, 5, 6});
    std::string npy = formats::npy_bytes(points.array);
    write("npy", npy);
    npy.replace(npy.find("False"), 5, "True ");
    npy.replace(npy.find("<f8"), 3, ">f8");
    write("npy", npy);
    const std::string npz = formats::npz_bytes(
        std::vector<NamedArray>{points, array<float>("doppler", {2}, {1, 2}), array<double>("t", {2}, {0, 0.1}),
                                array<float>("los", {2, 3}, {1, 0, 0, 0, 1, 0})});
    write("npz", npz);
    std::string doubled =
        formats::npz_bytes(std::vector<NamedArray>{array<double>("a", {1}, {1}), array<double>("b", {1}, {2})});
    for (std::size_t at = 0; (at = doubled.find("b.npy", at)) != std::string::npos;) {
      doubled[at] = 'a';
    }
    write("npz", doubled);
    write("npz", with_entries(npz, 24, std::uint32_t{1} << 28U));  // sizes: a bomb
    write("npz", with_entries(npz, 10, std::uint16_t{99}));        // a compression that nobody knows
    write("columns", "2" + npz);
    const std::string binary_pcd = formats::pcd_bytes(table());
    const std::string ascii_pcd = pcd("ascii", "1 2 3 -4.5 1724479779384729506\n");
    std::string packed = "\x17";
    packed += std::string(24, 'a');
    std::string sizes;
    formats::append_value(sizes, static_cast<std::uint32_t>(packed.size()));
    formats::append_value(sizes, std::uint32_t{24});
    for (const std::string& content : {binary_pcd, ascii_pcd, pcd("binary_compressed", sizes + packed)}) {
      write("pcd", content);
      write("columns", "0" + content);
    }
    const std::string binary_ply = formats::ply_bytes(table());
    const std::string ascii_ply =
        "ply\nformat ascii 1.0\ncomment c\nelement face 1\nproperty list uchar int c\nelement vertex 1\n"
        "property double x\nproperty float y\nproperty int z\nproperty float velocity\nproperty float time\n"
        "property uchar ring\nproperty uchar valid\n"
        "end_header\n3 0 1 2\n1 2 3 -4 0.5 7 0\n";
    std::string big_ply = binary_ply;
    big_ply.replace(big_ply.find("little"), 6, "big");
    std::string list_ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uchar short c\nproperty float x\n"
        "end_header\n";
    list_ply += std::string("\2\1\0\2\0\0\0\x80\x3F", 9);
    for (const std::string& content : {binary_ply, ascii_ply, big_ply, list_ply}) {
      write("ply", content);
      write("columns", "1" + content);
    }
    write("tum", "# c\n0.0 0 0 0 0 0 0 1\n1724479779384729506, 1, 2, 3, 0, 0, 0.6, 0.8\n1.8e9 1 2 3 0 0 0 -1\n");
    for (const char* text :
         {"x,y,z,doppler,ring,t\n1,2,3,-4.5,7,0.01\n1,,nan,4,8,0.02\n", "# x y z v_r\n1  2 3 -4\n\n# c\n5 6 7 8\n",
          "\"X\";\"Y\";\"Z\";\"Velocity [m/s]\"\n1;2;3;4\n", "1\t2\t3\t4\n", "1 0 0 1 0 1 0 2 0 0 1 3\n",
          "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"
          "1403636580838555648,4,5,6,0.5,0.5,0.5,0.5\n1403636580843555328,4,5,6,1,0,0,0\n"}) {
      for (const char* kind : {"0", "1", "2"}) {  // see csv.cpp
        write("csv", std::string(kind) + text);
      }
    }
    for (const char* text : {"x,y,z,doppler,ring\n1,2,3,-4.5,0.5\n", "1 2 3 4\n5 6 7 8\n",
                             "range,azimuth,elevation,doppler\n10,0.5,0.1,-4\n20,-0.5,0.2,3\n"}) {
      write("columns", std::string("3") + text);
    }
    write("columns", "4" + formats::npy_bytes(array<float>("points", {2, 4}, {1, 2, 3, 4, 5, 6, 7, 8}).array));
    write("columns", "2" + formats::npz_bytes(std::vector<NamedArray>{points, array<float>("doppler", {1}, {1})}));
    write("csv", "2timestamp_ns,x,y,z,qx,qy,qz,qw\n1000000000,1,2,3,0,0,0,1\n2000000000,1,2,3,0,0,0,1\n");
    write("csv", "21 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 1 0 1 0 2 0 0 1 3\n");  // as many as csv.cpp has scans
    std::string records;
    for (const float value : {1.0F, 2.0F, 3.0F, -4.0F, 5.0F, 6.0F, 7.0F, 8.0F, 9.0F, 10.0F}) {
      formats::append_value(records, value);
    }
    write("xyzd", records);
    constexpr char kChoices = 11;  // see records.cpp
    for (char choice = 0; choice < kChoices; ++choice) {
      write("records", choice + records + records);
      write("records", static_cast<char>(choice + kChoices) + records);
    }
    const std::string guess(1, char{10});  // records.cpp: neither of these records has Doppler
    std::string radar;
    for (const float value : {3.0F, 4.0F, 0.0F, 0.0F, 5.0F, 0.0F, 0.0F}) {
      formats::append_value(radar, value);
    }
    write("records", guess + radar + '\0');
    std::string reflectance;
    for (const float value : {1.0F, 2.0F, 3.0F, 0.5F, 5.0F, 6.0F, 7.0F, 0.25F}) {
      formats::append_value(reflectance, value);
    }
    write("records", guess + reflectance);
    const std::string sequence =
        R"({"metadata":{"sensors":{"lidars":["a"]},"vehicle_to_lidar_extrinsics":{"a":{"translation":{"x":1,"y":2,"z":3},)"
        R"("rotation":{"w":1,"x":0,"y":0,"z":0}}}},"frames":[{"timestamp_ns":"17","ego_pose":{"translation":{"x":1,"y":2,)"
        R"("z":3},"rotation":{"w":1,"x":0,"y":0,"z":0}},"point_cloud":{"a":{"point_cloud_raw_path":"p"}},"boxes":[{"id":)"
        R"("b","reference_frame":"a","dimensions":{"x":1,"y":2,"z":3},"pose":{"translation":{"x":1,"y":2,"z":3},)"
        R"("rotation":{"w":1,"x":0,"y":0,"z":0}},"linear_velocity":{"x":1,"y":2,"z":3},"class":"car"}]}]})";
    write("aevascenes", sequence);
    const std::size_t frames = sequence.find("[{\"timestamp_ns");
    const std::string frame = sequence.substr(frames + 1, sequence.size() - frames - 3);
    std::string twice = sequence.substr(0, frames + 1) + frame + "," + frame + "]}";
    twice.replace(twice.find("[\"a\"]"), 5, "[\"b\"]");  // without extrinsics
    write("aevascenes", twice);
    write_texts();
    write_settings();
    write_bags();
    write_messages();
  }

 private:
  /// The first byte says of which type and encoding a message is (messages.cpp).
  void write_messages() {
    const ros::Cloud cloud = ros::float_cloud(7, "lidar", {"x", "y", "z", "v"}, {{1, 2, 3, 4}, {5, 6, 7, 8}});
    write("messages", '\0' + cloud.bytes(ros::Wire::kRos1));
    write("messages", '\1' + cloud.bytes(ros::Wire::kCdrLittle));
    write("messages", '\1' + cloud.bytes(ros::Wire::kCdrBig));
    write("messages", "\4\x0A\2\x08\5\x12\1l\x25" + std::string("\4\0\0\0", 4) + "\x2A\5\x0A\1x\x18\7\x32\4abcd");
    write("messages",
          "\5{\"timestamp\":{\"sec\":1,\"nsec\":2},\"frame_id\":\"l\",\"point_stride\":4,\"fields\":[{\"name\":\"x\","
          "\"offset\":0,\"type\":7}],\"data\":\"AACAPw==\"}");
    ros::Writer transform(ros::Wire::kCdrLittle);
    transform.put(std::uint32_t{1}).header(1, "a").text("b").pose(Eigen::Isometry3d::Identity());
    write("messages", '\x0D' + transform.bytes());
    // Each kind that the others do not lead to: PointCloud with a channel, RadarScan, poses and transforms of Foxglove.
    ros::Writer cloud1(ros::Wire::kRos1);
    cloud1.header(1, "a").put(std::uint32_t{1}).put(1.0F).put(2.0F).put(3.0F);
    cloud1.put(std::uint32_t{1}).text("v").put(std::uint32_t{1}).put(4.0F);
    write("messages", '\2' + cloud1.bytes());
    ros::Writer radar(ros::Wire::kCdrLittle);
    radar.header(1, "a").put(std::uint32_t{1}).put(10.0F).put(0.5F).put(0.1F).put(-3.0F).put(20.0F);
    write("messages", '\x15' + radar.bytes());
    const std::string place = R"({"x":1,"y":2,"z":3})";
    const std::string turn = R"({"x":0,"y":0,"z":0,"w":1})";
    const std::string time = R"("timestamp":{"sec":1,"nsec":2},)";
    const std::string pose = R"("pose":{"position":)" + place + R"(,"orientation":)" + turn + "}";
    write("messages", '\x0B' + ("{" + time + R"("frame_id":"a",)" + pose + "}"));
    const std::string one = "{" + time + R"("parent_frame_id":"a","child_frame_id":"b","translation":)" + place +
                            R"(,"rotation":)" + turn + "}";
    write("messages", '\x0F' + (R"({"transforms":[)" + one + "]}"));
    write("messages", '\x11' + one);
    write("messages",
          '\5' + ("{" + time + R"("frame_id":"a",)" + pose +
                  R"(,"point_stride":4,"fields":[{"name":"x","offset":0,"type":"FLOAT32"}],"data":"AACAPw=="})"));
    const std::string half("\x19\0\0\0\0\0\0\xE0\x3F", 9);  // field 3: a double
    write("messages", '\x0A' + ("\x0A\2\x08\5\x12\1l\x1A\x16\x0A\x09" + half + "\x12\x09\x21" +
                                std::string("\0\0\0\0\0\0\xF0\x3F", 8)));
    write("messages", '\x12' + ros::Writer(ros::Wire::kRos1).header(1, "imu").doubles(37, 0.5).bytes());
  }

  void write_bags() {
    const std::vector<by_hand::Channel> channels = {{1, "/p", "sensor_msgs/msg/PointCloud2", "", "cdr"},
                                                    {2, "/i", "sensor_msgs/msg/Imu", "", "cdr"}};
    const std::vector<by_hand::Message> messages = {{1, 20, "a"}, {2, 10, std::string(100, 'b')}, {1, 30, ""}};
    for (const bool has_index : {true, false}) {
      for (const char* const compression : {"none", "bz2", "lz4", "zstd"}) {
        by_hand::Layout layout;
        layout.compression = compression;
        layout.has_index = has_index;
        layout.has_crc = false;  // changed bytes are to go on
        write("rosbag", by_hand::ros1_bag(channels, messages, layout));
        write("mcap", by_hand::mcap_file(channels, messages, layout));
      }
    }
    by_hand::Layout layout;
    layout.is_chunked = false;
    write("mcap", by_hand::mcap_file(channels, messages, layout));
    formats::make_folder(folder_ / "db3");
    by_hand::write_db3(folder_ / "db3" / "seed", channels, messages, "PRAGMA page_size = 512;");
  }

  /// Each says by its first byte which file it is, see settings.cpp; beside them stands a dictionary.
  void write_settings() {
    const std::vector<std::string> files = yaml_seeds();
    for (const std::string& file : files) {
      write("settings", file);
    }
    const std::string dictionary = yaml_dictionary(files);
    formats::write_bytes(folder_ / "settings.dict", std::as_bytes(std::span(dictionary)));
    write("live", R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":4294967295}]})");
    write("live", R"({"op":"unsubscribe","subscriptionIds":[0,1]})");
    for (const char* header : {"foxglove.sdk.v1, foxglove.websocket.v1", "localhost:8765", "[::1]:8765",
                               "http://127.0.0.1:8765", "https://app.foxglove.dev", "127.0.0.1", "FE80::1",
                               "https://a/b", R"({"op":1})", R"({"op":"unsubscribe","subscriptionIds":[-1]})"}) {
      write("live", header);
    }
  }

  /// The first byte says which text it is, see texts.cpp.
  void write_texts() {
    write("texts",
          "0GPSTime,easting,northing,altitude,vel_east,vel_north,vel_up,roll,pitch,heading,angvel_z\n"
          "1735689600000000,600001.4,4800000.2,101.9,9.1,-0.05,-0.03,-0.01,-0.02,0.01,0\n"
          "1735689600100000,600002.4,4800000.2,101.9,9.1,-0.05,-0.03,-0.01,-0.02,0.01,0\n");
    write("texts", "11735689600.1\n1735689600.2\n1.7356896003e9\n");
    const std::string matrix = "0 -1 0 0.5\n1 0 0 0\n0 0 1 -2e-1";
    write("texts", "2" + matrix + "\n0 0 0 1\n");
    write("texts", "3# calibration\nTr_lidar_to_imu: 1 0 0 0.5 0 1 0 0 0 0 1 1\n");
    write("texts", R"(5{"T_V_to_S":{"translation":{"x":1,"y":2,"z":3},"quaternion":{"w":0.6,"x":0,"y":0,"z":0.8}}})");
    write("texts", "5{}");
    write("texts", R"(4{"T_V_to_S":{"translation":{"x":1,"y":2,"z":3},"quaternion":{"w":0.6,"x":0,"y":0,"z":0.8}}})");
    write("texts", R"(4{"sensors":[{"T_scan_sensor":{"translation":{"x":1,"y":2,"z":3},)"
                   R"("quaternion":{"w":0.6,"x":0,"y":0,"z":0.8}}}]})");
  }

  fs::path folder_;
  int written_ = 0;
};

}  // namespace
}  // namespace dynamic_icp::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: fuzz_seeds DIR\n");
    return 2;
  }
  dynamic_icp::fuzz::Seeds(argv[1]).write_all();
  return 0;
}
