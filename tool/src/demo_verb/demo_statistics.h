#pragma once
// The figures of a demo's run, as JSON for other programs and as a summary for the reader.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "demo/run_record.h"
#include "demo_options.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {

/// Mean and order statistics of a series of measurements, in the unit of the measurements; all 0 for an empty
/// series.
struct Summary {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};

/// A part of what a run did, and its share of the time.
struct TimeShare {
  std::string_view key;    ///< in JSON: "physics"
  std::string_view words;  ///< "contacts and rigid bodies"
  double share = 0;        ///< 0 to 1
};

/// What the SPEs' work takes on a PS3, by the model of time.
struct FiguresOnPs3 {
  /// A kernel's jobs.
  struct Kernel {
    std::string name;
    double ms = 0;    ///< a frame, of all SPEs together
    double jobs = 0;  ///< a frame
  };
  Summary ms;                   ///< of a frame: from its first job to its last, without the PPU's time
  double busy = 0;              ///< share of that in which an SPE runs jobs, waits included
  double waits = 0;             ///< share of the jobs' time in which they wait for transfers
  std::vector<Kernel> kernels;  ///< the one that takes most first
};

/// Everything that either form needs.
struct DemoFigures {
  std::string scene, dma, engine, contacts;
  int frames = 0;
  demos::DemoCounts counts;

  Summary ppu_ms, gather_ms, solve_ms, apply_ms, contacts_ms, physics_ms, skin_ms, solver_wait_ms,
      skin_wait_ms;
  double ppu_share = 0;  ///< of 1/60 s
  Summary picture_ms;
  std::size_t pictures = 0;
  std::uint64_t upload_bytes = 0;  ///< of a picture

  double simulated_fps = 0;            ///< frames a second without pictures
  double fps = 0;                      ///< and with them, where each frame has one and waits for it
  std::vector<TimeShare> time_shares;  ///< of what fps counts; the largest, which binds, first
  double seconds = 0;                  ///< of the frame loop

  std::vector<double> spe_busy;  ///< share of `seconds`, of each SPE
  std::uint64_t spe_jobs = 0, dma_bytes = 0, dma_commands = 0;
  std::uint64_t state_hash = 0, image_hash = 0;
  std::optional<FiguresOnPs3> on_ps3;  ///< none: nothing was timed
};

/// @param demo    stopped
/// @param timing  null: nothing was timed
DemoFigures demo_figures(const DemoOptions& options, const demos::Demo& demo, const demos::RunRecord& record,
                         const ls_sim::Timing* timing);

/// What --json writes; docs/guide/playing.md lists it.
nlohmann::ordered_json to_json(const DemoFigures& figures);

/// Prints the figures in a few lines, the first of which says what binds.
void print_summary(const DemoFigures& figures, const DemoOptions& options);

}  // namespace softcell::tool
