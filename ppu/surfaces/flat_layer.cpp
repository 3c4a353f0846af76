#include "ppu/surfaces/flat_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "ppu/fracture/cracks.h"
#include "ppu/lattice/cells_by_index.h"
#include "ppu/lattice/outline_distance.h"
#include "ppu/surfaces/crack_sides.h"
#include "ppu/surfaces/point_chooser.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector2f;
using Eigen::Vector2i;
using Eigen::Vector3f;

Skin2d touching_skin(const SoftBodyModel<2>& model) {
  if (model.is_piece())
    return skin_of_piece(touching_skin(*model.whole()), model.whole()->lattice(), model.lattice());
  return make_skin_2d(model.lattice(),
                      std::min(model.contact_radius() / model.lattice().spacing, kMaxSkinMargin));
}

/// Builds the layer. The body's cells come first, so that a place both in one of them and in a margin cell is found in the body's cell.
class FlatLayer::Maker {
 public:
  Maker(const SoftBodyModel<2>& model, const Skin2d& skin)
      : model_(model), flat_(model.lattice()), skin_(skin), outline_(skin) {
    lattice->spacing = flat_.spacing;
    lattice->origin << flat_.origin, -0.5f * flat_.spacing;
    for (const Vector2i& particle : flat_.particles) add_column(particle);
    for (std::size_t c = 0; c < flat_.cells.size(); ++c) {
      add_cell(flat_.cells[c], flat_.corners[c]);
      margin_cells.push_back({static_cast<std::uint32_t>(c), Vector3f::Zero()});
      fields.push_back(field_of(flat_.cells[c]));
    }
    add_margin_cells();
    place_points();
  }

  std::vector<float> masses() const {
    std::vector<float> masses;
    for (const float mass : model_.masses()) masses.insert(masses.end(), 2, mass / 2);
    masses.resize(lattice->particles.size(), 0.0f);
    return masses;
  }

  std::vector<std::uint32_t> sides() const {
    if (!model_.is_piece()) return {};
    std::vector<std::uint32_t> sides = ppu::crack_sides(flat_, model_.cracks());
    if (!sides.empty()) sides.resize(lattice->cells.size(), 0u);
    return sides;
  }

  std::shared_ptr<Lattice<3>> lattice = std::make_shared<Lattice<3>>();
  std::vector<SurfacePointAtRest> points;
  std::vector<ContactSurface::CellField> fields;
  std::vector<MarginCell> margin_cells;
  std::vector<CellPoint2d> beyond;
  std::vector<std::uint32_t> first_beyond{0};

 private:
  struct GridOrder {
    bool operator()(const Vector2i& a, const Vector2i& b) const {
      return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    }
  };

  std::uint32_t add_column(const Vector2i& at) {
    for (int z = 0; z < 2; ++z) lattice->particles.emplace_back(at.x(), at.y(), z);
    return static_cast<std::uint32_t>(lattice->particles.size() / 2 - 1);
  }

  void add_cell(const Vector2i& at, const std::array<std::uint32_t, 4>& columns) {
    lattice->cells.emplace_back(at.x(), at.y(), 0);
    auto& corners = lattice->corners.emplace_back();
    for (std::size_t k = 0; k < corners.size(); ++k)
      corners[k] = 2 * columns[k & 3u] + static_cast<std::uint32_t>(k >> 2);
  }

  /// Distances are the same all through the layer.
  ContactSurface::CellField field_of(const Vector2i& cell) const {
    constexpr int kNodes = ContactSurface::kNodesPerEdge;
    ContactSurface::CellField field{};
    for (int y = 0; y < kNodes; ++y)
      for (int x = 0; x < kNodes; ++x) {
        const Vector2f at =
            cell.cast<float>() + 0.5f * Vector2f(static_cast<float>(x), static_cast<float>(y));
        const float distance = outline_.signed_distance(at);
        for (int z = 0; z < kNodes; ++z)
          field[static_cast<std::size_t>((z * kNodes + y) * kNodes + x)] = distance;
      }
    return field;
  }

  /// Adds cells beside the body's cells where its shape reaches. A margin cell moves with the cell that shares an edge with it, or else a
  /// corner.
  void add_margin_cells() {
    constexpr std::array<std::array<int, 2>, 8> kAround{
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
    const CellsByIndex cells(flat_);
    std::map<Vector2i, std::uint32_t, GridOrder> beside;
    for (const auto& off : kAround)
      for (std::uint32_t c = 0; c < flat_.cells.size(); ++c) {
        const Vector2i at = flat_.cells[c] + Vector2i(off[0], off[1]);
        if (!cells.has(at)) beside.emplace(at, c);
      }
    for (const auto& [at, cell] : beside) {
      const ContactSurface::CellField field = field_of(at);
      if (!(*std::ranges::min_element(field) < kNothingThere)) continue;
      margin_cells.push_back({cell, lifted(at - flat_.cells[cell])});
      margin_at_.emplace(at, static_cast<std::uint32_t>(lattice->cells.size()));
      fields.push_back(field);
      std::array<std::uint32_t, 4> columns{};
      for (int k = 0; k < 4; ++k)
        columns[static_cast<std::size_t>(k)] = column_of(at + Vector2i(k & 1, k >> 1), cell);
      add_cell(at, columns);
    }
    for (const auto& column : columns_) {
      for (const Hanging& hanging : column) beyond.push_back(hanging.place);
      first_beyond.push_back(static_cast<std::uint32_t>(beyond.size()));
    }
  }

  static Vector3f lifted(const Vector2i& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), 0};
  }

  /// A corner of a margin cell: a particle of the body where there is one, else a place beyond the cell beside.
  std::uint32_t column_of(const Vector2i& at, std::uint32_t beside) {
    const Vector2i off = at - flat_.cells[beside];
    if ((off.array() >= 0).all() && (off.array() <= 1).all())
      return flat_.corners[beside][static_cast<std::size_t>(off.x() + 2 * off.y())];
    if (const auto own = std::ranges::find(flat_.particles, at); own != flat_.particles.end())
      return static_cast<std::uint32_t>(own - flat_.particles.begin());
    const auto [entry, is_new] = beyond_at_.try_emplace(at, columns_.size());
    if (is_new) {
      add_column(at);
      columns_.emplace_back();
    }
    std::vector<Hanging>& column = columns_[entry->second];
    const auto hangs_there = [&](const Hanging& hanging) { return hanging.cell == beside; };
    if (std::ranges::none_of(column, hangs_there))
      column.push_back({beside, point_in_cell(flat_, beside, at.cast<float>())});
    return static_cast<std::uint32_t>(flat_.particles.size() + entry->second);
  }

  /// Places points along the outlines and at each particle: particles may be all that is left between two sides of a crushed body.
  void place_points() {
    PointChooser chooser(1);
    for (const auto& loop : skin_.outlines)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t vertex = loop[i];
        const Vector2f along =
            skin_.rest[loop[(i + 1) % loop.size()]] - skin_.rest[loop[(i + loop.size() - 1) % loop.size()]];
        const Vector2f at = skin_.rest[vertex], normal = Vector2f(along.y(), -along.x()).normalized();
        if (chooser.choose({at.x(), at.y(), 0}, {normal.x(), normal.y(), 0}))
          add_point(at, cell_of(at, skin_.vertex_cells[vertex]));
      }
    std::vector<bool> is_placed(flat_.particles.size());
    for (std::uint32_t c = 0; c < flat_.cells.size(); ++c)
      for (const std::uint32_t particle : flat_.corners[c]) {
        if (is_placed[particle]) continue;
        is_placed[particle] = true;
        add_point(flat_.particles[particle].cast<float>(), c);
      }
    std::ranges::stable_sort(points, {}, &SurfacePointAtRest::cell);
  }

  /// The cell of the layer that a place of the surface is in. @param near  the body's nearest cell
  std::uint32_t cell_of(const Vector2f& at, std::uint32_t near) const {
    constexpr float kTolerance = 1e-4f;
    const Vector2f in = at - flat_.cells[near].cast<float>();
    if ((in.array() >= -kTolerance).all() && (in.array() <= 1 + kTolerance).all()) return near;
    for (const float nudge : {0.0f, -kTolerance, kTolerance}) {
      const Vector2i square = (at.array() + nudge).floor().matrix().cast<int>();
      if (const auto margin = margin_at_.find(square); margin != margin_at_.end()) return margin->second;
    }
    return near;
  }

  void add_point(const Vector2f& at, std::uint32_t cell) {
    SurfacePointAtRest& point = points.emplace_back();
    point.cell = cell;
    const Vector2f in = (at - lattice->cells[cell].head<2>().cast<float>()).cwiseMax(0.0f).cwiseMin(1.0f);
    point.xi = {in.x(), in.y(), 0.5f};
    const Vector2f rest = flat_.origin + flat_.spacing * at;
    point.rest = {rest.x(), rest.y(), 0};
  }

  /// A cell that a place beyond the body's cells moves with, and the place as a mix of this cell's corners.
  struct Hanging {
    std::uint32_t cell;
    CellPoint2d place;
  };
  /// Every place of a cell is nearer than this, in cells, to one of the cell's nodes.
  static constexpr float kNothingThere = 0.36f;

  const SoftBodyModel<2>& model_;
  const Lattice<2>& flat_;
  const Skin2d& skin_;
  OutlineDistance outline_;
  std::map<Vector2i, std::uint32_t, GridOrder> margin_at_;
  std::map<Vector2i, std::size_t, GridOrder> beyond_at_;  // index into `columns_`
  std::vector<std::vector<Hanging>> columns_;
};

FlatLayer::FlatLayer(const SoftBodyModel<2>& model, const Skin2d& skin) : FlatLayer(Maker(model, skin)) {}

FlatLayer::FlatLayer(Maker maker)
    : lattice_(maker.lattice),
      surface_(std::move(maker.points), std::move(maker.fields)),
      masses_(maker.masses()),
      margin_cells_(std::move(maker.margin_cells)),
      crack_sides_(maker.sides()),
      beyond_(std::move(maker.beyond)),
      first_beyond_(std::move(maker.first_beyond)) {}

std::size_t FlatLayer::own_cells() const {
  std::size_t own = 0;
  while (own < margin_cells_.size() && margin_cells_[own].beside == own) ++own;
  return own;
}

void FlatLayer::lift(std::span<const Vector2f> flat, float half, std::vector<Vector3f>& lifted) const {
  const std::size_t columns = lattice_->particles.size() / 2;
  SC_ASSERT(flat.size() + first_beyond_.size() - 1 == columns,
            "{} particles and {} places beyond of {} columns", flat.size(), first_beyond_.size() - 1,
            columns);
  lifted.clear();
  lifted.reserve(2 * columns);
  const auto add = [&](const Vector2f& v) {
    lifted.emplace_back(v.x(), v.y(), -half);
    lifted.emplace_back(v.x(), v.y(), half);
  };
  for (const Vector2f& v : flat) add(v);
  for (std::size_t i = 0; i + 1 < first_beyond_.size(); ++i) {
    Vector2f sum = Vector2f::Zero();
    for (std::uint32_t k = first_beyond_[i]; k < first_beyond_[i + 1]; ++k)
      for (std::size_t corner = 0; corner < 4; ++corner)
        sum += beyond_[k].share[corner] * flat[beyond_[k].corner[corner]];
    add(sum / static_cast<float>(first_beyond_[i + 1] - first_beyond_[i]));
  }
}

}  // namespace softcell::ppu
