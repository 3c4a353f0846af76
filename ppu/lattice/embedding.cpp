#include "ppu/lattice/embedding.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <string>

#include "ppu/lattice/locate.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using Run = SkinPart::Run;

std::vector<PlaceInCell> locate_all(const TriangleMesh& mesh, const Lattice<3>& lattice) {
  std::vector<PlaceInCell> places;
  places.reserve(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto place = locate(lattice, mesh.positions[v]);
    if (!place) {
      const Eigen::Vector3f& p = mesh.positions[v];
      const bool is_used = std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
        return std::ranges::find(triangle, v) != triangle.end();
      });
      throw std::runtime_error("vertex " + std::to_string(v) + " at (" + base::shortest(p.x()) + ", " +
                               base::shortest(p.y()) + ", " + base::shortest(p.z()) +
                               ") lies in no cell of the lattice; " +
                               (is_used ? "the lattice must cover the mesh"
                                        : "it belongs to no triangle, so leave it out of the mesh"));
    }
    places.push_back(*place);
  }
  return places;
}

/// The particles from the lowest to the highest corner number among the corners with the given bits.
struct Span {
  std::uint32_t low, high;  ///< inclusive
  void widen(const Span& other) { low = std::min(low, other.low), high = std::max(high, other.high); }
  Run run() const { return {low, high - low + 1}; }
};

Span span_of(const std::array<std::uint32_t, 8>& corners, std::size_t bx) {
  Span span{corners[bx], corners[bx]};
  for (std::size_t k = bx; k < 8; k += 2) span.widen({corners[k], corners[k]});
  return span;
}

/// Gathers cells into parts.
///
/// Particles are sorted by x, then y, then z. So the cells of one x-layer, taken in order of y, read a run of particles of their own layer
/// of particles and a run of the next one. As long as everything from the first to the last particle fits, one run is used, and a part may
/// cover several layers of a slender body; when that grows too long, two runs within one layer.
class PartCutter {
 public:
  PartCutter(const Lattice<3>& lattice, std::vector<SkinPart>& parts) : lattice_(lattice), parts_(parts) {}

  /// Adds the next group. @return true when it begins a new part.
  bool add(std::uint32_t group, std::uint32_t cell) {
    SC_ASSERT(cell < lattice_.corners.size(), "cell {} of {}", cell, lattice_.corners.size());
    SC_ASSERT(group == (parts_.empty() ? 0 : parts_.back().first_group + parts_.back().group_count),
              "group {} is added to {} parts that end elsewhere", group, parts_.size());
    const Reach own{span_of(lattice_.corners[cell], 0), span_of(lattice_.corners[cell], 1),
                    lattice_.cells[cell].x(), lattice_.cells[cell].x()};
    if (!parts_.empty() && parts_.back().group_count < kMaxPartGroups) {
      Reach both = reach_;
      both.widen(own);
      if (set_windows(both)) {
        ++parts_.back().group_count;
        reach_ = both;
        return false;
      }
    }
    parts_.push_back({.first_group = group, .group_count = 1, .window = {}});
    reach_ = own;
    if (!set_windows(own)) {
      throw std::runtime_error(
          "one cell of the lattice reads particles that lie too far apart for one skin job (more than " +
          std::to_string(spu::kSkinMaxCorners) + "); use larger cells");
    }
    return true;
  }

 private:
  /// The particles that the part's cells read.
  struct Reach {
    Span near, far;               ///< particles of the corners with bx = 0 and with bx = 1
    int first_layer, last_layer;  ///< of cells
    void widen(const Reach& other) {
      near.widen(other.near), far.widen(other.far);
      first_layer = std::min(first_layer, other.first_layer),
      last_layer = std::max(last_layer, other.last_layer);
    }
  };

  /// Chooses the last part's windows. @return false, with nothing changed: no choice is short enough.
  bool set_windows(const Reach& reach) {
    Span all = reach.near;
    all.widen(reach.far);
    if (all.run().count <= spu::kSkinMaxCorners) {
      parts_.back().window[0] = all.run();
      parts_.back().window[1] = {};
      return true;
    }
    const Run near = reach.near.run(), far = reach.far.run();
    if (reach.first_layer != reach.last_layer || near.count + far.count > spu::kSkinMaxCorners) return false;
    parts_.back().window[0] = near;
    parts_.back().window[1] = far;
    return true;
  }

  const Lattice<3>& lattice_;
  std::vector<SkinPart>& parts_;
  Reach reach_{};
};

/// The corner index that stands for a particle in a part that reads the particle.
std::uint16_t corner_index(const SkinPart& part, std::uint32_t particle) {
  const auto& [first, second] = part.window;
  const bool in_first = particle >= first.first_particle && particle - first.first_particle < first.count;
  SC_ASSERT(in_first || particle - second.first_particle < second.count,
            "particle {} is in no window of its part, {} from {} on and {} from {} on", particle, first.count,
            first.first_particle, second.count, second.first_particle);
  return static_cast<std::uint16_t>(in_first ? particle - first.first_particle
                                             : first.count + particle - second.first_particle);
}

/// Writes one vertex into one lane of a group.
void set_lane(spu::SkinGroup& group, std::size_t lane, const Vector3d& xi, const Eigen::Vector3f& normal) {
  SC_ASSERT(xi.minCoeff() >= 0 && xi.maxCoeff() <= 1, "a vertex at ({}, {}, {}) of its cell", xi.x(), xi.y(),
            xi.z());
  group.xi[lane] = static_cast<float>(xi.x());
  group.eta[lane] = static_cast<float>(xi.y());
  group.zeta[lane] = static_cast<float>(xi.z());
  group.normal_x[lane] = normal.x();
  group.normal_y[lane] = normal.y();
  group.normal_z[lane] = normal.z();
}

}  // namespace

Embedding embed(const TriangleMesh& mesh, const Lattice<3>& lattice) {
  return embed(mesh, locate_all(mesh, lattice), lattice);
}

Embedding embed(const TriangleMesh& mesh, std::span<const PlaceInCell> places, const Lattice<3>& lattice) {
  SC_ASSERT(mesh.normals.size() == mesh.positions.size() && places.size() == mesh.positions.size(),
            "{} positions with {} normals and {} places", mesh.positions.size(), mesh.normals.size(),
            places.size());
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return places[a].cell < places[b].cell; });

  Embedding embedding;
  embedding.mesh = mesh;
  embedding.slot_of_vertex.resize(places.size());
  std::vector<std::uint32_t> cell_of_group;
  PartCutter cutter(lattice, embedding.parts);
  for (std::size_t next = 0; next < order.size();) {
    const std::uint32_t cell = places[order[next]].cell;
    const auto number = static_cast<std::uint32_t>(embedding.groups.size());
    const bool begins_part = cutter.add(number, cell);
    spu::SkinGroup group{};
    group.continues[0] = !begins_part && cell_of_group.back() == cell ? 1 : 0;
    std::size_t used = 0;
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      if (next + used < order.size() && places[order[next + used]].cell == cell) {
        embedding.slot_of_vertex[order[next + used]] = 4 * number + lane;
        ++used;
      }
      SC_ASSERT(used > 0, "group {} of cell {} has no vertex", number, cell);
      // A group that is not full repeats its last vertex.
      const std::uint32_t vertex = order[next + used - 1];
      embedding.vertex_of_slot.push_back(vertex);
      set_lane(group, lane, places[vertex].xi, mesh.normals[vertex]);
    }
    next += used;
    embedding.groups.push_back(group);
    cell_of_group.push_back(cell);
  }

  SC_ASSERT(embedding.vertex_of_slot.size() == 4 * embedding.groups.size(), "{} slots in {} groups of four",
            embedding.vertex_of_slot.size(), embedding.groups.size());
  // The windows of a part are known only when the part is complete.
  for (const SkinPart& part : embedding.parts) {
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
      for (std::size_t k = 0; k < 8; ++k) {
        embedding.groups[g].corner[k] = corner_index(part, lattice.corners[cell_of_group[g]][k]);
      }
    }
  }
  embedding.indices.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) embedding.indices.push_back(embedding.slot_of_vertex[vertex]);
  }
  return embedding;
}

}  // namespace softcell::ppu
