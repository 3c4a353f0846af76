// match_tiles: one pass of a step for one tile of a body that is too large for a local store. [LSM07]
//
//   array       direction  element                   count                          alignment
//   job         in         TileJob, 128 bytes        1                              128
//   body        in         TiledBody, 256 bytes      1                              128
//   slices      in         TileSlice, 64 bytes       one for each plane             16
//   samples     in         x y z 0, 16 bytes         16                             16
//   reports     in, out    TileReport, 256 bytes     all in; half of one out        128
//   and for each slice, by gets and puts of up to 16 KB, in each pass:
//   gather      in         lists, positions, rest moments, regions, rotations
//               out        rotations, motions, momenta
//   scatter     in         lists, motions, positions, velocities, rest moments, weights
//               out        pulled particles
//   twist       in         lists, pulled particles, momenta
//               out        twists
//   damp        in         lists, twists, pulled particles
//               out        velocities
//   Without damping, damp reads only pulled particles, and twist does not run.
//
// Budget: 251 KB. 208 KB for two sides of a double buffer and slots, the rest for code and 5 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "match/tile_passes.h"
#include "match_tiles_job.h"

namespace softcell::spu {
namespace {

#ifdef SOFTCELL_CHECKED
constexpr uint32_t kArenaBytes = kTileCheckedArenaBytes;
#else
constexpr uint32_t kArenaBytes = kTileArenaBytes;
#endif

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  TileJob job;
  TiledBody body;
  TileReport report;  // `gather` writes its first line, `scatter` its second
  vec_float4 samples[kMatchSamples];
  alignas(128) char arena[kArenaBytes];
};
LocalStoreMap ls;

uint64_t report_ea() { return ls.body.reports_ea + static_cast<uint64_t>(ls.job.tile) * sizeof(TileReport); }

void load_body() {
  mfc_get(&ls.body, ls.job.body_ea, sizeof(TiledBody), kTagOut, 0, 0);
  wait_for_tag(kTagOut);
  for (uint32_t i = 0; i < kMatchSamples; ++i)
    mfc_get(&ls.samples[i], ls.body.positions_ea + static_cast<uint64_t>(ls.body.samples[i]) * 16, 16,
            kTagOut, 0, 0);
  wait_for_tag(kTagOut);
}

/// The reports of all tiles together.
struct Findings {
  PullSum pulls = no_pulls();
  bool finite = true;
};

/// Reads the reports into the arena. Call it before a pass uses the arena.
Findings read_reports() {
  constexpr uint32_t kAtOnce = kMaxTransferBytes / static_cast<uint32_t>(sizeof(TileReport));
  Findings all;
  for (uint32_t first = 0; first < ls.body.tiles; first += kAtOnce) {
    const uint32_t left = ls.body.tiles - first, count = left < kAtOnce ? left : kAtOnce;
    mfc_get(ls.arena, ls.body.reports_ea + static_cast<uint64_t>(first) * sizeof(TileReport),
            count * static_cast<uint32_t>(sizeof(TileReport)), kTagOut, 0, 0);
    wait_for_tag(kTagOut);
    const auto* const reports = reinterpret_cast<const TileReport*>(ls.arena);
    for (uint32_t i = 0; i < count; ++i) {
      all.finite = all.finite && reports[i].positions_finite != 0 && reports[i].velocities_finite != 0;
      add_sums(all.pulls, *reinterpret_cast<const PullSum*>(reports[i].pulls));
    }
  }
  return all;
}

template <typename Pass, typename Store>
void run(Pass& pass, const Store& store) {
  get_large(store.slices, ls.job.slices_ea, ls.job.slice_count * static_cast<uint32_t>(sizeof(TileSlice)),
            kTagOut);
  wait_for_tag(kTagOut);
  clear(store.slots[0]);
  run_slices(pass, store.slices, ls.job.slice_count);
}

/// A loop of its own, because there is no memset() in a local store.
void clear_report() {
  auto* const quadwords = reinterpret_cast<vec_uint4*>(&ls.report);
  for (uint32_t i = 0; i < sizeof(TileReport) / 16; ++i) quadwords[i] = spu_splats(0u);
}

void gather(const TilePassContext& context) {
  const UpStore store = up_store(ls.arena, ls.body.up);
  GatherPass pass(context, store);
  run(pass, store);
  clear_report();
  pass.report(ls.report);
  mfc_put(&ls.report, report_ea(), kTileReportLine, kTagOut, 0, 0);
}

void scatter(const TilePassContext& context) {
  const DownStore store = down_store(ls.arena, ls.body.down);
  ScatterPass pass(context, store);
  run(pass, store);
  clear_report();
  pass.report(ls.report);
  mfc_put(ls.report.pulls, report_ea() + kTileReportLine, kTileReportLine, kTagOut, 0, 0);
}

void twist(const TilePassContext& context) {
  const UpStore store = up_store(ls.arena, ls.body.up);
  TwistPass pass(context, store);
  run(pass, store);
}

void damp(const TilePassContext& context) {
  const DownStore store = down_store(ls.arena, ls.body.down);
  DampPass pass(context, store);
  run(pass, store);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a TileJob. Returns a TileStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(TileJob), kTagOut, 0, 0);
  wait_for_tag(kTagOut);
  load_body();
  if (!tile_fits(ls.body.up, ls.body.down, kArenaBytes)) return kTileTooLarge;
  if (ls.job.slice_count == 0) return kTileDone;

  TilePassContext context(ls.body, origin_of(ls.samples, ls.body.grid));
  if (ls.job.pass == kTileTwist || ls.job.pass == kTileDamp) {
    const Findings found = read_reports();
    if (!found.finite) return kTileDone;  // the body stays as it was
    context.drift = drift_of(found.pulls, ls.body.pull * ls.body.hold.share);
  }
  switch (ls.job.pass) {
    case kTileGather:
      gather(context);
      break;
    case kTileScatter:
      scatter(context);
      break;
    case kTileTwist:
      twist(context);
      break;
    default:
      damp(context);
      break;
  }
  wait_for_tags(1u << kTagSide0 | 1u << kTagSide1 | 1u << kTagOut | 1u << kTagTouch);
  return kTileDone;
}
