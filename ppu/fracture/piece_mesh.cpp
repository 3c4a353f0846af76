#include "ppu/fracture/piece_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr std::uint32_t kNoCopy = ~0u;

class PieceMaker {
 public:
  PieceMaker(const CellMesh& whole, const Lattice<3>& piece, std::span<const std::uint32_t> cell_of_whole)
      : whole_(whole),
        piece_(piece),
        cell_of_whole_(cell_of_whole),
        first_copy_(whole.vertices().positions.size(), kNoCopy) {
    const TriangleMesh& of = whole.mesh();
    result_.mesh.materials = of.materials;
    triangles_of_part_.resize(std::max<std::size_t>(of.parts.size(), 1));
  }

  PieceMesh make(std::span<const CellFace> faces) {
    for (std::uint32_t c = 0; c < piece_.cells.size(); ++c)
      for (const CellMesh::Triangle& triangle : whole_.triangles_of(cell_of_whole_[c])) {
        auto& own = triangles_of_part_[triangle.part].emplace_back();
        for (std::size_t k = 0; k < 3; ++k) own[k] = copy_of(triangle.vertex[k], c);
      }
    close(faces);
    gather();
    return std::move(result_);
  }

 private:
  /// A vertex of the whole, as it is carried by certain particles.
  struct Copy {
    std::array<std::uint32_t, 4> carriers;
    std::uint32_t vertex = 0, next = kNoCopy;
  };

  /// The corners of a cell that move a point of it: all that lie on the same planes as the point.
  std::array<std::uint32_t, 4> carriers_of(const CellMesh::Point& point, std::uint32_t cell) const {
    std::array<std::uint32_t, 4> carriers{};
    std::size_t count = 0;
    for (unsigned k = 0; k < 8; ++k) {
      bool on_planes = true;
      for (std::size_t i = 0; i < point.planes; ++i) {
        const bool high = point.plane[i] > piece_.cells[cell][point.axis[i]];
        on_planes = on_planes && ((k >> point.axis[i] & 1u) != 0) == high;
      }
      if (on_planes) carriers[count++] = piece_.corners[cell][k];
    }
    return carriers;
  }

  std::uint32_t copy_of(std::uint32_t vertex, std::uint32_t cell) {
    const CellMesh::Point& point = whole_.point_of(vertex);
    std::array<std::uint32_t, 4> carriers{};
    if (point.planes > 0) carriers = carriers_of(point, cell);
    for (std::uint32_t i = first_copy_[vertex]; i != kNoCopy; i = copies_[i].next)
      if (copies_[i].carriers == carriers) return copies_[i].vertex;
    const std::uint32_t fresh = add(point.position, whole_.vertices().normals[vertex], cell);
    const TriangleMesh& from = whole_.vertices();
    if (!from.texture_coordinates.empty())
      result_.mesh.texture_coordinates.push_back(from.texture_coordinates[vertex]);
    if (!from.colours.empty()) result_.mesh.colours.push_back(from.colours[vertex]);
    copies_.push_back({carriers, fresh, first_copy_[vertex]});
    first_copy_[vertex] = static_cast<std::uint32_t>(copies_.size() - 1);
    return fresh;
  }

  std::uint32_t add(const Vector3f& position, const Vector3f& normal, std::uint32_t cell) {
    const Vector3d grid = (position.cast<double>() - piece_.origin.cast<double>()) / double{piece_.spacing};
    const Vector3d xi = (grid - piece_.cells[cell].cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
    result_.mesh.positions.push_back(position);
    result_.mesh.normals.push_back(normal);
    result_.places.push_back({cell, xi});
    return static_cast<std::uint32_t>(result_.mesh.positions.size() - 1);
  }

  /// Adds caps where a cell's neighbour in the whole is in another piece, or is separated from the cell.
  void close(std::span<const CellFace> faces) {
    std::vector<std::array<bool, 6>> holds(
        piece_.cells.size());  // of each cell: towards -x, -y, -z, +x, +y, +z
    for (const CellFace& face : faces) {
      const unsigned bit = 1u << face.axis;
      bool same = true;
      for (unsigned k = 0; k < 8; ++k)
        if ((k & bit) != 0) same = same && piece_.corners[face.low][k] == piece_.corners[face.high][k & ~bit];
      holds[face.low][3 + face.axis] = holds[face.high][face.axis] = same;
    }
    const Lattice<3>& of = whole_.lattice();
    for (std::uint32_t c = 0; c < piece_.cells.size(); ++c)
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const Vector3i along = Vector3i::Unit(axis);
        if (!holds[c][axis])
          if (const auto before = find_cell(of, piece_.cells[c] - along)) add_cap(c, *before, axis, false);
        if (!holds[c][3 + axis] && find_cell(of, piece_.cells[c] + along))
          add_cap(c, cell_of_whole_[c], axis, true);
      }
  }

  /// @param low  in the whole: the low cell of the face  @param outwards  whether it is the piece's own cell
  void add_cap(std::uint32_t cell, std::uint32_t low, std::uint32_t axis, bool outwards) {
    const CellMesh::Cap cap = whole_.cap(low, axis);
    const Vector3f normal = (outwards ? 1.0f : -1.0f) * Vector3f::Unit(axis);
    const auto first = static_cast<std::uint32_t>(result_.mesh.positions.size());
    for (const Vector3f& position : cap.positions) {
      add(position, normal, cell);
      const Vector3f cells = (position - piece_.origin) / piece_.spacing;
      if (!whole_.mesh().texture_coordinates.empty())
        result_.mesh.texture_coordinates.push_back({cells[(axis + 1) % 3], cells[(axis + 2) % 3]});
      if (!whole_.mesh().colours.empty()) result_.mesh.colours.push_back(Eigen::Vector4f::Ones());
    }
    result_.open.push_back({cell, axis, outwards, static_cast<std::uint32_t>(caps_.size()),
                            static_cast<std::uint32_t>(cap.triangles.size())});
    for (std::array<std::uint32_t, 3> triangle : cap.triangles) {
      for (std::uint32_t& vertex : triangle) vertex += first;
      if (!outwards) std::swap(triangle[1], triangle[2]);
      caps_.push_back(triangle);
    }
  }

  /// Puts the mesh together part by part; caps are the last part.
  void gather() {
    TriangleMesh& mesh = result_.mesh;
    const TriangleMesh& of = whole_.mesh();
    const auto append = [&](MeshPart part, std::span<const std::array<std::uint32_t, 3>> triangles) {
      if (triangles.empty()) return;
      part.first_triangle = static_cast<std::uint32_t>(mesh.triangles.size());
      part.triangle_count = static_cast<std::uint32_t>(triangles.size());
      mesh.parts.push_back(std::move(part));
      mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    };
    for (std::size_t p = 0; p < triangles_of_part_.size(); ++p)
      append(of.parts.empty() ? MeshPart() : of.parts[p], triangles_of_part_[p]);
    for (OpenFace& face : result_.open)
      face.first_triangle += static_cast<std::uint32_t>(mesh.triangles.size());
    if (caps_.empty()) return;
    auto cut = std::find_if(mesh.materials.begin(), mesh.materials.end(),
                            [](const MeshMaterial& material) { return material.name == kCutMaterial; });
    if (cut == mesh.materials.end()) {
      MeshMaterial material;
      material.name = kCutMaterial;
      cut = mesh.materials.insert(mesh.materials.end(), material);
    }
    MeshPart part;
    part.object = kCutMaterial;
    part.material = static_cast<std::uint32_t>(cut - mesh.materials.begin());
    append(part, caps_);
  }

  const CellMesh& whole_;
  const Lattice<3>& piece_;
  std::span<const std::uint32_t> cell_of_whole_;
  PieceMesh result_;
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles_of_part_;
  std::vector<std::array<std::uint32_t, 3>> caps_;
  std::vector<std::uint32_t> first_copy_;  // of each vertex of the whole
  std::vector<Copy> copies_;
};

}  // namespace

PieceMesh mesh_of_piece(const CellMesh& whole, const Lattice<3>& piece,
                        std::span<const std::uint32_t> cell_of_whole, std::span<const CellFace> faces) {
  SC_ASSERT(cell_of_whole.size() == piece.cells.size(), "{} cells of a piece of {}", cell_of_whole.size(),
            piece.cells.size());
  return PieceMaker(whole, piece, cell_of_whole).make(faces);
}

}  // namespace softcell::ppu
