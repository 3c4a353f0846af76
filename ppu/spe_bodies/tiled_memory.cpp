#include "ppu/spe_bodies/tiled_memory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ppu/plans/match_constants.h"
#include "ppu/spe_bodies/job_records.h"
#include "ppu/spe_bodies/match_orchestration.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

/// A buffer with a copy of `items`.
template <typename T>
dma::Buffer<T> copied(dma::AddressSpace& memory, const char* name, std::span<const T> items,
                      const dma::BufferOptions& options = of_floats(kSpesOnlyRead)) {
  dma::Buffer<T> buffer(memory, name, std::max<std::size_t>(1, items.size()), options);
  std::ranges::copy(items, buffer.span().begin());
  return buffer;
}

std::vector<spu::TileSlice> all_slices(const TilePlan& plan) {
  std::vector<spu::TileSlice> all;
  for (const TilePlan::Tile& tile : plan.tiles()) {
    all.insert(all.end(), tile.up.begin(), tile.up.end());
    all.insert(all.end(), tile.down.begin(), tile.down.end());
    all.insert(all.end(), tile.damp.begin(), tile.damp.end());
  }
  return all;
}

}  // namespace

TiledMemory::TiledMemory(dma::AddressSpace& memory, const TilePlan& plan)
    : body_(memory, "tiled body", 1, of_record(kTiledBodyRecord, kSpesOnlyRead)),
      lists_(copied(memory, "tiled lists", plan.lists(), of_record(plan.record_of_lists(), kSpesOnlyRead))),
      slices_(copied<spu::TileSlice>(memory, "tiled slices", all_slices(plan))),
      rest_(copied(memory, "tiled rest moments", plan.rest())),
      weights_(copied(memory, "tiled weights", plan.weights())),
      regions_(copied(memory, "tiled regions", plan.regions())),
      positions_(memory, "tiled positions", plan.places(), of_floats(kSpesOnlyRead)),
      velocities_(memory, "tiled velocities", plan.places(), of_floats()),
      pulled_(memory, "tiled particles between passes", plan.places() / 4, of_floats()),
      rotations_(memory, "tiled rotations", plan.region_places() / 4, of_floats()),
      next_rotations_(memory, "tiled rotations to be", plan.region_places() / 4, of_floats()),
      motions_(memory, "tiled motions", plan.region_places() * spu::kMatchSlotBytes, of_floats()),
      momenta_(memory, "tiled momenta", plan.region_places() / 4, of_floats()),
      reports_(memory, "tiled reports", plan.tiles().size(), of_floats()),
      jobs_(memory, "tiled jobs", kTilePasses.size() * plan.tiles().size(),
            of_record(kTileJobRecord, kSpesOnlyRead)) {
  spu::TiledBody& body = body_[0];
  body = plan.body();
  body.positions_ea = positions_.ea().value;
  body.velocities_ea = velocities_.ea().value;
  body.pulled_ea = pulled_.ea().value;
  body.motions_ea = motions_.ea().value;
  body.momenta_ea = momenta_.ea().value;
  body.reports_ea = reports_.ea().value;
  body.lists_ea = lists_.ea().value;
  body.rest_ea = rest_.ea().value;
  body.weights_ea = weights_.ea().value;
  body.regions_ea = regions_.ea().value;

  std::size_t first_slice = 0;
  for (std::uint32_t tile = 0; tile < plan.tiles().size(); ++tile) {
    // A tile without regions of its own, or without particles, never reports.
    reports_[tile].positions_finite = reports_[tile].velocities_finite = 1;
    const TilePlan::Tile& slices = plan.tiles()[tile];
    const auto add_job = [&](spu::TilePass pass, const std::vector<spu::TileSlice>& of_pass) {
      spu::TileJob& job = jobs_[pass * plan.tiles().size() + tile];
      job = {};
      job.body_ea = body_.ea().value;
      job.slices_ea = slices_.ea(of_pass.empty() ? 0 : first_slice).value;
      job.slice_count = static_cast<std::uint32_t>(of_pass.size());
      job.tile = tile;
      job.pass = pass;
    };
    add_job(spu::kTileGather, slices.up);
    add_job(spu::kTileTwist, slices.up);
    first_slice += slices.up.size();
    add_job(spu::kTileScatter, slices.down);
    first_slice += slices.down.size();
    add_job(spu::kTileDamp, slices.damp);
    first_slice += slices.damp.size();
  }
  SC_ASSERT(first_slice <= slices_.size(), "jobs of {} slices of {}", first_slice, slices_.size());
  reset();
}

std::optional<dma::EffectiveAddress> TiledMemory::job(spu::TilePass pass, std::size_t tile) const {
  SC_ASSERT(pass < kTilePasses.size() && tile < tiles(), "pass {} of tile {} of {}", pass, tile, tiles());
  const std::size_t number = pass * tiles() + tile;
  const bool damped = body_.data()[0].damping > 0;
  if (jobs_.data()[number].slice_count == 0 || (pass == spu::kTileTwist && !damped)) return std::nullopt;
  return jobs_.ea(number);
}

void TiledMemory::add_jobs(JobChain& chain, const JobImage& match_tiles, spu::TilePass pass) const {
  for (std::size_t tile = 0; tile < tiles(); ++tile)
    if (const auto argp = job(pass, tile)) chain.add({.image = match_tiles, .argp = *argp});
}

float TiledMemory::residual() const {
  float largest = 0;
  for (const spu::TileReport& report : reports_.span()) largest = std::max(largest, report.residual_square);
  return std::sqrt(largest);
}

void TiledMemory::reset() {
  std::ranges::fill(rotations_.span(),
                    spu::MatchRotations{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 1}});
  body_[0].cold = 1;
}

void TiledMemory::set_rest(const TilePlan& plan, const MatchingPlan<float, 3>& matching) {
  SC_ASSERT(
      plan.place_of().size() == matching.particles() && plan.place_of_region().size() == matching.regions(),
      "a rest shape of {} particles and {} regions in a plan of {} and {}", matching.particles(),
      matching.regions(), plan.place_of().size(), plan.place_of_region().size());
  for (std::size_t i = 0; i < matching.particles(); ++i) {
    const std::uint32_t place = plan.place_of()[i];
    std::ranges::copy(rest_moment(matching.particle_constants()[i]), rest_[place / 4].rest_moment[place % 4]);
  }
  for (std::size_t r = 0; r < matching.regions(); ++r) {
    const std::uint32_t place = plan.place_of_region()[r];
    set_centre(regions_[place / 4], place % 4, matching.region_constants()[r]);
  }
}

RegionRotations TiledMemory::region_rotations(const TilePlan& plan, const SumPlan& sums) {
  SC_ASSERT(plan.place_of_region().size() == sums.regions(), "places of {} regions of {}",
            plan.place_of_region().size(), sums.regions());
  std::vector<std::uint32_t> place_of;
  for (const std::uint32_t region : sums.region_of()) place_of.push_back(plan.place_of_region()[region]);
  return {rotations_.span(), std::move(place_of), body_[0].cold};
}

void TiledMemory::begin_step(const MatchSettings& settings) {
  validate(settings);
  spu::TiledBody& body = body_[0];
  body.pull = settings.pull;
  body.damping = settings.damping;
  body.least_iterations = settings.least_iterations;
  body.most_iterations = settings.most_iterations;
  body.rotations_in_ea = rotations_.ea().value;
  body.rotations_out_ea = next_rotations_.ea().value;
}

void TiledMemory::end_step() {
  for (const spu::TileReport& report : reports_.span())
    if (report.positions_finite == 0 || report.velocities_finite == 0)
      throw std::runtime_error("a soft body has positions or velocities that are not finite numbers");
  std::swap(rotations_, next_rotations_);
  body_[0].cold = 0;
}

}  // namespace softcell::ppu
