#include "demo_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "scene/scene.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Summary summarize(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto rank = [&](double share) {
    SC_ASSERT(share >= 0 && share <= 1, "the quantile {}", share);
    return samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1) + 0.5)];
  };
  return {sum(samples) / static_cast<double>(samples.size()), rank(0.5), rank(0.99), samples.back()};
}

/// Whether the run draws each frame before it simulates the next. In a window, a separate thread draws.
bool waits_for_pictures(const DemoOptions& options) {
  return options.headless && (options.out || options.video);
}

/// Fills in the parts on which the frame loop spent its time, and the frames per second that result.
void fill_in_time(const DemoOptions& options, const demos::RunRecord& record, DemoFigures& figures) {
  SC_ASSERT(record.physics_ms.size() == static_cast<std::size_t>(record.frames),
            "the times of {} frames of {}", record.physics_ms.size(), record.frames);
  figures.time_shares = {
      {"physics", "contacts and rigid bodies", sum(record.physics_ms) + sum(record.contacts_ms)},
      {"matching", "shape matching", sum(record.solve_ms) + sum(record.solver_wait_ms)},
      {"skinning", "skinning", sum(record.skin_ms) + sum(record.skin_wait_ms)},
      {"coupling", "copying particles", sum(record.gather_ms) + sum(record.apply_ms)},
      {"pictures", "pictures", waits_for_pictures(options) ? sum(record.picture_ms) : 0}};
  double milliseconds = 0;
  for (const TimeShare& part : figures.time_shares) milliseconds += part.share;
  if (milliseconds <= 0) return;
  for (TimeShare& part : figures.time_shares) part.share /= milliseconds;
  std::ranges::stable_sort(figures.time_shares, std::ranges::greater{}, &TimeShare::share);
  figures.fps = 1000 * record.frames / milliseconds;
}

/// "9.7 frames", "61 frames".
std::string frame_rate(double fps) { return fmt::format("{:.{}f} frames", fps, fps < 9.95 ? 1 : 0); }

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

/// "by the SPEs", "3 by the SPEs, 1 by the PPU because it does not fit a local store".
std::string who_steps(const demos::DemoCounts& counts, const DemoOptions& options) {
  SC_ASSERT(counts.bodies_on_ppu <= counts.soft_bodies, "the PPU steps {} bodies of {}", counts.bodies_on_ppu,
            counts.soft_bodies);
  if (options.solver == demos::Solver::kReference) return "by the PPU, as --engine reference asks";
  if (counts.bodies_on_ppu == 0) return "by the SPEs";
  const std::string by_spes =
      counts.bodies_on_ppu == counts.soft_bodies
          ? ""
          : fmt::format("{} by the SPEs, ", counts.soft_bodies - counts.bodies_on_ppu);
  return fmt::format("{}{} by the PPU because {} not fit a local store{}", by_spes, counts.bodies_on_ppu,
                     counts.bodies_on_ppu == 1 ? "it does" : "they do",
                     options.checked ? ", where checked kernels have less room" : "");
}

void print_files(const DemoOptions& options) {
  const auto where = [](const char* what, const std::optional<std::filesystem::path>& path) {
    if (path) fmt::print("{:<11}{}\n", what, shown_name(*path));
  };
  where("frames:", options.out);
  where("video:", options.video);
  where("recording:", options.record);
  where("trace:", options.trace);
  where("figures:", options.json);
}

const char* engine_name(const DemoOptions& options) {
  if (options.solver == demos::Solver::kReference) return "reference";
  return options.machine == ls_sim::Machine::kSpu ? "interpreter" : "native";
}

/// Sums over the whole run, divided by its frames.
FiguresOnPs3 figures_on_ps3(const demos::RunRecord& record, const ls_sim::Timing& timing) {
  FiguresOnPs3 figures{.ms = summarize(record.ps3_ms), .kernels = {}};
  const double frames = std::max(record.frames, 1);
  double cycles = 0, waits = 0;
  for (const ls_sim::KernelCycles& each : timing.by_kernel()) {
    cycles += static_cast<double>(each.cycles);
    waits += static_cast<double>(each.waits);
    figures.kernels.push_back({each.kernel,
                               1e3 * static_cast<double>(each.cycles) / ls_sim::kCyclesPerSecond / frames,
                               static_cast<double>(each.jobs) / frames});
  }
  std::ranges::stable_sort(figures.kernels, std::ranges::greater{}, &FiguresOnPs3::Kernel::ms);
  if (cycles > 0) figures.waits = waits / cycles;
  if (timing.now() > 0) figures.busy = cycles / static_cast<double>(timing.now()) / timing.spes();
  return figures;
}

nlohmann::ordered_json to_json(const FiguresOnPs3& figures) {
  nlohmann::ordered_json kernels = nlohmann::ordered_json::array();
  for (const auto& [name, ms, jobs] : figures.kernels)
    kernels.push_back({{"name", name}, {"ms", ms}, {"jobs", jobs}});
  return {{"ms", to_json(figures.ms)},
          {"busy", figures.busy},
          {"waits", figures.waits},
          {"kernels", std::move(kernels)}};
}

/// For comparison with the report of 2008, in which the PPU did the matching, and the SPEs the skinning in three dimensions.
void print_on_ps3(const FiguresOnPs3& f, std::size_t spes) {
  fmt::print(
      "on a PS3:  {:.2f} ms a frame of {} (99 % of frames: {:.2f}), {:.1f} % of 1/60 s, the PPU's time not "
      "counted\n",
      f.ms.mean, base::counted(spes, "SPE"), f.ms.p99, 100 * f.ms.mean * 60 / 1000);
  std::string kernels;
  for (const auto& [name, ms, jobs] : f.kernels)
    kernels += fmt::format("{}{} {:.2f} ms", kernels.empty() ? "" : ", ", name, ms);
  fmt::print(
      "           the SPEs are busy {:.0f} % of that, {:.0f} % of it waiting for transfers; together: {}\n",
      100 * f.busy, 100 * f.waits, kernels);
  fmt::print(
      "           the report of 2008: 6.7 ms of the PPU for 132 particles in 2D, 4.0 ms for 112 in 3D\n");
}

}  // namespace

DemoFigures demo_figures(const DemoOptions& options, const demos::Demo& demo, const demos::RunRecord& record,
                         const ls_sim::Timing* timing) {
  DemoFigures figures{
      .scene = demo.scene_name(),
      .dma = dma::to_string(options.schedule),
      .engine = engine_name(options),
      .contacts = std::string(demos::kContactMethods.at(static_cast<std::size_t>(demo.contacts()))),
      .frames = record.frames,
      .counts = demo.counts(),
      .ppu_ms = summarize(record.ppu_ms),
      .gather_ms = summarize(record.gather_ms),
      .solve_ms = summarize(record.solve_ms),
      .apply_ms = summarize(record.apply_ms),
      .contacts_ms = summarize(record.contacts_ms),
      .physics_ms = summarize(record.physics_ms),
      .skin_ms = summarize(record.skin_ms),
      .solver_wait_ms = summarize(record.solver_wait_ms),
      .skin_wait_ms = summarize(record.skin_wait_ms),
      .ppu_share = record.ppu_share(),
      .picture_ms = summarize(record.picture_ms),
      .pictures = record.picture_ms.size(),
      .upload_bytes = record.upload_bytes_of_a_picture(),
      .simulated_fps = record.simulated_fps(),
      .time_shares = {},
      .seconds = record.seconds,
      .spe_busy = {},
      .state_hash = demo.state_hash(),
      .image_hash = record.image_hash,
      .on_ps3 = {}};
  if (timing != nullptr) figures.on_ps3 = figures_on_ps3(record, *timing);
  fill_in_time(options, record, figures);
  for (const ls_sim::SpeStatistics& spe : demo.spe_statistics()) {
    SC_ASSERT(spe.busy.count() >= 0, "an SPE was busy for {} ns", spe.busy.count());
    const double busy = std::chrono::duration<double>(spe.busy).count();
    figures.spe_busy.push_back(record.seconds > 0 ? busy / record.seconds : 0);
    figures.dma_bytes += spe.dma.bytes();
    figures.dma_commands += spe.dma.commands();
    figures.spe_jobs += spe.jobs;
  }
  return figures;
}

nlohmann::ordered_json to_json(const DemoFigures& f) {
  nlohmann::ordered_json shares;
  for (const TimeShare& part : f.time_shares) shares[std::string(part.key)] = part.share;
  nlohmann::ordered_json document{
      {"scene", f.scene},
      {"frames", f.frames},
      {"bodies", f.counts.soft_bodies},
      {"rigid_bodies", f.counts.rigid_bodies},
      {"particles", f.counts.particles},
      {"vertices", f.counts.vertices},
      {"bodies_on_ppu", f.counts.bodies_on_ppu},
      {"spes", f.spe_busy.size()},
      {"dma", f.dma},
      {"engine", f.engine},
      {"contacts", f.contacts},
      {"ppu_ms", to_json(f.ppu_ms)},
      {"ppu_share", f.ppu_share},
      {"gather_ms", to_json(f.gather_ms)},
      {"solve_ms", to_json(f.solve_ms)},
      {"apply_ms", to_json(f.apply_ms)},
      {"contacts_ms", to_json(f.contacts_ms)},
      {"physics_ms", to_json(f.physics_ms)},
      {"skin_ms", to_json(f.skin_ms)},
      {"solver_wait_ms", to_json(f.solver_wait_ms)},
      {"skin_wait_ms", to_json(f.skin_wait_ms)},
      {"picture_ms", to_json(f.picture_ms)},
      {"pictures", f.pictures},
      {"upload_bytes", f.upload_bytes},
      {"simulated_fps", f.simulated_fps},
      {"fps", f.fps},
      {"time_shares", std::move(shares)},
      {"seconds", f.seconds},
      {"spe_busy", f.spe_busy},
      {"spe_jobs", f.spe_jobs},
      {"dma_bytes", f.dma_bytes},
      {"dma_commands", f.dma_commands},
      {"state_hash", fmt::format("{:016x}", f.state_hash)},
      {"image_hash", fmt::format("{:016x}", f.image_hash)},
  };
  if (f.on_ps3) document["on_ps3"] = to_json(*f.on_ps3);
  return document;
}

void print_summary(const DemoFigures& f, const DemoOptions& options) {
  using base::counted;
  if (f.fps > 0) {
    SC_ASSERT(!f.time_shares.empty(), "{} frames a second, but no shares of time", f.fps);
    const TimeShare& binds = f.time_shares.front();
    fmt::print("{} a second; {} {:.0f} %\n", frame_rate(f.fps), binds.words, 100 * binds.share);
  } else {
    fmt::print("no frame was simulated\n");
  }
  fmt::print("scene:     {}: {}, {} and {}, {}, {}\n", f.scene,
             counted(static_cast<std::uint64_t>(f.frames), "frame"),
             counted(f.counts.soft_bodies, "soft body", "soft bodies"),
             counted(f.counts.rigid_bodies, "rigid one"), counted(f.counts.particles, "particle"),
             counted(f.counts.vertices, "vertex", "vertices"));
  if (f.counts.soft_bodies > 0) fmt::print("stepped:   {}\n", who_steps(f.counts, options));
  fmt::print(
      "a frame:   PPU {:.3f} ms, {:.1f} % of 1/60 s (gather {:.3f}, solve {:.3f}, apply {:.3f}, contacts "
      "{:.3f}, hand over "
      "the skinning {:.3f}), physics {:.2f} ms\n",
      f.ppu_ms.mean, 100 * f.ppu_share, f.gather_ms.mean, f.solve_ms.mean, f.apply_ms.mean,
      f.contacts_ms.mean, f.skin_ms.mean, f.physics_ms.mean);
  if (waits_for_pictures(options) && f.simulated_fps > 0)
    fmt::print("           {} a second without pictures\n", frame_rate(f.simulated_fps));
  if (f.pictures > 0) fmt::print("a picture: {:.1f} ms\n", f.picture_ms.mean);
  if (!f.spe_busy.empty()) {
    fmt::print("SPEs:      {} at work, busy {:.1f} % of the time (the busiest {:.1f} %), {}, {:.1f} MB\n",
               f.spe_busy.size(), 100 * sum(f.spe_busy) / static_cast<double>(f.spe_busy.size()),
               100 * *std::ranges::max_element(f.spe_busy), counted(f.dma_commands, "DMA command"),
               static_cast<double>(f.dma_bytes) / 1e6);
  }
  if (f.on_ps3) print_on_ps3(*f.on_ps3, f.spe_busy.size());
  if (!options.headless)
    fmt::print("shown:     {:.1f} pictures a second\n",
               static_cast<double>(f.pictures) / std::max(f.seconds, 1e-9));
  fmt::print("state:     {:016x}", f.state_hash);
  if (options.headless) fmt::print("   picture: {:016x}", f.image_hash);
  fmt::print("\n");
  print_files(options);
}

}  // namespace softcell::tool
