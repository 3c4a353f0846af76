#include "ppu/plans/tile_scheduler.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "ppu/plans/slot_blocks.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

std::uint32_t TileLists::add(std::vector<std::uint32_t> words, std::uint32_t offsets) {
  words.resize((words.size() + 3) / 4 * 4);
  SC_ASSERT(offsets % 4 == 0 && offsets <= words.size(), "{} words of {} are offsets", offsets, words.size());
  const auto [known, is_new] =
      known_.try_emplace({offsets, words}, static_cast<std::uint32_t>(4 * words_.size()));
  if (is_new) {
    words_.insert(words_.end(), words.begin(), words.end());
    extend_record(offsets, 4);
    extend_record(static_cast<std::uint32_t>(words.size()) - offsets, 2);
  }
  return known->second;
}

void TileLists::extend_record(std::uint32_t words, std::uint32_t element_bytes) {
  if (words == 0) return;
  if (!record_.empty() && record_.back().element_bytes == element_bytes)
    record_.back().bytes += 4 * words;
  else
    record_.push_back({4 * words, element_bytes});
}

TileScheduler::TileScheduler(const Lattice<3>& lattice, const SumPlan& sums, int half_width,
                             const LatticeSums& order, const TileGrid& grid, const TilePlaces& particles,
                             const TilePlaces& regions)
    : lattice_(lattice),
      sums_(sums),
      half_width_(half_width),
      order_(order),
      grid_(grid),
      particles_(particles),
      regions_(regions),
      plane_of_particle_(1, 0),
      plane_of_region_(1, 0),
      plane_of_bar_(1, 0),
      plane_of_plate_(1, 0),
      ready_(1, 0) {
  SC_ASSERT(half_width >= 0 && order.home.size() == sums.regions(),
            "regions of half-width {}, the lowest particles of {} of {}", half_width, order.home.size(),
            sums.regions());
  for (std::uint32_t i = 0; i < lattice.particles.size(); ++i) {
    plane_of_particle_.push_back(lattice.particles[i].x());
    particles_of_tile_[grid.tile_of(lattice.particles[i])].push_back(i);
  }
  for (std::uint32_t r = 0; r < sums.regions(); ++r)
    regions_of_tile_[grid.tile_of(lattice.particles[order.home[r]])].push_back(r);
  for (std::uint32_t slot = 1; slot <= order.regions.size(); ++slot) {
    plane_of_region_.push_back(lattice.particles[order.home[order.region_at_slot[slot]]].x());
    ready_.push_back(plane_of_region_.back() + half_width);
  }
  for (std::size_t bar = 0; bar < order.bars_of_particles.size(); ++bar)
    plane_of_bar_.push_back(plane_of_particle_[order.bars_of_particles.terms[bar][0]]);
  for (std::size_t plate = 0; plate < order.plates.size(); ++plate)
    plane_of_plate_.push_back(plane_of_bar_[order.plates.terms[plate][0]]);

  const std::size_t bars = plane_of_bar_.size(), plates = plane_of_plate_.size(), ready = ready_.size();
  const std::array sizes{std::max(plane_of_particle_.size(), ready), bars, plates, ready};
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    mark_[kind].resize(sizes[kind]);
    local_[kind].resize(sizes[kind]);
  }
}

const SumLevel& TileScheduler::level(int kind) const {
  if (kind == kRegion) return order_.regions;
  if (kind == kPlate) return order_.plates;
  return direction_ == Direction::kUp ? order_.bars_of_particles : order_.bars_of_regions;
}

void TileScheduler::start(Direction direction) {
  direction_ = direction;
  times_ = {direction == Direction::kUp ? &plane_of_particle_ : &plane_of_region_, &plane_of_bar_,
            &plane_of_plate_, &ready_};
  for (Slots& slots : needed_) slots.clear();
  slices_.clear();
  ++epoch_;
}

/// Marks a value, and those before it in its chain, as needed.
void TileScheduler::require(int kind, std::uint32_t slot) {
  SC_ASSERT(slot < mark_[kind].size(), "slot {} of {} of kind {}", slot, mark_[kind].size(), kind);
  while (mark_[kind][slot] != epoch_) {
    mark_[kind][slot] = epoch_;
    needed_[kind].push_back(slot);
    if (kind == kInput || !level(kind).rules[slot - 1].follows) return;
    --slot;
  }
}

/// Visits the terms of a sum, without the sum before it in its chain.
template <typename Visit>
void TileScheduler::visit_terms(int kind, std::uint32_t slot, const Visit& visit) const {
  SC_ASSERT(kind > kInput && slot > 0 && slot <= level(kind).rules.size(), "sum {} of {} of kind {}", slot,
            level(kind).rules.size(), kind);
  const SumLevel::Rule& rule = level(kind).rules[slot - 1];
  if (!rule.follows) {
    for (const std::uint32_t term : level(kind).terms[slot - 1]) visit(term);
    return;
  }
  if (rule.joins != 0) visit(rule.joins);
  if (rule.leaves != 0) visit(rule.leaves);
}

TileScheduler::Slice& TileScheduler::slice_at(int time) {
  SC_ASSERT(time >= first_time_ && time - first_time_ < std::ssize(slices_),
            "time {} in {} slices from {} on", time, slices_.size(), first_time_);
  return slices_[static_cast<std::size_t>(time - first_time_)];
}

/// Finds every value from which the tile's regions, or its particles' totals, are computed, and sorts them into the
/// slices of their times.
void TileScheduler::collect(std::pair<int, int> tile) {
  int last_time = std::numeric_limits<int>::min();
  if (direction_ == Direction::kUp) {
    for (const std::uint32_t r : regions_of_tile_[tile]) require(kRegion, order_.region_slot[r]);
  } else {
    for (const std::uint32_t i : particles_of_tile_[tile]) {
      require(kRegion, order_.region_slot[sums_.region_of()[i]]);
      last_time = std::max(last_time, lattice_.particles[i].x() + half_width_);
    }
  }
  for (int kind = kRegion; kind > kInput; --kind)
    for (std::size_t n = 0; n < needed_[static_cast<std::size_t>(kind)].size(); ++n)
      visit_terms(kind, needed_[static_cast<std::size_t>(kind)][n],
                  [&](std::uint32_t term) { require(kind - 1, term); });

  first_time_ = std::numeric_limits<int>::max();
  for (int kind = 0; kind < kKinds; ++kind) {
    Slots& slots = needed_[static_cast<std::size_t>(kind)];
    std::ranges::sort(slots);
    for (const std::uint32_t slot : slots) {
      first_time_ = std::min(first_time_, time_of(kind, slot));
      last_time = std::max(last_time, time_of(kind, slot));
    }
  }
  if (last_time < first_time_) return;
  slices_.resize(static_cast<std::size_t>(last_time - first_time_) + 1);
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    for (const std::uint32_t slot : needed_[kind])
      slice_at(time_of(static_cast<int>(kind), slot)).blocks[kind].slots.push_back(slot);
}

/// Finds the stretches of places that each slice fetches and writes. Blocks of inputs and, upwards, of regions are in the order of places.
void TileScheduler::place_outputs(std::pair<int, int> tile) {
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    Slice& slice = slices_[n];
    Block& inputs = slice.blocks[kInput];
    const auto place_of_input = [&](std::uint32_t slot) {
      return direction_ == Direction::kUp ? particles_.place_of(slot - 1)
                                          : regions_.place_of(order_.region_at_slot[slot]);
    };
    if (!inputs.slots.empty()) {
      std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
      for (const std::uint32_t slot : inputs.slots) {
        low = std::min(low, place_of_input(slot));
        high = std::max(high, place_of_input(slot));
      }
      slice.first_place = low / 4 * 4;
      slice.last_place = high / 4 * 4 + 4;
      inputs.size = slice.last_place - slice.first_place;
    }

    const int plane = first_time_ + static_cast<int>(n) - half_width_;  // complete at this time
    Block& regions = slice.blocks[kRegion];
    if (grid_.tile_of({plane, 0, 0}).first == tile.first)
      slice.output = (direction_ == Direction::kUp ? regions_ : particles_).stretch(plane, tile.second);
    if (direction_ == Direction::kUp) {
      Slots ordered;
      for (std::uint32_t place = slice.output.begin; place < slice.output.end; ++place) {
        const bool padding = regions_.at(place) == TilePlaces::kPadding;
        ordered.push_back(padding ? 0 : order_.region_slot[regions_.at(place)]);
      }
      for (const std::uint32_t slot : regions.slots)  // which others follow, outside of the tile
        if (std::ranges::find(ordered, slot) == ordered.end()) ordered.push_back(slot);
      regions.slots = std::move(ordered);
    }
    for (const int kind : {kBar, kPlate, kRegion}) {
      Block& block = slice.blocks[static_cast<std::size_t>(kind)];
      block.size = static_cast<std::uint32_t>(block.slots.size());
    }
  }
}

void TileScheduler::find_lifetimes() {
  const auto used = [&](int kind, std::uint32_t slot, int time) {
    int& last = slice_at(time_of(kind, slot)).blocks[static_cast<std::size_t>(kind)].last_use;
    last = std::max(last, time);
  };
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    const int time = first_time_ + static_cast<int>(n);
    for (Block& block : slices_[n].blocks) block.last_use = std::max(block.last_use, time);
    for (const int kind : {kBar, kPlate, kRegion}) {
      for (const std::uint32_t slot : slices_[n].blocks[static_cast<std::size_t>(kind)].slots) {
        if (slot == 0) continue;
        visit_terms(kind, slot, [&](std::uint32_t term) { used(kind - 1, term, time); });
        if (level(kind).rules[slot - 1].follows) used(kind, slot - 1, time);
      }
    }
    if (direction_ == Direction::kUp) continue;
    for (std::uint32_t place = slices_[n].output.begin; place < slices_[n].output.end; ++place)
      if (particles_.at(place) != TilePlaces::kPadding)
        used(kRegion, order_.region_slot[sums_.region_of()[particles_.at(place)]], time);
  }
}

void TileScheduler::allocate_slots() {
  SlotBlocks free;
  const auto allocate = [&](Block& block) { block.begin = free.allocate(block.size, block.last_use); };
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    free.free_before(first_time_ + static_cast<int>(n));
    // Motions are fetched into their slots while the previous slice is being computed.
    const bool early = direction_ == Direction::kDown;
    if (!early || n == 0) allocate(slices_[n].blocks[kInput]);
    if (early && n + 1 < slices_.size()) allocate(slices_[n + 1].blocks[kInput]);
    for (const int kind : {kBar, kPlate, kRegion})
      allocate(slices_[n].blocks[static_cast<std::size_t>(kind)]);
  }
  for (const Slice& slice : slices_) {
    const Block& inputs = slice.blocks[kInput];
    for (const std::uint32_t slot : inputs.slots)
      local_[kInput][slot] = inputs.begin +
                             (direction_ == Direction::kUp ? particles_.place_of(slot - 1)
                                                           : regions_.place_of(order_.region_at_slot[slot])) -
                             slice.first_place;
    for (const std::size_t kind : {std::size_t{kBar}, std::size_t{kPlate}, std::size_t{kRegion}})
      for (std::uint32_t k = 0; k < slice.blocks[kind].size; ++k)
        local_[kind][slice.blocks[kind].slots[k]] = slice.blocks[kind].begin + k;
  }
  spu::TileLimits& limits = limits_[direction_ == Direction::kDown ? 1 : 0];
  limits.slots = std::max(limits.slots, free.most());
}

void TileScheduler::append_list(int kind, const Block& block, std::vector<std::uint16_t>& out) const {
  const SumLevel& sums = level(kind);
  const auto offset = [&](int of, std::uint32_t slot) {
    return sum_list_offset(local(of, slot), slot_bytes_);
  };
  SumListWriter writer;
  std::vector<std::uint16_t> terms;
  std::uint32_t previous = 0;
  for (const std::uint32_t slot : block.slots) {
    const SumLevel::Rule rule = slot == 0 ? SumLevel::Rule{} : sums.rules[slot - 1];
    if (!rule.follows) {
      terms.clear();
      if (slot != 0) {  // padding is nothing
        for (const std::uint32_t term : sums.terms[slot - 1]) terms.push_back(offset(kind - 1, term));
      }
      writer.begin(terms);
    } else {
      const std::uint16_t joins = offset(kind - 1, rule.joins), leaves = offset(kind - 1, rule.leaves);
      if (writer.follows_chain() && previous + 1 == slot)
        writer.follow(joins, leaves);
      else
        writer.go_on(offset(kind, slot - 1), joins, leaves);
    }
    previous = slot;
  }
  const std::vector<std::uint16_t> list = writer.finish().halfwords;
  out.insert(out.end(), list.begin(), list.end());
}

spu::TileSlice TileScheduler::written(const Slice& slice) {
  SC_ASSERT(slice.blocks[kInput].size % 4 == 0 && (slice.output.end - slice.output.begin) % 4 == 0,
            "a slice fetches {} places and writes {}, which are not multiples of 4",
            slice.blocks[kInput].size, slice.output.end - slice.output.begin);
  spu::TileSlice result{};
  result.input = slice.first_place;
  result.input_groups = slice.blocks[kInput].size / 4;
  result.input_slot = slice.blocks[kInput].begin;
  result.bars_slot = slice.blocks[kBar].begin;
  result.plates_slot = slice.blocks[kPlate].begin;
  result.sums_slot = slice.blocks[kRegion].begin;
  result.output = slice.output.begin;
  result.output_groups = (slice.output.end - slice.output.begin) / 4;

  std::vector<std::uint32_t> words;
  if (direction_ == Direction::kDown) {
    for (std::uint32_t place = slice.output.begin; place < slice.output.end; ++place) {
      const std::uint32_t i = particles_.at(place);
      words.push_back(
          i == TilePlaces::kPadding
              ? 0
              : sum_list_offset(local(kRegion, order_.region_slot[sums_.region_of()[i]]), slot_bytes_));
    }
  }
  const auto offsets = static_cast<std::uint32_t>(words.size());
  result.bars_list = 4 * offsets;
  std::vector<std::uint16_t> lists;
  append_list(kBar, slice.blocks[kBar], lists);
  result.plates_list = static_cast<std::uint32_t>(2 * lists.size());
  append_list(kPlate, slice.blocks[kPlate], lists);
  result.sums_list = static_cast<std::uint32_t>(2 * lists.size());
  append_list(kRegion, slice.blocks[kRegion], lists);
  lists.resize((lists.size() + 1) / 2 * 2);
  for (std::size_t k = 0; k < lists.size(); k += 2) {
    // As two halfwords lie in memory, on any host.
    const std::array<std::uint16_t, 2> pair{lists[k], lists[k + 1]};
    words.push_back(std::bit_cast<std::uint32_t>(pair));
  }
  result.lists_bytes = static_cast<std::uint32_t>((words.size() + 3) / 4 * 16);
  result.lists = lists_.add(std::move(words), offsets);

  spu::TileLimits& limits = limits_[direction_ == Direction::kDown ? 1 : 0];
  limits.input_groups = std::max(limits.input_groups, result.input_groups);
  limits.output_groups = std::max(limits.output_groups, result.output_groups);
  limits.lists_bytes = std::max(limits.lists_bytes, result.lists_bytes);
  return result;
}

std::vector<spu::TileSlice> TileScheduler::slices(std::pair<int, int> tile, Direction direction) {
  start(direction);
  collect(tile);
  place_outputs(tile);
  find_lifetimes();
  allocate_slots();
  spu::TileLimits& limits = limits_[direction == Direction::kDown ? 1 : 0];
  limits.slices = std::max(limits.slices, static_cast<std::uint32_t>(slices_.size()));
  return write_slices(spu::kMatchSlotBytes);
}

std::vector<spu::TileSlice> TileScheduler::write_slices(std::uint32_t slot_bytes) {
  SC_ASSERT(slot_bytes > 0 && slot_bytes % spu::kSumOffsetUnit == 0, "slots of {} bytes", slot_bytes);
  slot_bytes_ = slot_bytes;
  std::vector<spu::TileSlice> result;
  for (const Slice& slice : slices_) result.push_back(written(slice));
  return result;
}

}  // namespace softcell::ppu
