// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "tests/forms.hpp"

namespace dynamic_icp::tests::forms {

using formats::NamedArray;

const std::vector<Form>& all_forms() {
  const std::string plain = "x y z doppler";
  const auto nanoseconds = [](std::size_t i) {
    return fmt::format("{}.{:09d}", 1700000000 + i / 2, 500'000'000 * (i % 2));
  };
  const auto numbered = [](const RawScan& scan, std::size_t i) -> Row {
    const Eigen::Vector3d& p = scan.points[i];
    return {static_cast<double>(i), p.x(), p.y(), p.z(), scan.doppler[i]};
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
      {"CSV with names that say nothing", Door::kWithAdvice, counted("{}.csv", text(xyzid, ",", "a,b,c,d,e\n")),
       "--field x=a --field y=b --field z=c --field doppler=e"},
      {"CSV of ParaView", Door::kWithAdvice,
       counted("{}.csv", text(xyzd, ",", "\"Points:0\",\"Points:1\",\"Points:2\",\"foo\"\n")), "--field x=Points:0"},
      {"CSV with blanks in names", Door::kWithAdvice, counted("{}.csv", text(xyzd, ",", "x pos,y pos,z pos,my foo\n")),
       "--field 'x=x pos'"},
      {"PCD with names that say nothing", Door::kWithAdvice, counted("{}.pcd", pcd("a b c d")), "--field x=a"},
      {"CSV whose rows are numbered, without names", Door::kWithAdvice, counted("{}.csv", text(numbered, ",")),
       "--columns _,x,y,z,doppler"},
      {"NPY whose rows are numbered", Door::kWithAdvice, counted("{}.npy", npy(numbered)), "--columns _,x,y,z,doppler"},
      {"CSV of five columns without names", Door::kWithAdvice, counted("{}.csv", text(xyzid, ",")),
       "has 5 columns without names"},

      {"LAS", Door::kRefused, foreign("scan.las", "LASF" + std::string(300, '\0')), "laspy.read"},
      {"E57", Door::kRefused, foreign("scan.e57", "ASTM-E57" + std::string(300, '\0')), "PCD, PLY or text"},
      {"HDF5", Door::kRefused, foreign("scan.h5", "\x89HDF\r\n\x1A\n" + std::string(300, '\0')), "h5py"},
      {"MATLAB", Door::kRefused, foreign("scan.mat", "MATLAB 5.0 MAT-file" + std::string(300, ' ')), "scipy.io"},
  };
  return all;
}

}  // namespace dynamic_icp::tests::forms
