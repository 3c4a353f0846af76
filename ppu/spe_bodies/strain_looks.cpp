#include "ppu/spe_bodies/strain_looks.h"

#include <cmath>
#include <utility>

#include "ppu/fracture/cracks.h"
#include "ppu/matching/plastic_flow.h"
#include "ppu/matching/rest_lattice.h"
#include "ppu/spe_bodies/job_records.h"
#include "ppu/spe_bodies/match_orchestration.h"
#include "softcell/base/assert.h"
#include "sum_list_job.h"

namespace softcell::ppu {
namespace {

/// A look at fewer particles takes less time than handing it over, which takes some microseconds.
constexpr std::size_t kLeastParticles = 128;

/// Corner k of the four of a face across `axis`, in the cell on side `side`. In two dimensions each corner appears twice.
template <int kDimension>
unsigned corner_of_face(unsigned axis, unsigned side, unsigned k) {
  unsigned corner = side << axis, bit = 0;
  for (unsigned other = 0; other < kDimension; ++other)
    if (other != axis) corner |= (k >> bit++ & 1u) << other;
  return corner;
}

}  // namespace

template <int kDimension>
bool StrainLooks<kDimension>::can_look_at(const Model& model, std::size_t places) {
  return model.particles() >= kLeastParticles && places <= spu::kStrainMaxParticles;
}

template <int kDimension>
StrainLooks<kDimension>::StrainLooks(dma::AddressSpace& memory, std::shared_ptr<const Model> model,
                                     std::span<const std::uint32_t> place_of, std::size_t places,
                                     std::size_t bodies)
    : memory_(memory),
      model_(std::move(model)),
      place_of_(place_of.begin(), place_of.end()),
      places_(static_cast<std::uint32_t>(places)),
      jobs_(memory, "strain jobs", bodies, of_record(kStrainJobRecord, kSpesOnlyRead)),
      results_(memory, "strain results", bodies, of_record(kStrainResultRecord)) {
  SC_ASSERT(can_look_at(*model_, places), "looks at bodies of {} particles in {} places", model_->particles(),
            places);
  SC_ASSERT(place_of_.empty() || place_of_.size() == model_->particles(), "{} places of {} particles",
            place_of_.size(), model_->particles());
}

template <int kDimension>
std::uint16_t StrainLooks<kDimension>::place_of(std::uint32_t particle) const {
  return static_cast<std::uint16_t>(place_of_.empty() ? particle : place_of_[particle]);
}

/// Leaves out faces that are broken already, and those that never break.
template <int kDimension>
void StrainLooks<kDimension>::write_faces() {
  has_faces_ = true;
  const BreakableFaces& cracks = model_->cracks();
  std::vector<std::uint32_t> breakable;
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f)
    if (!cracks.is_broken[f] && std::isfinite(cracks.strength[f])) breakable.push_back(f);
  if (breakable.empty()) return;
  faces_ = {memory_, "strain faces", spu::groups_of(static_cast<std::uint32_t>(breakable.size())),
            of_record(kStrainFacesRecord, kSpesOnlyRead)};
  const auto& corners = model_->lattice().corners;
  for (std::size_t i = 0; i < breakable.size(); ++i) {
    const auto& [low, high, axis] = cracks.faces[breakable[i]];
    spu::StrainFaces& group = faces_[i / 4];
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned lower = corner_of_face<kDimension>(axis, 0, k),
                     upper = corner_of_face<kDimension>(axis, 1, k);
      SC_ASSERT(corners[low][upper] == corners[high][lower],
                "particles {} and {} at a corner of face {}, which is whole", corners[low][upper],
                corners[high][lower], breakable[i]);
      group.low[i % 4][k] = place_of(corners[low][lower]);
      group.between[i % 4][k] = place_of(corners[low][upper]);
      group.high[i % 4][k] = place_of(corners[high][upper]);
    }
    group.strength[i % 4] = cracks.strength[breakable[i]];
  }
}

template <int kDimension>
void StrainLooks<kDimension>::write_lengths(const Body& body) {
  const RestLattice<kDimension>& lattice = *model_->rest_lattice();
  const auto edges = static_cast<std::uint32_t>(lattice.edges().size()),
             lengths = static_cast<std::uint32_t>(lattice.lengths());
  edge_groups_ = spu::groups_of(edges);
  if (lengths_.size() == 0)
    lengths_ = {memory_, "strain lengths", edge_groups_ + spu::groups_of(lengths - edges),
                of_record(kStrainLengthsRecord, kSpesOnlyRead)};
  const std::span<const typename Body::Vector> own = body.own_rest();
  const auto rest = [&](std::uint32_t particle) {
    return own.empty() ? model_->lattice().rest_position(particle) : own[particle];
  };
  const auto write = [&](std::size_t place, std::uint32_t a, std::uint32_t b, float inverse_square) {
    spu::StrainLengths& group = lengths_[place / 4];
    group.from[place % 4] = place_of(a);
    group.to[place % 4] = place_of(b);
    group.inverse_square[place % 4] = inverse_square;
  };
  std::uint32_t n = 0;
  lattice.each_length([&](std::uint32_t a, std::uint32_t b) {
    const float inverse_square = 1 / (rest(b) - rest(a)).squaredNorm();
    const std::uint32_t place = n < edges ? n : 4 * edge_groups_ + (n - edges);
    ++n;
    const bool is_last = n == edges || n == lengths;
    const std::uint32_t end = is_last ? 4 * spu::groups_of(place + 1) : place + 1;
    for (std::uint32_t i = place; i < end; ++i) write(i, a, b, inverse_square);
  });
  rest_of_lengths_ = body.rest_revision();
}

/// A rest shape that has just changed is likely to change again, so its distances are written only at the second look at it.
template <int kDimension>
bool StrainLooks<kDimension>::has_lengths_of(const Body& body) {
  if (rest_of_lengths_ == body.rest_revision()) return true;
  const bool again = std::exchange(seen_rest_, body.rest_revision()) == body.rest_revision();
  if (again) write_lengths(body);
  return again;
}

template <int kDimension>
std::optional<dma::EffectiveAddress> StrainLooks<kDimension>::job(std::size_t number, const Body& body,
                                                                  dma::EffectiveAddress positions) {
  SC_ASSERT(number < jobs_.size() && body.shared_model() == model_, "body {} of {}", number, jobs_.size());
  const std::optional<Fracture>& fracture = body.settings().fracture;
  const bool at_faces = fracture && !body.settings().plasticity && !body.has_own_rest();
  const bool at_lengths = body.will_look() && has_lengths_of(body);
  if (at_faces && !has_faces_) write_faces();
  spu::StrainJob& job = jobs_[number];
  job = {};
  job.positions_ea = positions.value;
  job.result_ea = results_.ea(number).value;
  job.particles = places_;
  job.flat = kDimension == 2 ? 1 : 0;
  if (at_lengths) {
    job.lengths_ea = lengths_.ea().value;
    job.edge_groups = edge_groups_;
    job.diagonal_groups = static_cast<std::uint32_t>(lengths_.size()) - edge_groups_;
  }
  if (at_faces && faces_.size() != 0) {
    job.faces_ea = faces_.ea().value;
    job.face_groups = static_cast<std::uint32_t>(faces_.size());
    job.spacing = model_->lattice().spacing;
    job.stretch = fracture->stretch.value_or(spu::kStrainNever);
    job.turn = fracture->turn.value_or(spu::kStrainNever);
  }
  // A face that no job looks at may have broken.
  results_[number] = {.edges = 0, .diagonals = 0, .faces = at_faces ? 0u : 1u, .pad = 0};
  if (job.edge_groups + job.diagonal_groups + job.face_groups == 0) return std::nullopt;
  return jobs_.ea(number);
}

template <int kDimension>
bool StrainLooks<kDimension>::may_break(std::size_t number) const {
  SC_ASSERT(number < results_.size(), "body {} of {}", number, results_.size());
  return results_[number].faces != 0;
}

template <int kDimension>
std::optional<float> StrainLooks<kDimension>::stretch(std::size_t number) const {
  SC_ASSERT(number < results_.size(), "body {} of {}", number, results_.size());
  if (jobs_[number].diagonal_groups == 0) return std::nullopt;
  return PlasticFlow<kDimension>::stretch_of(results_[number].edges, results_[number].diagonals);
}

template class StrainLooks<2>;
template class StrainLooks<3>;

}  // namespace softcell::ppu
