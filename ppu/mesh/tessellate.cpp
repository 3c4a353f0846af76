#include "softcell/soft_bodies/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Halves all edges that are too long, once. Vertices of the mesh are added, its triangles stay.
class EdgeHalver {
 public:
  EdgeHalver(TriangleMesh& mesh, float longest) : mesh_(mesh), longest_(double{longest} * double{longest}) {}

  /// Appends what becomes of a triangle. @return whether any of its edges was too long
  bool split(const Triangle& triangle, std::vector<Triangle>& to) {
    // Turned so that the edges to be halved are the first ones.
    std::array<bool, 3> is_long{};
    for (std::size_t k = 0; k < 3; ++k) is_long[k] = is_too_long(triangle[k], triangle[(k + 1) % 3]);
    const auto count = std::count(is_long.begin(), is_long.end(), true);
    if (count == 0) {
      to.push_back(triangle);
      return false;
    }
    std::size_t first = 0;
    while (!is_long[first] || (count == 2 && !is_long[(first + 1) % 3])) ++first;
    const std::uint32_t a = triangle[first], b = triangle[(first + 1) % 3], c = triangle[(first + 2) % 3];
    const std::uint32_t ab = middle(a, b);
    if (count == 1) {
      to.insert(to.end(), {{a, ab, c}, {ab, b, c}});
      return true;
    }
    const std::uint32_t bc = middle(b, c);
    to.push_back({ab, b, bc});
    if (count == 3) {
      const std::uint32_t ca = middle(c, a);
      to.insert(to.end(), {{a, ab, ca}, {ca, bc, c}, {ab, bc, ca}});
    } else if (squared_length(a, bc) < squared_length(ab, c)) {
      to.insert(to.end(), {{a, ab, bc}, {a, bc, c}});
    } else {
      to.insert(to.end(), {{a, ab, c}, {ab, bc, c}});
    }
    return true;
  }

 private:
  double squared_length(std::uint32_t a, std::uint32_t b) const {
    return (mesh_.positions[a].cast<double>() - mesh_.positions[b].cast<double>()).squaredNorm();
  }
  bool is_too_long(std::uint32_t a, std::uint32_t b) const { return squared_length(a, b) > longest_; }

  /// The vertex in the middle of an edge, the same for all triangles at the edge.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [found, is_new] =
        middles_.try_emplace({low, high}, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) add_mean(low, high);
    return found->second;
  }
  void add_mean(std::uint32_t a, std::uint32_t b) {
    const auto add = [&](auto& values) {
      if (values.empty()) return;
      const auto mean = (0.5f * values[a] + 0.5f * values[b]).eval();
      values.push_back(mean);
    };
    add(mesh_.positions);
    add(mesh_.texture_coordinates);
    add(mesh_.colours);
    const Eigen::Vector3f normal = mesh_.normals[a] + mesh_.normals[b];
    const float length = normal.norm();
    mesh_.normals.push_back(length > 1e-3f ? Eigen::Vector3f(normal / length) : mesh_.normals[a]);
  }

  TriangleMesh& mesh_;
  double longest_;  // m^2
  // Of edges, from the lower vertex.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

/// @return whether any edge was too long
bool halve_long_edges(TriangleMesh& mesh, float longest) {
  EdgeHalver halver(mesh, longest);
  std::vector<Triangle> triangles;
  triangles.reserve(2 * mesh.triangles.size());
  std::vector<MeshPart> parts = mesh.parts;
  bool changed = false;
  std::size_t part = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    while (part < parts.size() && t >= mesh.parts[part].first_triangle + mesh.parts[part].triangle_count)
      ++part;
    const auto before = triangles.size();
    const Triangle triangle = mesh.triangles[t];
    changed = halver.split(triangle, triangles) || changed;
    if (part < parts.size())
      parts[part].triangle_count += static_cast<std::uint32_t>(triangles.size() - before - 1);
    if (triangles.size() > kMaxTessellatedTriangles)
      throw std::invalid_argument("with edges of at most " + base::shortest(longest) +
                                  " m a mesh has more than " + std::to_string(kMaxTessellatedTriangles) +
                                  " triangles; give it longer ones");
  }
  std::uint32_t next = 0;
  for (MeshPart& one : parts) one.first_triangle = std::exchange(next, next + one.triangle_count);
  mesh.triangles = std::move(triangles);
  mesh.parts = std::move(parts);
  return changed;
}

}  // namespace

TriangleMesh tessellate(const TriangleMesh& mesh, float longest_edge) {
  if (!(longest_edge > 0) || !std::isfinite(longest_edge))
    throw std::invalid_argument("a mesh is tessellated to edges of " + base::shortest(longest_edge) +
                                " m; give a length above 0");
  validate(mesh);
  TriangleMesh finer = mesh;
  while (halve_long_edges(finer, longest_edge)) {
  }
  SC_ASSERT(finer.positions.size() >= mesh.positions.size(), "{} positions of a mesh of {}",
            finer.positions.size(), mesh.positions.size());
  return finer;
}

}  // namespace softcell::ppu
