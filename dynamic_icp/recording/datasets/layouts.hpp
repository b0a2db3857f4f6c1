// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"

// The layouts, each in a file of its own: a function that finds a recording of it, and one that opens what was found.
// Opening throws DataError naming file, place and what was expected.
namespace dynamic_icp::datasets {

/// Whether the folder (or one up to three levels below it) holds `point_clouds/*.bin`; the folder that does, or empty.
/// A file of such a folder is one itself.
std::filesystem::path find_dicp(const std::filesystem::path& input);

/// The same, or else any file, a folder of *.bin files or one named velodyne: for when the user names the format.
std::filesystem::path find_dicp_scans(const std::filesystem::path& input);

/// The layout of the Doppler-ICP data, which is also the plain one for interchange:
///   point_clouds/00001.bin ...  records of little-endian float32 x, y, z (m, sensor frame), Doppler (m/s, + away)
///   times/00001.bin ...         optional: float32 seconds after the stamp per point, for scans that take time
///   ref_poses.txt               optional: TUM rows, one per scan; gives the time stamps too
///   calibration.json            optional: pose of the sensor in the vehicle; ref_poses.txt then holds vehicle poses
///                               (calibration.hpp)
/// Scans are ordered by the number in their file name. Without ref_poses.txt the names may be time stamps; else the
/// period of the options is assumed. A folder without point_clouds/ holds the scans itself; a file is a recording of
/// one scan. Records of another kind are read where the user states them (stated_records.hpp); where sizes and content
/// of the files say that they are of another kind and the user does not, a DataError has the option that states it.
std::unique_ptr<Dataset> open_dicp(const std::filesystem::path& found, const OpenOptions& options = {});

/// The folder of a recording of HeRCULES, up to three levels below `input`; empty when there is none.
std::filesystem::path find_hercules(const std::filesystem::path& input);

/// HeRCULES, in any spelling of upper and lower case and with its parts in one folder or several side by side:
///   LiDAR/Aeva/<stamp_ns>.bin    records of 29 bytes (formats::kAeva29); the stamp is the begin of the scan
///   PR_GT/Aeva_gt.txt            optional: poses of the sensor, TUM columns with whole nanoseconds
///   Calibration/IMU_LiDAR.txt    optional: pose of the sensor in the IMU, which stands for the vehicle
std::unique_ptr<Dataset> open_hercules(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The pose of the LiDAR in the IMU by Calibration/IMU_LiDAR.txt. Throws DataError naming file and line.
Eigen::Isometry3d read_imu_lidar(const std::filesystem::path& path);

/// The folder of a recording of HeLiPR, up to three levels below `input`; empty when there is none or it is of
/// HeRCULES, which lies in the same folders.
std::filesystem::path find_helipr(const std::filesystem::path& input);

/// HeLiPR, in any spelling of upper and lower case:
///   LiDAR/Aeva/<stamp_ns>.bin    records of 25 bytes up to a recorder's change in August 2023, of 29 bytes after it
///                                (formats::kAeva25, kAeva29): by the stamp, and by the content of a file whose size
///                                contradicts it
///   LiDAR_GT/Aeva_gt.txt         optional, or global_Aeva_gt.txt: poses of the sensor, TUM columns with whole ns
/// The Doppler is taken as compensated, as the authors of the data set say, with a sentence that says so.
std::unique_ptr<Dataset> open_helipr(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The folder of a recording of either of these two (the one that holds LiDAR/Aeva/*.bin): `input`, the only one up to
/// three levels below it, or the one above when `input` is the folder of the scans itself; empty when there is none.
/// Throws DataError when there are several.
std::filesystem::path find_aeva_folder(const std::filesystem::path& input);

/// The folder of a Boreas recording with an Aeva sensor, up to three levels below `input`; empty when there is none.
std::filesystem::path find_boreas(const std::filesystem::path& input);

/// The same by the scans alone (aeva/*.bin or frames/*.bin), for when the user names the format.
std::filesystem::path find_boreas_scans(const std::filesystem::path& input);

/// Boreas-RT and Boreas-Aeva:
///   aeva/<stamp_us>.bin                 records of float32 (formats::kBoreas40; 24, 28 or 32 bytes: the content tells)
///   applanix/aeva_poses.csv             optional: poses of the sensor in ENU
///   calib/T_applanix_lidar.txt, T_aeva_lidar.txt   optional: give the sensor's pose in the Applanix frame
///   aeva_calib/*.csv                    optional: the Doppler bias of scans of 28 bytes, which is taken out
///                                       (boreas_doppler_tables.hpp); a sentence says whether it was
/// and the "Aeva" set of the same authors:
///   frames/*.bin                        records of 20 bytes (formats::kXyzdTime), in the order of their numbers
///   timestamps.txt                      seconds, one line per scan
///   aeva_poses.txt                      optional: 12 numbers of the sensor's 3x4 pose, one line per scan
std::unique_ptr<Dataset> open_boreas(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The poses of applanix/aeva_poses.csv: a header, then t (us), x, y, z, vx, vy, vz, roll, pitch, yaw, ... Throws
/// DataError naming file and line.
formats::Trajectory read_boreas_poses(const std::filesystem::path& path);

/// The times of timestamps.txt, strictly increasing. Throws DataError naming file and line.
std::vector<Stamp> read_boreas_times(const std::filesystem::path& path);

/// The transform in a file of calib/. Throws DataError naming the file.
Eigen::Isometry3d read_boreas_matrix(const std::filesystem::path& path);

/// The sequence of AevaScenes that the input is or that lies up to three levels below it: the folder with sequence.json
/// beside pointcloud_compensated/ or pointcloud_raw/, or one of these two where that is the input itself; else empty.
/// Throws DataError that lists the sequences when there are several.
std::filesystem::path find_aevascenes(const std::filesystem::path& input);

/// Opens a sequence, release v0.x or v2.
///
/// The LiDARs of the options (without: front_wide_lidar and front_narrow_lidar, those of them there are, else the
/// first) are merged into the vehicle's frame, where each point keeps the line of sight it had from its own LiDAR. One
/// LiDAR alone stays in its own frame; poses and boxes are in the same frame as the points. Where both folders exist
/// the raw one is taken, unless the input is the other: its Doppler is taken as relative, that of
/// pointcloud_compensated/ as compensated. Labels as text are left out, those as numbers are a column.
///
/// Throws DataError naming file, place and what was expected; UsageError for unknown LiDARs, naming those there are,
/// and for fields, whose names are known here.
std::unique_ptr<Dataset> open_aevascenes(const std::filesystem::path& found, const OpenOptions& options = {});

// Recordings of files whose columns have names, one a scan: archives of NumPy arrays (*.npz), PCD, PLY or text. Which
// column says what is found by its name (field_names.hpp), once for all scans, as is the unit of the times of points
// (point_times.hpp), for which opening reads one scan. Stamps are in the names of the files (scan_stamps.hpp), ground
// truth is looked for beside them (truth_search.hpp), and a calibration.json (calibration.hpp): the poses of the truth
// are those of the scans' frame all the same. What is called compensated holds compensated Doppler.

/// The file or the folder of such files that the input is, or that lies up to three levels below it; else empty. Throws
/// DataError that lists them when there are several.
std::filesystem::path find_npz(
    const std::filesystem::path& input);  ///< or pairs <name>.npy and <name>_dop.npy, or *.npy of shape (N, 4+)
std::filesystem::path find_pcd(const std::filesystem::path& input);
std::filesystem::path find_ply(const std::filesystem::path& input);
std::filesystem::path find_csv(const std::filesystem::path& input);  ///< *.csv of points, else *.txt

/// Opens one of them. Throws DataError naming file, place and what was expected; UsageError for sensors, which such
/// files do not have, and for unknown fields.
std::unique_ptr<Dataset> open_npz(const std::filesystem::path& found, const OpenOptions& options = {});
std::unique_ptr<Dataset> open_pcd(const std::filesystem::path& found, const OpenOptions& options = {});
std::unique_ptr<Dataset> open_ply(const std::filesystem::path& found, const OpenOptions& options = {});
std::unique_ptr<Dataset> open_csv(const std::filesystem::path& found, const OpenOptions& options = {});

// Recordings of messages, whatever their container: a bag of ROS 1, one of ROS 2 (a folder with metadata.yaml, or a
// *.db3 file), an MCAP file alone. bag_dataset.hpp says how clouds become scans.

/// The bag of that container that the input is, or that lies up to three levels below it; else empty. Throws DataError
/// that lists them when there are several.
std::filesystem::path find_rosbag(const std::filesystem::path& input);
std::filesystem::path find_rosbag2(const std::filesystem::path& input);
std::filesystem::path find_mcap(const std::filesystem::path& input);

/// Opens any of them.
std::unique_ptr<Dataset> open_bag(const std::filesystem::path& found, const OpenOptions& options = {});

/// A file *.bin, or a folder of such files that nothing else was recognised by: `input` itself, or one named velodyne
/// up to three levels below it; empty when there is none.
std::filesystem::path find_bin_folder(const std::filesystem::path& input);

/// The same, any file, the folder point_clouds/ of a recording or the only one below that holds *.bin: for when the
/// user names the format.
std::filesystem::path find_bin_scans(const std::filesystem::path& input);

/// Its scans, in the records that the user states, else those of the layout that the content of the first looks like,
/// which is said among the assumptions. A folder named velodyne is of the radar of View-of-Delft, stated or refused.
/// Ground truth is looked for beside them. Throws DataError when the content looks like no layout, with the option that
/// states what it may be instead, and for scans of KITTI, which have no Doppler.
std::unique_ptr<Dataset> open_bin_folder(const std::filesystem::path& found, const OpenOptions& options = {});

}  // namespace dynamic_icp::datasets
