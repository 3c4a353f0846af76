#include "demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "demo_pictures.h"
#include "interrupt.h"
#include "json_file.h"
#include "kernel_report.h"
#include "progress_bar.h"
#include "softcell/render/offscreen_context.h"
#include "statistics.h"
#include "usage_error.h"

namespace softcell::demos {
namespace {

constexpr int kExitFindings = 3;
constexpr int kExitInterrupted = 130;  // as a shell reports a process that SIGINT ended

/// What a run measured.
struct RunRecord {
  std::vector<double> physics_ms, ppu_ms, gather_ms, solve_ms, apply_ms, skin_ms, solver_wait_ms,
      skin_wait_ms;
  double seconds = 0;  // of the frame loop, pictures included
  int frames = 0;

  void add(const FrameTimes& times) {
    physics_ms.push_back(times.physics_ms);
    ppu_ms.push_back(times.ppu_ms);
    gather_ms.push_back(times.gather_ms);
    solve_ms.push_back(times.solve_ms);
    apply_ms.push_back(times.apply_ms);
    skin_ms.push_back(times.skin_ms);
    solver_wait_ms.push_back(times.solver_wait_ms);
    skin_wait_ms.push_back(times.skin_wait_ms);
    ++frames;
  }

  /// What softcell takes of the PPU's time in a frame of 1/60 s.
  double ppu_share() const { return frames == 0 ? 0 : sum(ppu_ms) / frames * 60 / 1000; }

  /// Frames a second without pictures.
  double simulated_fps() const {
    const double total = sum(physics_ms) + sum(ppu_ms) + sum(solver_wait_ms) + sum(skin_wait_ms);
    return total > 0 ? 1000.0 * frames / total : 0;
  }

 private:
  static double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }
};

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

nlohmann::ordered_json statistics_document(const DemoOptions& options, const Demo& demo,
                                           const RunRecord& record, const Pictures& pictures) {
  const DemoCounts counts = demo.counts();
  std::vector<double> busy;
  std::uint64_t bytes = 0, commands = 0, jobs = 0;
  for (const ls_sim::SpeStatistics& spe : demo.spe_statistics()) {
    busy.push_back(record.seconds > 0 ? std::chrono::duration<double>(spe.busy).count() / record.seconds : 0);
    bytes += spe.dma.bytes();
    commands += spe.dma.commands();
    jobs += spe.jobs;
  }
  return {
      {"scene", demo.scene_name()},
      {"frames", record.frames},
      {"bodies", counts.soft_bodies},
      {"rigid_bodies", counts.rigid_bodies},
      {"particles", counts.particles},
      {"vertices", counts.vertices},
      {"spes", busy.size()},
      {"dma", dma::to_string(options.schedule)},
      {"engine", options.solver == Solver::kSpe ? "native" : "reference"},
      {"ppu_ms", to_json(summarize(record.ppu_ms))},
      {"ppu_share", record.ppu_share()},
      {"gather_ms", to_json(summarize(record.gather_ms))},
      {"solve_ms", to_json(summarize(record.solve_ms))},
      {"apply_ms", to_json(summarize(record.apply_ms))},
      {"physics_ms", to_json(summarize(record.physics_ms))},
      {"skin_ms", to_json(summarize(record.skin_ms))},
      {"solver_wait_ms", to_json(summarize(record.solver_wait_ms))},
      {"skin_wait_ms", to_json(summarize(record.skin_wait_ms))},
      {"picture_ms", to_json(summarize(pictures.milliseconds()))},
      {"simulated_fps", record.simulated_fps()},
      {"seconds", record.seconds},
      {"late_frames", demo.late_frames()},
      {"spe_busy", busy},
      {"spe_jobs", jobs},
      {"dma_bytes", bytes},
      {"dma_commands", commands},
      {"state_hash", fmt::format("{:016x}", demo.state_hash())},
      {"image_hash", fmt::format("{:016x}", pictures.last_hash())},
  };
}

void print_summary(const nlohmann::ordered_json& s, const DemoOptions& options) {
  double busiest = 0, mean = 0;
  for (const double share : s["spe_busy"]) {
    busiest = std::max(busiest, share);
    mean += share / static_cast<double>(s["spe_busy"].size());
  }
  fmt::print("scene {}: {} frames, {} soft bodies and {} rigid ones, {} particles, {} vertices\n",
             s["scene"].get<std::string>(), s["frames"].get<int>(), s["bodies"].get<int>(),
             s["rigid_bodies"].get<int>(), s["particles"].get<int>(), s["vertices"].get<int>());
  fmt::print(
      "a frame:  PPU {:.3f} ms, {:.1f} % of 1/60 s (gather {:.3f}, solve {:.3f}, apply {:.3f}, hand over "
      "the skinning {:.3f}), physics {:.2f} ms, pictures {:.1f} ms\n",
      s["ppu_ms"]["mean"].get<double>(), 100 * s["ppu_share"].get<double>(),
      s["gather_ms"]["mean"].get<double>(), s["solve_ms"]["mean"].get<double>(),
      s["apply_ms"]["mean"].get<double>(), s["skin_ms"]["mean"].get<double>(),
      s["physics_ms"]["mean"].get<double>(), s["picture_ms"]["mean"].get<double>());
  fmt::print("          {:.0f} frames a second without pictures\n", s["simulated_fps"].get<double>());
  if (!s["spe_busy"].empty()) {
    fmt::print(
        "SPEs:     {} at work, busy {:.1f} % of the time (the busiest {:.1f} %), {} DMA commands, {:.1f} "
        "MB\n",
        s["spes"].get<int>(), 100 * mean, 100 * busiest, s["dma_commands"].get<std::uint64_t>(),
        static_cast<double>(s["dma_bytes"].get<std::uint64_t>()) / 1e6);
  }
  fmt::print("state:    {}   picture: {}\n", s["state_hash"].get<std::string>(),
             s["image_hash"].get<std::string>());
  const auto where = [](const char* what, const std::optional<std::filesystem::path>& path) {
    if (path) fmt::print("{:<9} {}\n", what, path->string());
  };
  where("frames:", options.out);
  where("video:", options.video);
  where("trace:", options.trace);
  where("figures:", options.json);
}

}  // namespace

int run_demo(const DemoOptions& options, std::string_view verb, const MakeDemo& make) {
  if (!options.headless) {
    throw UsageError(
        "this version has no window yet: run it with --headless, and --out or --video to see something");
  }
  render::pin_software_rasterizer();
  ls_sim::Findings findings;
  std::optional<ls_sim::Trace> trace;
  if (options.trace) trace.emplace(options.spes);
  const std::unique_ptr<Demo> demo = make({.solver = options.solver,
                                           .spes = options.spes,
                                           .schedule = options.schedule,
                                           .findings = options.checked ? &findings : nullptr,
                                           .trace = trace ? &*trace : nullptr});
  const int frames = options.frames.value_or(demo->frames());

  RunRecord record;
  const InterruptGuard guard;
  const auto begin = std::chrono::steady_clock::now();
  Pictures pictures(options, *demo);
  {
    ProgressBar bar(std::string(verb), static_cast<std::size_t>(frames), options.quiet);
    for (int frame = 0; frame < frames && !guard.interrupted(); ++frame) {
      record.add(demo->step());
      if (pictures.every_frame()) pictures.take(frame);
      bar.show(static_cast<std::size_t>(frame) + 1);
    }
  }
  if (!pictures.every_frame() && !guard.interrupted()) pictures.take(record.frames - 1);
  demo->stop();
  if (guard.interrupted()) {
    fmt::print(stderr, "softcell: interrupted after {} of {} frames; every frame that was written is whole\n",
               record.frames, frames);
    return kExitInterrupted;
  }
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  pictures.finish();

  auto statistics = statistics_document(options, *demo, record, pictures);
  const std::vector<ls_sim::Finding> found = findings.list();
  if (options.checked) statistics["findings"] = to_json(std::span(found));
  if (trace) trace->write(*options.trace);
  if (options.json) write_json(*options.json, statistics);
  if (!options.quiet) print_summary(statistics, options);
  print_findings(found);
  return found.empty() ? 0 : kExitFindings;
}

}  // namespace softcell::demos
