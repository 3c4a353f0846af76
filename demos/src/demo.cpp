#include "demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>

#include "demo_pictures.h"
#include "interrupt.h"
#include "json_file.h"
#include "kernel_report.h"
#include "one_line.h"
#include "output_files.h"
#include "progress_bar.h"
#include "run_record.h"
#include "scene_file/scene_library.h"
#include "softcell/render/offscreen_context.h"
#include "statistics.h"
#include "usage_error.h"
#include "window/play.h"

namespace softcell::demos {
namespace {

constexpr int kExitFindings = 3;

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

nlohmann::ordered_json statistics_document(const DemoOptions& options, const Demo& demo,
                                           const RunRecord& record) {
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

/// How far an interrupted run has come, and what there is of it.
void print_interrupted(const DemoOptions& options, const RunRecord& record) {
  if (record.frames == 0) {
    fmt::print(stderr, "softcell: interrupted before the first frame\n");
    return;
  }
  const std::string of = record.asked_frames ? fmt::format(" of {}", *record.asked_frames) : "";
  fmt::print(stderr, "softcell: interrupted after {}{} frames{}{}\n", record.frames, of,
             options.out ? "; every frame that was written is whole" : "",
             options.trace || options.json ? "; only a run to its end leaves a trace or statistics" : "");
}

Run run_headless(const DemoOptions& options, std::string_view verb, const MakeDemo& make,
                 const SimulationOptions& how, const InterruptGuard& guard) {
  render::pin_software_rasterizer();
  Run run{.demo = make(how), .record = {}};
  Demo& demo = *run.demo;
  RunRecord& record = run.record;
  record.interrupted = guard.interrupted();
  if (record.interrupted) return run;
  const int frames = options.frames.value_or(demo.frames());
  record.asked_frames = frames;

  const auto begin = std::chrono::steady_clock::now();
  Pictures pictures(options, demo);
  run_recorded(demo, [&] {
    ProgressBar bar(std::string(verb), static_cast<std::size_t>(frames), options.quiet);
    for (int frame = 0; frame < frames && !guard.interrupted(); ++frame) {
      const FrameTimes times = demo.step();
      record.add(times);
      pictures.follow(times);
      if (pictures.every_frame()) pictures.take(frame);
      bar.show(static_cast<std::size_t>(frame) + 1);
    }
    if (!pictures.every_frame() && !guard.interrupted()) pictures.take(record.frames - 1);
    demo.stop();
  });
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  record.interrupted = guard.interrupted();
  if (record.interrupted) return run;
  pictures.finish();
  record.picture_ms = pictures.milliseconds();
  record.upload_bytes = pictures.upload_bytes();
  record.image_hash = pictures.last_hash();
  return run;
}

bool is_mp4(const std::filesystem::path& file) {
  const std::filesystem::path ending = file.extension();
  return ending == ".mp4" || ending == ".MP4";
}

/// No output takes another's place or that of what the demo reads.
void check_files(const DemoOptions& options) {
  std::vector<NamedFile> written = written_files(options);
  check_distinct(written);
  if (options.scene && is_scene_file(*options.scene)) check_kept({{"the scene", *options.scene}}, written);
  // A recording may take the place of the one that is replayed.
  std::erase_if(written, [](const NamedFile& file) { return file.name == "--record"; });
  check_kept({{"--replay", options.replay}}, written);
}

}  // namespace

std::vector<NamedFile> written_files(const DemoOptions& options) {
  return {{"--video", options.video},
          {"--record", options.record},
          {"--trace", options.trace},
          {"--json", options.json}};
}

void run_recorded(Demo& demo, const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    try {
      demo.save_recording();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "softcell: %s\n", one_line(error.what()).c_str());
    }
    throw;
  }
  demo.save_recording();
}

int run_demo(const DemoOptions& options, std::string_view verb, const LoadScenes& load) {
  if (!options.headless && (options.out || options.video)) {
    throw UsageError("--out and --video write pictures without a window: give --headless too");
  }
  if (!options.headless && options.statistics)
    throw UsageError(
        "--statistics is for pictures without a window: give --headless too; in a window S shows them");
  if (options.video && !is_mp4(*options.video))
    throw UsageError("--video " + options.video->string() + ": give a file name that ends in .mp4");
  check_files(options);
  const InterruptGuard guard;     // before the first file is opened: nothing is to be left of any
  make_picture_folders(options);  // where other outputs may be wanted, too
  // A recording and a trace are of one scene.
  const std::vector<MakeDemo> scenes =
      load(!options.headless && !options.record && !options.replay && !options.trace);
  // What cannot be written is no surprise at the end of a long run.
  OutputFiles files;
  ls_sim::WholeFile* const trace_file = files.open(options.trace);
  ls_sim::WholeFile* const json_file = files.open(options.json);
  ls_sim::Findings findings;
  std::optional<ls_sim::Trace> trace;
  if (options.trace) trace.emplace(options.spes);
  const SimulationOptions how{.solver = options.solver,
                              .spes = options.spes,
                              .schedule = options.schedule,
                              .findings = options.checked ? &findings : nullptr,
                              .trace = trace ? &*trace : nullptr};
  const Run run = options.headless ? run_headless(options, verb, scenes.front(), how, guard)
                                   : play(options, verb, scenes, how, guard);
  if (run.record.interrupted) {
    print_interrupted(options, run.record);
    return kExitInterrupted;
  }

  auto statistics = statistics_document(options, *run.demo, run.record);
  const std::vector<ls_sim::Finding> found = findings.list();
  if (options.checked) statistics["findings"] = to_json(std::span(found));
  print_findings(found);  // before a file that cannot be written ends the run
  if (trace) trace->write(*trace_file);
  if (json_file != nullptr) write_json(*json_file, statistics);
  files.commit();
  if (!options.quiet) print_summary(statistics, options);
  run.demo->check_replay();
  return found.empty() ? 0 : kExitFindings;
}

}  // namespace softcell::demos
