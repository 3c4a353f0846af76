#include "softcell/soft_bodies/mesh.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/mesh/position_numbers.h"
#include "ppu/mesh/vertex_normals.h"
#include "ppu/numbers/box_around.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

void require_one_for_each(const char* what, std::size_t count, std::size_t positions) {
  if (count == positions) return;
  throw std::invalid_argument("a mesh of " + std::to_string(positions) + " positions has " +
                              std::to_string(count) + " " + what + "; one for each position was expected");
}

void require_existing(std::size_t triangle, std::uint32_t vertex, std::size_t vertices) {
  if (vertex < vertices) return;
  throw std::invalid_argument("triangle " + std::to_string(triangle) + " of a mesh names vertex " +
                              std::to_string(vertex) + "; the mesh has " + std::to_string(vertices));
}

std::string text_of(const Eigen::Vector3f& v) {
  return base::shortest(v.x()) + ", " + base::shortest(v.y()) + ", " + base::shortest(v.z());
}

}  // namespace

bool MeshTexture::operator==(const MeshTexture& other) const {
  const bool same_picture =
      picture == other.picture || (picture && other.picture && *picture == *other.picture);
  return file == other.file && wrap_u == other.wrap_u && wrap_v == other.wrap_v && same_picture;
}

bool MeshMaterial::has_looks() const {
  return base_colour || base_texture.picture || normal_texture.picture || !emission.isZero(0);
}

TriangleMesh make_mesh(std::span<const Eigen::Vector3f> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite())
      throw std::runtime_error("position " + std::to_string(i) + " of a mesh is " + text_of(positions[i]) +
                               "; finite coordinates were expected");
  }
  const std::vector<std::uint32_t> numbers = number_positions(positions);
  std::vector<Eigen::Vector3f> different;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (numbers[i] == different.size()) different.push_back(positions[i]);

  std::vector<std::array<std::uint32_t, 3>> joined;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : triangles[t]) require_existing(t, vertex, positions.size());
    const auto& [a, b, c] = triangles[t];
    if (area_vector(positions[a], positions[b], positions[c]).norm() > 0)
      joined.push_back({numbers[a], numbers[b], numbers[c]});
  }
  return with_smooth_normals(different, joined);
}

Bounds<3> bounds(const TriangleMesh& mesh) {
  SC_ASSERT(!mesh.positions.empty(), "a mesh without positions has no box");
  return box_around<Bounds<3>>(mesh.positions);
}

void fit(TriangleMesh& mesh, float longest_side) {
  SC_ASSERT(longest_side > 0 && std::isfinite(longest_side), "a longest side of {} m", longest_side);
  const Bounds<3> box = bounds(mesh);
  // In double: the sides of a box of finite floats may pass the largest float.
  const Eigen::Vector3d low = box.low.cast<double>(), high = box.high.cast<double>();
  const Eigen::Vector3d centre = 0.5 * (low + high);
  const double scale = static_cast<double>(longest_side) / (high - low).maxCoeff();
  for (Eigen::Vector3f& position : mesh.positions) {
    position = (scale * (position.cast<double>() - centre)).cast<float>();
  }
}

void rotate(TriangleMesh& mesh, const Eigen::Matrix3f& rotation) {
  SC_ASSERT((rotation * rotation.transpose() - Eigen::Matrix3f::Identity()).norm() < 1e-4f &&
                rotation.determinant() > 0,
            "a rotation with determinant {}", rotation.determinant());
  for (Eigen::Vector3f& position : mesh.positions) position = (rotation * position).eval();
  for (Eigen::Vector3f& normal : mesh.normals) normal = (rotation * normal).eval();
}

void turn_z_up(TriangleMesh& mesh) {
  const auto turn = [](Eigen::Vector3f& v) { v = Eigen::Vector3f(v.x(), v.z(), 0 - v.y()); };
  for (Eigen::Vector3f& position : mesh.positions) turn(position);
  for (Eigen::Vector3f& normal : mesh.normals) turn(normal);
}

void scale(TriangleMesh& mesh, float factor) {
  SC_ASSERT(factor > 0 && std::isfinite(factor), "a mesh is scaled by {}", factor);
  for (Eigen::Vector3f& position : mesh.positions) position *= factor;
}

void validate(const TriangleMesh& mesh) {
  const std::size_t positions = mesh.positions.size();
  require_one_for_each("normals", mesh.normals.size(), positions);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const Eigen::Vector3f& normal = mesh.normals[i];
    constexpr float kLeast = 1e-20f;  // of a square, whose root and inverse are numbers
    if (normal.squaredNorm() >= kLeast && std::isfinite(normal.squaredNorm())) continue;
    throw std::invalid_argument("normal " + std::to_string(i) + " of a mesh is " + text_of(normal) +
                                "; a unit vector was expected");
  }
  if (!mesh.texture_coordinates.empty())
    require_one_for_each("texture coordinates", mesh.texture_coordinates.size(), positions);
  if (!mesh.colours.empty()) require_one_for_each("colours", mesh.colours.size(), positions);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) require_existing(t, vertex, positions);
  }
  std::size_t next = 0;
  for (const MeshPart& part : mesh.parts) {
    if (part.first_triangle != next) {
      throw std::invalid_argument("a part of a mesh begins at triangle " +
                                  std::to_string(part.first_triangle) + "; the part before it ends at " +
                                  std::to_string(next));
    }
    next += part.triangle_count;
    if (part.material && *part.material >= mesh.materials.size()) {
      throw std::invalid_argument("a part of a mesh has material " + std::to_string(*part.material) +
                                  "; the mesh has " + std::to_string(mesh.materials.size()));
    }
  }
  if (!mesh.parts.empty() && next != mesh.triangles.size()) {
    throw std::invalid_argument("the parts of a mesh have " + std::to_string(next) +
                                " triangles, the mesh has " + std::to_string(mesh.triangles.size()));
  }
}

}  // namespace softcell::ppu
