#pragma once
// Properties of meshes that several tests ask for.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Number of each vertex's position; equal positions have equal numbers.
inline std::vector<std::uint32_t> position_numbers(const TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> numbers;
  for (const Eigen::Vector3f& p : mesh.positions) {
    // + 0 makes -0 and 0 the same key.
    const std::array<float, 3> key{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};
    numbers.push_back(known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second);
  }
  return numbers;
}

/// Sides of triangles that are not met by exactly one side in the other direction: 0 for a closed,
/// consistently wound mesh.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> number = position_numbers(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{number[t[k]], number[t[(k + 1) % 3]]}];
  }
  return static_cast<std::size_t>(std::count_if(sides.begin(), sides.end(), [&](const auto& side) {
    const auto back = sides.find({side.first.second, side.first.first});
    return side.second != 1 || back == sides.end() || back->second != 1;
  }));
}

/// Cubic metres enclosed; negative when wound inside out.
inline double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = mesh.positions[a].cast<double>(), pb = mesh.positions[b].cast<double>();
    sum += pa.dot(pb.cross(mesh.positions[c].cast<double>()));
  }
  return sum / 6;
}

/// The smallest cosine between a triangle's own normal and those of its three vertices.
inline double worst_normal_cosine(const TriangleMesh& mesh) {
  double worst = 1;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = mesh.positions[a].cast<double>();
    const Eigen::Vector3d normal =
        (mesh.positions[b].cast<double>() - pa).cross(mesh.positions[c].cast<double>() - pa).normalized();
    for (const std::uint32_t v : {a, b, c})
      worst = std::min(worst, normal.dot(mesh.normals[v].cast<double>()));
  }
  return worst;
}

/// FNV-1a over every bit of the mesh.
inline std::uint64_t hash(const TriangleMesh& mesh) {
  std::uint64_t value = 0xcbf29ce484222325u;
  const auto add = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value = (value ^ bytes[i]) * 0x100000001b3u;
  };
  for (const Eigen::Vector3f& p : mesh.positions) add(p.data(), sizeof(float) * 3);
  for (const Eigen::Vector3f& n : mesh.normals) add(n.data(), sizeof(float) * 3);
  add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return value;
}

}  // namespace softcell::ppu
