#include "demo_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

namespace softcell::tool {
namespace {

/// Mean and order statistics of a series of measurements, in the unit of the measurements.
struct Summary {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};

/// All zero for an empty series.
Summary summarize(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto rank = [&](double share) {
    return samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1) + 0.5)];
  };
  const double sum = std::accumulate(samples.begin(), samples.end(), 0.0);
  return {sum / static_cast<double>(samples.size()), rank(0.5), rank(0.99), samples.back()};
}

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

}  // namespace

nlohmann::ordered_json statistics_document(const DemoOptions& options, const demos::Demo& demo,
                                           const demos::RunRecord& record) {
  const demos::DemoCounts counts = demo.counts();
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
      {"engine", options.solver == demos::Solver::kSpe ? "native" : "reference"},
      {"ppu_ms", to_json(summarize(record.ppu_ms))},
      {"ppu_share", record.ppu_share()},
      {"gather_ms", to_json(summarize(record.gather_ms))},
      {"solve_ms", to_json(summarize(record.solve_ms))},
      {"apply_ms", to_json(summarize(record.apply_ms))},
      {"physics_ms", to_json(summarize(record.physics_ms))},
      {"skin_ms", to_json(summarize(record.skin_ms))},
      {"solver_wait_ms", to_json(summarize(record.solver_wait_ms))},
      {"skin_wait_ms", to_json(summarize(record.skin_wait_ms))},
      {"picture_ms", to_json(summarize(record.picture_ms))},
      {"pictures", record.picture_ms.size()},
      {"upload_bytes", record.upload_bytes_of_a_picture()},
      {"simulated_fps", record.simulated_fps()},
      {"seconds", record.seconds},
      {"spe_busy", busy},
      {"spe_jobs", jobs},
      {"dma_bytes", bytes},
      {"dma_commands", commands},
      {"state_hash", fmt::format("{:016x}", demo.state_hash())},
      {"image_hash", fmt::format("{:016x}", record.image_hash)},
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
      "a frame:   PPU {:.3f} ms, {:.1f} % of 1/60 s (gather {:.3f}, solve {:.3f}, apply {:.3f}, hand over "
      "the skinning {:.3f}), physics {:.2f} ms\n",
      s["ppu_ms"]["mean"].get<double>(), 100 * s["ppu_share"].get<double>(),
      s["gather_ms"]["mean"].get<double>(), s["solve_ms"]["mean"].get<double>(),
      s["apply_ms"]["mean"].get<double>(), s["skin_ms"]["mean"].get<double>(),
      s["physics_ms"]["mean"].get<double>());
  fmt::print("           {:.0f} frames a second without pictures\n", s["simulated_fps"].get<double>());
  if (s["pictures"].get<std::size_t>() > 0)
    fmt::print("a picture: {:.1f} ms\n", s["picture_ms"]["mean"].get<double>());
  if (!s["spe_busy"].empty()) {
    fmt::print(
        "SPEs:      {} at work, busy {:.1f} % of the time (the busiest {:.1f} %), {} DMA commands, {:.1f} "
        "MB\n",
        s["spes"].get<int>(), 100 * mean, 100 * busiest, s["dma_commands"].get<std::uint64_t>(),
        static_cast<double>(s["dma_bytes"].get<std::uint64_t>()) / 1e6);
  }
  if (!options.headless) {
    fmt::print(
        "shown:     {:.1f} pictures a second\n",
        static_cast<double>(s["pictures"].get<std::size_t>()) / std::max(s["seconds"].get<double>(), 1e-9));
  }
  fmt::print("state:     {}", s["state_hash"].get<std::string>());
  if (options.headless) fmt::print("   picture: {}", s["image_hash"].get<std::string>());
  fmt::print("\n");
  const auto where = [](const char* what, const std::optional<std::filesystem::path>& path) {
    if (path) fmt::print("{:<11}{}\n", what, path->string());
  };
  where("frames:", options.out);
  where("video:", options.video);
  where("recording:", options.record);
  where("trace:", options.trace);
  where("figures:", options.json);
}

}  // namespace softcell::tool
