// softcell demo 3d: simulates a scene, writes its pictures, reports what it cost.

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <stdexcept>

#include "interrupt.h"
#include "json_file.h"
#include "kernel_report.h"
#include "progress_bar.h"
#include "scene_file/scene_library.h"
#include "scene_view.h"
#include "simulation_3d.h"
#include "softcell/ls_sim/trace.h"
#include "softcell/render/offscreen_context.h"
#include "softcell/render/png_io.h"
#include "softcell/render/video.h"
#include "statistics.h"
#include "usage_error.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

constexpr int kFramesPerSecond = 60;
constexpr double kDefaultCellsAlongModel = 8;
constexpr int kExitFindings = 3;
constexpr int kExitInterrupted = 130;  // as a shell reports a process that SIGINT ended

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

std::optional<OwnModel> load_model(const Demo3dOptions& options) {
  if (!options.mesh) return std::nullopt;
  OwnModel model{.mesh = ppu::import_mesh(*options.mesh)};
  const ppu::Bounds box = ppu::bounds(model.mesh);
  const double longest = (box.high - box.low).maxCoeff();
  model.cell_size = static_cast<float>(options.cell.value_or(longest / kDefaultCellsAlongModel));
  ppu::fit(model.mesh, static_cast<float>(longest));  // centred, its size unchanged
  // Refused here, in the model's own units, before the scene scales both: the sentence has the user's
  // numbers.
  ppu::voxelize(model.mesh, model.cell_size);
  return model;
}

/// The folder of numbered frames. Frames of an earlier run are removed, so that what is there is of one run.
class FrameFolder {
 public:
  explicit FrameFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (!std::filesystem::is_directory(folder_)) {
      throw std::runtime_error("--out " + folder_.string() +
                               " is not a folder and cannot be made one: " + error.message());
    }
    static const std::regex numbered("frame_[0-9]{5,}\\.png");
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (std::regex_match(entry.path().filename().string(), numbered)) std::filesystem::remove(entry.path());
    }
  }

  void write(int frame, const render::Image& image) const {
    render::write_png(folder_ / fmt::format("frame_{:05}.png", frame), image, render::PngEffort::fast);
  }

 private:
  std::filesystem::path folder_;
};

/// Where pictures go: nowhere, files, a video. The GL context is made only when a picture is asked for.
class Pictures {
 public:
  Pictures(const Demo3dOptions& options, const Scene& scene, const Simulation3d& simulation) {
    if (options.out) folder_.emplace(*options.out);
    if (options.video) {
      if (const auto parent = options.video->parent_path(); !parent.empty()) {
        std::error_code ignored;  // what is wrong with the folder, the writer will say
        std::filesystem::create_directories(parent, ignored);
      }
      video_ = std::make_unique<render::VideoWriter>(*options.video, options.size.width, options.size.height,
                                                     kFramesPerSecond);
    }
    context_ = render::create_offscreen_context();
    renderer_ = std::make_unique<render::Renderer>(
        *context_, render::RendererSettings{.width = options.size.width, .height = options.size.height});
    view_ = std::make_unique<SceneView>(scene, simulation, *renderer_,
                                        options.lattice ? View::kLattice : View::kMesh);
  }

  bool every_frame() const { return folder_ || video_; }

  void take(int frame) {
    const auto begin = Clock::now();
    const render::Image& image = view_->draw();
    if (folder_) folder_->write(frame, image);
    if (video_) video_->add_frame(image);
    hash_ = render::image_hash(image);
    milliseconds_.push_back(milliseconds_since(begin));
  }

  void finish() {
    if (video_) video_->finish();
  }

  std::uint64_t last_hash() const { return hash_; }
  const std::vector<double>& milliseconds() const { return milliseconds_; }

 private:
  std::optional<FrameFolder> folder_;
  std::unique_ptr<render::VideoWriter> video_;
  std::unique_ptr<render::GlContext> context_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<SceneView> view_;
  std::uint64_t hash_ = 0;
  std::vector<double> milliseconds_;
};

/// What a run measured.
struct RunRecord {
  std::vector<double> physics_ms, ppu_ms, skin_ms, skin_wait_ms;
  double seconds = 0;  // of the frame loop, pictures included
  int frames = 0;

  void add(const FrameTimes& times) {
    physics_ms.push_back(times.physics_ms);
    ppu_ms.push_back(times.ppu_ms);
    skin_ms.push_back(times.skin_ms);
    skin_wait_ms.push_back(times.skin_wait_ms);
    ++frames;
  }

  /// Frames a second without pictures.
  double simulated_fps() const {
    const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
    const double total = sum(physics_ms) + sum(ppu_ms) + sum(skin_wait_ms);
    return total > 0 ? 1000.0 * frames / total : 0;
  }
};

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

nlohmann::ordered_json statistics_document(const std::string& scene, const Demo3dOptions& options,
                                           const Simulation3d& simulation, const RunRecord& record,
                                           const Pictures& pictures) {
  std::vector<double> busy;
  std::uint64_t bytes = 0, commands = 0, jobs = 0;
  for (const ls_sim::SpeStatistics& spe : simulation.spe_statistics()) {
    busy.push_back(record.seconds > 0 ? std::chrono::duration<double>(spe.busy).count() / record.seconds : 0);
    bytes += spe.dma.bytes();
    commands += spe.dma.commands();
    jobs += spe.jobs;
  }
  return {
      {"scene", scene},
      {"frames", record.frames},
      {"bodies", simulation.soft_bodies()},
      {"rigid_bodies", simulation.rigid_bodies()},
      {"particles", simulation.particles()},
      {"vertices", simulation.vertices()},
      {"spes", options.spes},
      {"dma", dma::to_string(options.schedule)},
      {"ppu_ms", to_json(summarize(record.ppu_ms))},
      {"physics_ms", to_json(summarize(record.physics_ms))},
      {"skin_ms", to_json(summarize(record.skin_ms))},
      {"skin_wait_ms", to_json(summarize(record.skin_wait_ms))},
      {"picture_ms", to_json(summarize(pictures.milliseconds()))},
      {"simulated_fps", record.simulated_fps()},
      {"seconds", record.seconds},
      {"late_frames", simulation.late_frames()},
      {"spe_busy", busy},
      {"spe_jobs", jobs},
      {"dma_bytes", bytes},
      {"dma_commands", commands},
      {"state_hash", fmt::format("{:016x}", simulation.state_hash())},
      {"image_hash", fmt::format("{:016x}", pictures.last_hash())},
  };
}

void print_summary(const nlohmann::ordered_json& s, const Demo3dOptions& options) {
  double busiest = 0, mean = 0;
  for (const double share : s["spe_busy"]) {
    busiest = std::max(busiest, share);
    mean += share / static_cast<double>(s["spe_busy"].size());
  }
  fmt::print("scene {}: {} frames, {} soft bodies and {} rigid ones, {} particles, {} vertices\n",
             s["scene"].get<std::string>(), s["frames"].get<int>(), s["bodies"].get<int>(),
             s["rigid_bodies"].get<int>(), s["particles"].get<int>(), s["vertices"].get<int>());
  fmt::print(
      "a frame:  PPU {:.2f} ms (of it {:.3f} ms to hand over the skinning), physics {:.2f} ms, pictures "
      "{:.1f} ms\n",
      s["ppu_ms"]["mean"].get<double>(), s["skin_ms"]["mean"].get<double>(),
      s["physics_ms"]["mean"].get<double>(), s["picture_ms"]["mean"].get<double>());
  fmt::print("          {:.0f} frames a second without pictures\n", s["simulated_fps"].get<double>());
  fmt::print(
      "SPEs:     {} at work, busy {:.1f} % of the time (the busiest {:.1f} %), {} DMA commands, {:.1f} MB\n",
      options.spes, 100 * mean, 100 * busiest, s["dma_commands"].get<std::uint64_t>(),
      static_cast<double>(s["dma_bytes"].get<std::uint64_t>()) / 1e6);
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

int run_demo_3d(const Demo3dOptions& options) {
  if (!options.headless) {
    throw UsageError(
        "this version has no window yet: run it with --headless, and --out or --video to see something");
  }
  render::pin_software_rasterizer();
  const std::optional<OwnModel> model = load_model(options);
  // Before any thread is started: a scene in Lua forks.
  const Scene scene = load_scene_3d(options.scene.value_or(model ? "drop" : "arena"), model);
  ls_sim::Findings findings;
  std::optional<ls_sim::Trace> trace;
  if (options.trace) trace.emplace(options.spes);
  Simulation3d simulation(scene, {.spes = options.spes,
                                  .schedule = options.schedule,
                                  .findings = options.checked ? &findings : nullptr,
                                  .trace = trace ? &*trace : nullptr});

  RunRecord record;
  const InterruptGuard guard;
  const auto begin = Clock::now();
  Pictures pictures(options, scene, simulation);
  {
    ProgressBar bar("demo 3d", static_cast<std::size_t>(options.frames));
    for (int frame = 0; frame < options.frames && !guard.interrupted(); ++frame) {
      record.add(simulation.step());
      if (pictures.every_frame()) pictures.take(frame);
      bar.show(static_cast<std::size_t>(frame) + 1);
    }
  }
  if (!pictures.every_frame() && !guard.interrupted()) pictures.take(record.frames - 1);
  simulation.finish();
  if (guard.interrupted()) {
    fmt::print(stderr, "softcell: interrupted after {} of {} frames; every frame that was written is whole\n",
               record.frames, options.frames);
    return kExitInterrupted;
  }
  record.seconds = milliseconds_since(begin) / 1000;
  pictures.finish();

  auto statistics = statistics_document(scene.name, options, simulation, record, pictures);
  const std::vector<ls_sim::Finding> found = findings.list();
  if (options.checked) statistics["findings"] = to_json(std::span(found));
  if (trace) trace->write(*options.trace);
  if (options.json) write_json(*options.json, statistics);
  print_summary(statistics, options);
  print_findings(found);
  return found.empty() ? 0 : kExitFindings;
}

}  // namespace softcell::demos
