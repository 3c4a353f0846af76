#pragma once
// The four passes of the kernel `match_tiles`: what each pass fetches, computes and stores for a slice. match_tiles_job.h describes how the
// passes work together.

#include "common/dma.h"
#include "common/finite.h"
#include "common/sums.h"
#include "match/damping.h"
#include "match/hold.h"
#include "match/localise.h"
#include "match/matching.h"
#include "match/step.h"
#include "match/tile_store.h"

namespace softcell::spu {

/// Tag groups: one for each side of the double buffer, one for results that are stored from a place of their own, one for hints.
enum TileTag : uint32_t { kTagSide0 = 0, kTagSide1 = 1, kTagOut = 2, kTagTouch = 3 };

constexpr uint32_t kPulledBytes = sizeof(TilePulled);

/// A range of main memory.
struct Range {
  uint64_t ea;
  uint32_t bytes;
};

/// The part of an array in main memory that is a slice's input. @param bytes  of a group of four particles or regions
inline Range input_of(const TileSlice& slice, uint64_t array_ea, uint32_t bytes) {
  return {array_ea + static_cast<uint64_t>(slice.input / 4) * bytes, slice.input_groups * bytes};
}

/// The part that is its output.
inline Range output_of(const TileSlice& slice, uint64_t array_ea, uint32_t bytes) {
  return {array_ea + static_cast<uint64_t>(slice.output / 4) * bytes, slice.output_groups * bytes};
}

inline void get_range(void* ls, const Range& range, uint32_t tag) {
  get_large(ls, range.ea, range.bytes, tag);
}
inline void getf_range(void* ls, const Range& range, uint32_t tag) {
  getf_large(ls, range.ea, range.bytes, tag);
}
inline void put_range(void* ls, const Range& range, uint32_t tag) {
  put_large(ls, range.ea, range.bytes, tag);
}

/// Hints for main memory: the ranges that the slice after the next will fetch, and those that the next will store. The kernel gives a few
/// hints at a time between pieces of work, so that nothing waits for them.
class Touches {
 public:
  /// @pre there are fewer than kMost
  void add(const Range& range) {
    if (range.bytes != 0) ranges_[count_++] = range;
  }

  __attribute__((noinline)) void give_some() {
    for (int i = 0; i < kAtOnce; ++i) give_one();
  }

  /// Discards all hints, also those that were not given.
  void clear() { count_ = next_ = 0; }

  void give_all() {
    while (next_ < count_) give_one();
  }

 private:
  static constexpr int kMost = 8, kAtOnce = 2;

  void give_one() {
    if (next_ == count_) return;
    touch_large(ranges_[next_].ea, ranges_[next_].bytes, kTagTouch);
    ++next_;
  }

  Range ranges_[kMost];
  uint32_t count_ = 0, next_ = 0;
};

/// The body, and what all passes need of it.
struct TilePassContext {
  /// Sets members one by one: for a list of initialisers some compilers call memset(), and there is none in a local store.
  TilePassContext(const TiledBody& of, vec_float4 about) : body(of), origin(about) {
    drift.x = drift.y = drift.z = spu_splats(0.0f);
  }

  const TiledBody& body;
  vec_float4 origin;
  Vector3x4 drift;  // m/s: the velocity that pulls have given the body as a whole; known from `twist` on
};

inline const uint16_t* list_at(const char* lists, uint32_t offset) {
  return reinterpret_cast<const uint16_t*>(lists + offset);
}

/// Makes the sums of a slice: bars, plates, and then regions or totals.
template <int kRows, typename AnySlot>
inline void sum_slice(const TileSlice& slice, const char* lists, AnySlot* slots, Touches& touches) {
  // A list writes from the slot after the given one.
  const char* const bars = lists + slice.bars_list;
  touches.give_some();
  sum_slots<kRows>(list_at(bars, 0), slots, slots + slice.bars_slot - 1);
  touches.give_some();
  sum_slots<kRows>(list_at(bars, slice.plates_list), slots, slots + slice.plates_slot - 1);
  touches.give_some();
  sum_slots<kRows>(list_at(bars, slice.sums_list), slots, slots + slice.sums_slot - 1);
  touches.give_some();
}

inline bool finite_groups(Vectors4* groups, uint32_t count) {
  return all_finite(particle_quadwords(groups), 4 * count);
}

/// gather: positions to motions of regions.
class GatherPass {
 public:
  GatherPass(const TilePassContext& context, const UpStore& store)
      : body_(context.body), origin_(context.origin), store_(store) {}

  void fetch(const TileSlice& slice, uint32_t s) {
    const UpSide& side = store_.side[s];
    getf_range(side.rotations, output_of(slice, body_.rotations_in_ea, 64), s);
    get_large(side.lists, body_.lists_ea + slice.lists, slice.lists_bytes, s);
    get_range(side.positions, input_of(slice, body_.positions_ea, 64), s);
    get_range(side.rest, input_of(slice, body_.rest_ea, 64), s);
    get_range(side.regions, output_of(slice, body_.regions_ea, 64), s);
  }

  static bool fetches(const TileSlice&) { return true; }  // at least its lists

  void touch(const TileSlice& coming, const TileSlice& leaving, Touches& touches) const {
    touches.add(input_of(coming, body_.positions_ea, 64));
    touches.add(input_of(coming, body_.rest_ea, 64));
    touches.add(output_of(coming, body_.rotations_in_ea, 64));
    touches.add(output_of(coming, body_.regions_ea, 64));
    touches.add(output_of(leaving, body_.rotations_out_ea, 64));
    touches.add(output_of(leaving, body_.motions_ea, 4 * kMatchSlotBytes));
    touches.add(output_of(leaving, body_.momenta_ea, 64));
  }

  void work(const TileSlice& slice, uint32_t s, Touches& touches) {
    const UpSide& side = store_.side[s];
    finite_ = finite_ && finite_groups(side.positions, slice.input_groups);
    to_components(side.positions, 4 * slice.input_groups, origin_);
    for (uint32_t g = 0; g < slice.input_groups; ++g)
      match_moments(side.rest[g], side.positions[g].v, store_.slots + slice.input_slot + 4 * g);
    sum_slice<3>(slice, side.lists, store_.slots, touches);

    MomentumConstants* const momenta = store_.momenta;
    const StepOptions options = {
        body_.pull, body_.damping, {body_.least_iterations, body_.most_iterations}, body_.cold != 0};
    match_regions(
        side.regions, side.rotations, store_.slots + slice.sums_slot, store_.motions, slice.output_groups,
        spu_splats(body_.noise_floor), options,
        [&](uint32_t g, const Vector3x4& momentum) __attribute__((always_inline)) {
          momenta[g] = {momentum, side.regions[g].inverse_mass};
        },
        worst_);
    put_range(side.rotations, output_of(slice, body_.rotations_out_ea, 64), s);
    put_range(store_.motions, output_of(slice, body_.motions_ea, 4 * kMatchSlotBytes), kTagOut);
    put_range(store_.momenta, output_of(slice, body_.momenta_ea, 64), kTagOut);
  }

  void report(TileReport& report) const {
    report.residual_square = largest_lane(worst_);
    report.positions_finite = finite_;
  }

 private:
  const TiledBody& body_;
  const vec_float4 origin_;
  const UpStore& store_;
  vec_float4 worst_ = spu_splats(0.0f);
  bool finite_ = true;
};

/// twist: positions and pulled velocities to twists of regions.
class TwistPass {
 public:
  TwistPass(const TilePassContext& context, const UpStore& store) : context_(context), store_(store) {}

  void fetch(const TileSlice& slice, uint32_t s) {
    const UpSide& side = store_.side[s];
    const TiledBody& body = context_.body;
    get_large(side.lists, body.lists_ea + slice.lists, slice.lists_bytes, s);
    get_range(side.pulled, input_of(slice, body.pulled_ea, kPulledBytes), s);
    get_range(side.momenta, output_of(slice, body.momenta_ea, 64), s);
  }

  static bool fetches(const TileSlice&) { return true; }  // its lists, at least

  void touch(const TileSlice& coming, const TileSlice& leaving, Touches& touches) const {
    const TiledBody& body = context_.body;
    touches.add(input_of(coming, body.pulled_ea, kPulledBytes));
    touches.add(output_of(coming, body.momenta_ea, 64));
    touches.add(output_of(leaving, body.motions_ea, 4 * kTwistSlotBytes));
  }

  void work(const TileSlice& slice, uint32_t s, Touches& touches) {
    const UpSide& side = store_.side[s];
    for (uint32_t g = 0; g < slice.input_groups; ++g) {
      const Pulled4& p = side.pulled[g];
      twist_moments(p.modified_mass, p.x, difference(p.v, context_.drift),
                    store_.slots + slice.input_slot + 4 * g);
    }
    sum_slice<3>(slice, side.lists, store_.slots, touches);

    const vec_float4 noise_floor = spu_splats(context_.body.noise_floor);
    TwistSlot* const twists = reinterpret_cast<TwistSlot*>(store_.motions);
    for (uint32_t g = 0; g < slice.output_groups; ++g) {
      const MomentumConstants& m = side.momenta[g];
      twist_regions(m.inverse_mass, m.momentum, store_.slots + slice.sums_slot + 4 * g, twists + 4 * g,
                    noise_floor);
    }
    put_range(twists, output_of(slice, context_.body.motions_ea, 4 * kTwistSlotBytes), kTagOut);
  }

 private:
  const TilePassContext& context_;
  const UpStore& store_;
};

/// scatter: motions of regions to pulled velocities.
class ScatterPass {
 public:
  ScatterPass(const TilePassContext& context, const DownStore& store) : context_(context), store_(store) {}

  void fetch(const TileSlice& slice, uint32_t s) {
    const DownSide& side = store_.side[s];
    const TiledBody& body = context_.body;
    get_range(side.velocities, output_of(slice, body.velocities_ea, 64), s);
    get_large(side.lists, body.lists_ea + slice.lists, slice.lists_bytes, s);
    get_range(store_.slots + slice.input_slot, input_of(slice, body.motions_ea, 4 * kMatchSlotBytes), s);
    get_range(side.positions, output_of(slice, body.positions_ea, 64), s);
    get_range(side.rest, output_of(slice, body.rest_ea, 64), s);
    get_range(side.weights, output_of(slice, body.weights_ea, 32), s);
  }

  static bool fetches(const TileSlice&) { return true; }  // its lists, at least

  void touch(const TileSlice& coming, const TileSlice& leaving, Touches& touches) const {
    const TiledBody& body = context_.body;
    touches.add(input_of(coming, body.motions_ea, 4 * kMatchSlotBytes));
    touches.add(output_of(coming, body.velocities_ea, 64));
    touches.add(output_of(coming, body.positions_ea, 64));
    touches.add(output_of(coming, body.rest_ea, 64));
    touches.add(output_of(coming, body.weights_ea, 32));
    touches.add(output_of(leaving, body.pulled_ea, kPulledBytes));
  }

  void work(const TileSlice& slice, uint32_t s, Touches& touches) {
    const DownSide& side = store_.side[s];
    const TiledBody& body = context_.body;
    sum_slice<3>(slice, side.lists, store_.slots, touches);

    finite_ = finite_ && finite_groups(side.velocities, slice.output_groups);
    to_components(side.positions, 4 * slice.output_groups, context_.origin);
    to_components(side.velocities, 4 * slice.output_groups, spu_splats(0.0f));
    const vec_float4 pull = spu_splats(body.pull), scale = spu_splats(body.hold.scale);
    const auto* const region = reinterpret_cast<const uint32_t(*)[4]>(side.lists);
    for (uint32_t g = 0; g < slice.output_groups; ++g) {
      const WeightConstants& weights = side.weights[g];
      const Vector3x4& x = side.positions[g].v;
      const Vector3x4 to_goal =
          difference(goals(side.rest[g], weights.inverse_mass, region[g], store_.slots), x);
      // Padding has no goal.
      const vec_uint4 padding = spu_cmpeq((vec_uint4)weights.mass, spu_splats(0u));
      const vec_float4 own_pull = (vec_float4)spu_andc((vec_uint4)pull, padding);
      const vec_float4 mass = modified_mass(side.rest[g]);
      store_.pulled[g] = {x, scale_add(to_goal, own_pull, side.velocities[g].v), mass,
                          spu_mul(mass, weights.inverse_mass)};
      add_pulls(pulls_, to_goal, spu_mul(weights.mass, scale));
    }
    put_range(store_.pulled, output_of(slice, body.pulled_ea, kPulledBytes), kTagOut);
  }

  void report(TileReport& report) {
    carry(pulls_);
    report.velocities_finite = finite_;
    copy_sum(pulls_, *reinterpret_cast<PullSum*>(report.pulls));
  }

 private:
  const TilePassContext& context_;
  const DownStore& store_;
  PullSum pulls_ = no_pulls();
  bool finite_ = true;
};

/// damp: twists of regions to velocities; or, without damping, the velocities of `scatter` minus the drift.
class DampPass {
 public:
  DampPass(const TilePassContext& context, const DownStore& store)
      : context_(context), store_(store), damping_(context.body.damping > 0) {}

  void fetch(const TileSlice& slice, uint32_t s) {
    const DownSide& side = store_.side[s];
    const TiledBody& body = context_.body;
    get_range(side.pulled, output_of(slice, body.pulled_ea, kPulledBytes), s);
    if (!damping_) return;
    get_large(side.lists, body.lists_ea + slice.lists, slice.lists_bytes, s);
    get_range(slots() + slice.input_slot, input_of(slice, body.motions_ea, 4 * kTwistSlotBytes), s);
  }

  /// Without damping, a slice without output needs nothing.
  bool fetches(const TileSlice& slice) const { return damping_ || slice.output_groups != 0; }

  void touch(const TileSlice& coming, const TileSlice& leaving, Touches& touches) const {
    const TiledBody& body = context_.body;
    touches.add(output_of(coming, body.pulled_ea, kPulledBytes));
    touches.add(output_of(leaving, body.velocities_ea, 64));
    if (damping_) touches.add(input_of(coming, body.motions_ea, 4 * kTwistSlotBytes));
  }

  void work(const TileSlice& slice, uint32_t s, Touches& touches) {
    const DownSide& side = store_.side[s];
    if (damping_) sum_slice<2>(slice, side.lists, slots(), touches);
    const vec_float4 damping = spu_splats(context_.body.damping);
    const auto* const region = reinterpret_cast<const uint32_t(*)[4]>(side.lists);
    for (uint32_t g = 0; g < slice.output_groups; ++g) {
      const Pulled4& p = side.pulled[g];
      const Vector3x4 v = difference(p.v, context_.drift);
      store_.damped[g].v = damping_ ? damp(p.share, region[g], slots(), p.x, v, damping) : v;
    }
    to_particles(store_.damped, slice.output_groups);
    put_range(store_.damped, output_of(slice, context_.body.velocities_ea, 64), kTagOut);
  }

 private:
  /// The store's slots, as slots of two rows.
  TwistSlot* slots() const { return reinterpret_cast<TwistSlot*>(store_.slots); }

  const TilePassContext& context_;
  const DownStore& store_;
  const bool damping_;
};

/// Runs a pass over all slices of a tile. While it works on a slice, the MFC fetches the next. Before that it waits until the results of
/// the slice before have been stored, because they have one place only.
template <typename Pass>
inline void run_slices(Pass& pass, const TileSlice* slices, uint32_t count) {
  Touches touches;
  pass.fetch(slices[0], 0);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t s = i & 1;
    touches.clear();
    if (i + 2 < count) pass.touch(slices[i + 2], slices[i + 1], touches);
    if (i + 1 < count) pass.fetch(slices[i + 1], s ^ 1);
    // A wait for tag groups without commands would be legal and end at once. But it is mostly a mistake, so the checker reports it.
    const bool awaits_puts = i > 0 && slices[i - 1].output_groups != 0;
    if (pass.fetches(slices[i]) || awaits_puts) wait_for_tags(1u << s | 1u << kTagOut);
    pass.work(slices[i], s, touches);
    touches.give_all();
  }
}

}  // namespace softcell::spu
