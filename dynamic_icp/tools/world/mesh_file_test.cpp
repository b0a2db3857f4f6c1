// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/mesh_file.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector3d;

TriangleMesh load(const std::string& content, const std::string& ending) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("mesh_file_test-" + std::to_string(::getpid()) + ending);
  formats::write_whole_file(path, content);
  try {
    TriangleMesh mesh = load_mesh(path);
    std::filesystem::remove(path);
    return mesh;
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
}

std::string message(const std::string& content, const std::string& ending) {
  try {
    load(content, ending);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no DataError";
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  return sum;
}

/// By the divergence theorem; the sign tells outside from inside.
double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return sum;
}

/// A PLY file of vertices "x y z" and faces "corners first second ...".
std::string ply(const std::vector<std::string>& vertices, const std::vector<std::string>& faces) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const std::vector<std::string>* lines : {&vertices, &faces}) {
    for (const std::string& line : *lines) {
      text += line + "\n";
    }
  }
  return text;
}

TEST(MeshFile, ReadsABox) {
  const TriangleMesh mesh = load(ply({"0 0 0", "2 0 0", "2 3 0", "0 3 0", "0 0 4", "2 0 4", "2 3 4", "0 3 4"},
                                     {"4 3 2 1 0", "4 4 5 6 7", "4 0 1 5 4", "4 1 2 6 5", "4 2 3 7 6", "4 3 0 4 7"}),
                                 ".ply");
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.reflectivity, std::vector<float>(12, static_cast<float>(reflectivity::kUsual)));
  EXPECT_DOUBLE_EQ(area(mesh), 2.0 * (6.0 + 8.0 + 12.0));
  EXPECT_DOUBLE_EQ(volume(mesh), 24.0);
}

TEST(MeshFile, MakesFansOfPolygons) {
  std::vector<std::string> corners;
  std::string face = "9";
  constexpr int kCorners = 9;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * M_PI * i / kCorners;
    corners.push_back(std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 1");
    face += " " + std::to_string(i);
  }
  const TriangleMesh mesh = load(ply(corners, {face}), ".PLY");
  EXPECT_EQ(mesh.triangles.size(), 7u);
  EXPECT_NEAR(area(mesh), 0.5 * kCorners * std::sin(2.0 * M_PI / kCorners), 1e-5);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    EXPECT_TRUE(triangle_normal(mesh, i).isApprox(Vector3d::UnitZ()));
  }
}

TEST(MeshFile, LeavesOutFacesWithoutAreaAndVerticesWithoutFace) {
  const TriangleMesh mesh =
      load(ply({"9 9 9", "0 0 0", "1 0 0", "2 0 0", "0 1 0"}, {"3 1 2 3", "3 1 2 2", "3 1 2 4"}), ".ply");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(bounds(mesh).max(), Vector3d(1.0, 1.0, 0.0));
  EXPECT_DOUBLE_EQ(area(mesh), 0.5);
}

constexpr const char* kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\n";

TEST(MeshFile, ReadsPly) {
  for (const char* list : {"vertex_indices", "vertex_index"}) {
    const TriangleMesh mesh = load(std::string(kPlyHead) + "element face 4\nproperty list uchar int " + list +
                                       "\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n"
                                       "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
                                   ".ply");
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6.0);
  }
}

TEST(MeshFile, PlyErrorsNameRecordAndExpectation) {
  const std::string head(kPlyHead);
  const std::string faces = "element face 1\nproperty list char int vertex_indices\nend_header\n";
  const std::string points = "0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n";
  const std::vector<std::pair<std::string, std::vector<const char*>>> faults = {
      {head + "end_header\n" + points, {"no element 'face'"}},
      {head + "element face 1\nproperty int vertex_indices\nend_header\n" + points + "3\n", {"no list"}},
      {head + "element face 1\nproperty list uchar int corners\nend_header\n" + points + "3 0 1 2\n", {"no list"}},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + faces + "1\n3 0 0 0\n", {"no number 'y'"}},
      {head + faces + points + "3 0 1 4\n", {"record 1 of element 'face'", "corner 4", "0 to 3"}},
      {head + faces + points + "3 0 1 -1\n", {"record 1 of element 'face'", "corner -1"}},
      {head + faces + points + "2 0 1\n", {"record 1 of element 'face'", "2 corners"}},
      {head + faces + points + "3 0 1 1\n", {"no face with an area"}},
      {head + faces + "0 0 0 1\n1 0 0 1\n0 nan 0 1\n0 0 1 1\n3 0 1 2\n", {"record 3 of element 'vertex'", "finite"}},
      {head + faces + points, {"1 records of element 'face'"}},
  };
  for (const auto& [content, parts] : faults) {
    const std::string error = message(content, ".ply");
    for (const char* part : parts) {
      EXPECT_NE(error.find(part), std::string::npos) << error << "\n lacks: " << part;
    }
  }
}

TEST(MeshFile, RefusesOtherFiles) {
  EXPECT_NE(message("v 0 0 0\n", ".obj").find("ends with .ply"), std::string::npos);
  EXPECT_THROW(load_mesh("/nonexistent/mesh.ply"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::world
