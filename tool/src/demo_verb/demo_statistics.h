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

/// Mean and order statistics of a series of measurements, in the unit of the measurements; all are 0 for an empty series.
struct Summary {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};

/// A part of a run and its share of the time.
struct TimeShare {
  std::string_view key;    ///< name in JSON: "physics"
  std::string_view words;  ///< name for the reader: "contacts and rigid bodies"
  double share = 0;        ///< 0 to 1
};

/// What the work of the SPEs takes on a PS3, by the timing model.
struct FiguresOnPs3 {
  /// The jobs of a kernel.
  struct Kernel {
    std::string name;
    double ms = 0;    ///< per frame, of all SPEs together
    double jobs = 0;  ///< per frame
  };
  Summary ms;                   ///< of a frame: from its first job to its last, without the PPU's time
  double busy = 0;              ///< share of that time in which an SPE runs jobs, waits included
  double waits = 0;             ///< share of the jobs' time that they spend waiting for transfers
  std::vector<Kernel> kernels;  ///< the one that takes most time first
};

/// The figures that both forms need.
struct DemoFigures {
  std::string scene, dma, engine, contacts;
  int frames = 0;
  demos::DemoCounts counts;

  Summary ppu_ms, gather_ms, solve_ms, apply_ms, contacts_ms, physics_ms, skin_ms, solver_wait_ms,
      skin_wait_ms;
  double ppu_share = 0;  ///< of 1/60 s
  Summary picture_ms;
  std::size_t pictures = 0;
  std::uint64_t upload_bytes = 0;  ///< per picture

  double simulated_fps = 0;            ///< frames per second without pictures
  double fps = 0;                      ///< the same with pictures, if each frame waits for one
  std::vector<TimeShare> time_shares;  ///< of what fps counts; the largest, which limits fps, first
  double seconds = 0;                  ///< of the frame loop

  std::vector<double> spe_busy;  ///< share of `seconds`, of each SPE
  std::uint64_t spe_jobs = 0, dma_bytes = 0, dma_commands = 0;
  std::uint64_t state_hash = 0, image_hash = 0;
  std::optional<FiguresOnPs3> on_ps3;  ///< none: nothing was timed
};

/// @param demo    must be stopped
/// @param timing  null: nothing was timed
DemoFigures demo_figures(const DemoOptions& options, const demos::Demo& demo, const demos::RunRecord& record,
                         const ls_sim::Timing* timing);

/// What --json writes; docs/guide/playing.md lists it.
nlohmann::ordered_json to_json(const DemoFigures& figures);

/// Prints the figures in a few lines; the first one says what limits the speed.
void print_summary(const DemoFigures& figures, const DemoOptions& options);

}  // namespace softcell::tool
