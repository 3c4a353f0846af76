#include "ppu/mesh_import/mesh_soup.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "ppu/mesh/vertex_normals.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// For each of `count` items the number of its class of equal ones; classes are numbered in order of their
/// first item.
/// @param compare  (a, b) -> bool on item numbers, a strict weak order
template <class Compare>
std::vector<std::uint32_t> number_equal(std::size_t count, Compare compare) {
  std::vector<std::uint32_t> order(count), number(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) || (!compare(b, a) && a < b); });
  // First the lowest item of each class, then, since that comes before the others, its number.
  for (std::size_t i = 0; i < count; ++i) {
    const bool first = i == 0 || compare(order[i - 1], order[i]);
    number[order[i]] = first ? order[i] : number[order[i - 1]];
  }
  std::uint32_t classes = 0;
  for (std::uint32_t item = 0; item < count; ++item)
    number[item] = number[item] == item ? classes++ : number[number[item]];
  return number;
}

auto components(const Eigen::Vector3f& v) { return std::make_tuple(v.x(), v.y(), v.z()); }

/// Equal positions joined; unused ones stay.
void weld(MeshSoup& soup) {
  const auto number = number_equal(soup.positions.size(), [&](std::uint32_t a, std::uint32_t b) {
    return components(soup.positions[a]) < components(soup.positions[b]);
  });
  std::vector<Eigen::Vector3f> welded;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == welded.size()) welded.push_back(soup.positions[i]);
  }
  soup.positions = std::move(welded);
  for (auto& triangle : soup.triangles) {
    for (std::uint32_t& corner : triangle) corner = number[corner];
  }
}

/// Makes the file's normals unit vectors. @return false when one cannot be: then none of them is used.
bool normalize(std::vector<Eigen::Vector3f>& normals) {
  for (Eigen::Vector3f& normal : normals) {
    const Eigen::Vector3d exact = normal.cast<double>();
    const double length = exact.norm();
    if (!(length > 1e-6 && std::isfinite(length))) return false;
    normal = (exact / length).cast<float>();
  }
  return true;
}

/// A vertex for each different pair of position and normal that a triangle uses, in the order of their first
/// use.
TriangleMesh with_given_normals(const MeshSoup& soup) {
  SC_ASSERT(soup.normals.size() == soup.positions.size(), "{} normals for {} positions", soup.normals.size(),
            soup.positions.size());
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : soup.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  const auto key = [&](std::uint32_t i) {
    const std::uint32_t corner = corners[i];
    return std::tuple_cat(components(soup.positions[corner]), components(soup.normals[corner]));
  };
  const auto number =
      number_equal(corners.size(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  TriangleMesh mesh;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (number[i] == mesh.positions.size()) {
      mesh.positions.push_back(soup.positions[corners[i]]);
      mesh.normals.push_back(soup.normals[corners[i]]);
    }
    if (i % 3 == 0) mesh.triangles.push_back({number[i], number[i + 1], number[i + 2]});
  }
  return mesh;
}

/// Gives the mesh's corners the texture coordinates and colours of the soup's: a vertex whose corners differ
/// in them becomes several. A mesh whose vertices each have one keeps its order of vertices.
/// @param corners  the soup's vertices, three for each of the mesh's triangles, before any were joined
void carry_attributes(const MeshSoup& soup, std::span<const std::array<std::uint32_t, 3>> corners,
                      TriangleMesh& mesh) {
  SC_ASSERT(corners.size() == mesh.triangles.size(), "the corners of {} triangles for {}", corners.size(),
            mesh.triangles.size());
  const auto texture = [&](std::uint32_t corner) {
    return soup.texture_coordinates.empty() ? Eigen::Vector2f(0, 0) : soup.texture_coordinates[corner];
  };
  const auto colour = [&](std::uint32_t corner) {
    return soup.colours.empty() ? Eigen::Vector4f(0, 0, 0, 0) : soup.colours[corner];
  };
  const auto key = [&](std::uint32_t i) {
    const std::uint32_t corner = corners[i / 3][i % 3];
    const Eigen::Vector2f t = texture(corner);
    const Eigen::Vector4f c = colour(corner);
    return std::make_tuple(mesh.triangles[i / 3][i % 3], t.x(), t.y(), c.x(), c.y(), c.z(), c.w());
  };
  const auto number = number_equal(3 * mesh.triangles.size(),
                                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  TriangleMesh split;
  split.triangles.resize(mesh.triangles.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == split.positions.size()) {
      const std::uint32_t vertex = mesh.triangles[i / 3][i % 3], corner = corners[i / 3][i % 3];
      split.positions.push_back(mesh.positions[vertex]);
      split.normals.push_back(mesh.normals[vertex]);
      if (!soup.texture_coordinates.empty()) split.texture_coordinates.push_back(texture(corner));
      if (!soup.colours.empty()) split.colours.push_back(colour(corner));
    }
    split.triangles[i / 3][i % 3] = number[i];
  }
  mesh = std::move(split);
}

/// The file's parts, counted in the triangles that are left.
/// @param number_in_file  of each triangle left, ascending
std::vector<MeshPart> parts_of(std::vector<MeshPart> parts, std::span<const std::uint32_t> number_in_file) {
  SC_ASSERT(std::ranges::is_sorted(number_in_file), "the numbers of {} triangles do not ascend",
            number_in_file.size());
  std::uint32_t next = 0;
  for (MeshPart& part : parts) {
    const std::uint32_t end = part.first_triangle + part.triangle_count;
    part.first_triangle = next;
    while (next < number_in_file.size() && number_in_file[next] < end) ++next;
    part.triangle_count = next - part.first_triangle;
  }
  std::erase_if(parts, [](const MeshPart& part) { return part.triangle_count == 0; });
  return parts;
}

}  // namespace

void add_triangle(MeshSoup& soup, const std::array<std::uint32_t, 3>& corners, std::uint32_t number) {
  const auto& [a, b, c] = corners;
  SC_ASSERT(std::max({a, b, c}) < soup.positions.size(), "triangle {} names position {} of {}", number,
            std::max({a, b, c}), soup.positions.size());
  if (!(area_vector(soup.positions[a], soup.positions[b], soup.positions[c]).norm() > 0)) return;
  soup.triangles.push_back(corners);
  soup.number_in_file.push_back(number);
}

TriangleMesh mesh_of(MeshSoup soup) {
  SC_ASSERT(!soup.triangles.empty() && soup.number_in_file.size() == soup.triangles.size(),
            "{} numbers of {} triangles", soup.number_in_file.size(), soup.triangles.size());
  for (const std::size_t attributes : {soup.texture_coordinates.size(), soup.colours.size()}) {
    SC_ASSERT(attributes == 0 || attributes == soup.positions.size(), "{} attributes of {} positions",
              attributes, soup.positions.size());
  }
  const bool has_attributes = !soup.texture_coordinates.empty() || !soup.colours.empty();
  std::vector<std::array<std::uint32_t, 3>> corners;  // of the triangles, before any are joined
  if (has_attributes) corners = soup.triangles;
  TriangleMesh mesh;
  if (!soup.normals.empty() && normalize(soup.normals)) {
    mesh = with_given_normals(soup);
  } else {
    weld(soup);
    mesh = with_smooth_normals(soup.positions, soup.triangles);
  }
  if (has_attributes) carry_attributes(soup, corners, mesh);
  SC_ASSERT(mesh.normals.size() == mesh.positions.size(), "{} normals of {} positions", mesh.normals.size(),
            mesh.positions.size());
  mesh.parts = parts_of(std::move(soup.parts), soup.number_in_file);
  return mesh;
}

}  // namespace softcell::ppu
