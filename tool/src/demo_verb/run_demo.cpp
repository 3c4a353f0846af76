#include "run_demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "demo/pictures.h"
#include "demo/run_record.h"
#include "demo_statistics.h"
#include "scene_file/scene_library.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/addresses.h"
#include "softcell/render/offscreen_context.h"
#include "softcell/render/png_io.h"
#include "softcell/render/video.h"
#include "spu/kernel_report.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"
#include "verb/output_files.h"
#include "verb/progress_bar.h"
#include "verb/verb_files.h"
#include "window/play.h"

namespace softcell::tool {
namespace {

/// Prints how far an interrupted run has come, and which output exists.
void print_interrupted(const DemoOptions& options, const demos::RunRecord& record) {
  if (record.frames == 0) {
    fmt::print(stderr, "softcell: interrupted before the first frame\n");
    return;
  }
  const int all = record.asked_frames.value_or(record.frames);
  fmt::print(stderr, "softcell: interrupted after {}{}{}{}{}{}\n",
             record.asked_frames ? fmt::format("{} of ", record.frames) : "",
             base::counted(static_cast<std::uint64_t>(all), "frame"),
             options.out ? "; every frame that was written is whole" : "",
             options.video ? "; the video has them" : "", options.record ? "; the recording has them" : "",
             options.trace || options.json || options.save_scene
                 ? "; only a run to its end leaves a trace, statistics or a saved scene"
                 : "");
}

/// How pictures are made, for their files. Folders and files of this computer are left out, since they concern nobody else.
std::vector<render::PngText> picture_texts(const DemoOptions& options, std::string_view verb,
                                           const std::string& scene) {
  std::string how = fmt::format(
      "softcell {} --headless --scene {} --size {}x{} --spes {} --dma {} --engine {}", verb, scene,
      options.size.width, options.size.height, options.spes, dma::to_string(options.schedule),
      options.solver == demos::Solver::kReference ? "reference"
      : options.machine == ls_sim::Machine::kSpu  ? "interpreter"
                                                  : "native");
  if (!options.view_name.empty()) how += " --view " + options.view_name;
  if (options.supersample > 1) how += fmt::format(" --supersample {}", options.supersample);
  if (options.turntable) how += fmt::format(" --turntable {}", *options.turntable);
  if (options.contacts)
    how += *options.contacts == ppu::ContactMethod::kSpheres ? " --contacts spheres" : " --contacts surface";
  if (options.statistics) how += " --statistics";
  if (options.checked) how += " --checked";
  if (options.replay) how += " --replay";
  return {{"Software", "softcell " SOFTCELL_VERSION}, {"Scene", scene}, {"Command", how}};
}

demos::Run run_headless(const DemoOptions& options, std::string_view verb, const demos::MakeDemo& make,
                        const demos::SimulationOptions& how, const InterruptGuard& guard) {
  render::pin_software_rasterizer();
  demos::Run run{.demo = make(how), .record = {}};
  demos::Demo& demo = *run.demo;
  demos::RunRecord& record = run.record;
  record.interrupted = guard.interrupted();
  if (record.interrupted) return run;
  const int frames = options.frames.value_or(demo.frames());
  SC_ASSERT(frames >= 0, "{} frames of scene '{}'", frames, demo.scene_name());
  record.asked_frames = frames;

  const auto begin = std::chrono::steady_clock::now();
  demos::PictureOptions how_drawn = options;
  how_drawn.texts = picture_texts(options, verb, demo.scene_name());
  demos::Pictures pictures(how_drawn, demo);
  demos::run_recorded(demo, [&] {
    ProgressBar bar(std::string(verb), static_cast<std::size_t>(frames), options.quiet);
    for (int frame = 0; frame < frames && !guard.interrupted(); ++frame) {
      const demos::FrameTimes times = demo.step();
      record.add(times);
      pictures.follow(times);
      if (pictures.every_frame()) pictures.add(frame);
      bar.show(static_cast<std::size_t>(frame) + 1);
    }
    if (!pictures.every_frame() && !guard.interrupted())
      pictures.add(std::max(record.frames - 1, 0));  // a replay may have no frames
    demo.stop();
  });
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  record.interrupted = guard.interrupted();
  if (record.frames > 0) pictures.finish();  // the film of an interrupted run has the frames so far
  if (record.interrupted) return run;
  record.picture_ms = pictures.milliseconds();
  record.upload_bytes = pictures.upload_bytes();
  record.image_hash = pictures.last_hash();
  return run;
}

/// Refuses what has no meaning with a window, or without one.
void check_window_options(const DemoOptions& options) {
  if (!options.headless && (options.out || options.video)) {
    throw UsageError("--out and --video write pictures without a window: give --headless too");
  }
  if (!options.headless && options.statistics)
    throw UsageError(
        "--statistics is for pictures without a window: give --headless too; in a window S shows them");
  if (options.ui_scale && !(*options.ui_scale >= 0.5f && *options.ui_scale <= 4))
    throw UsageError(fmt::format("--ui-scale {}: give a number from 0.5 to 4", *options.ui_scale));
  if (options.ui_scale && options.headless)
    throw UsageError("--ui-scale is for text and menus in a window: leave out --headless");
}

/// Checks what can be checked of a film and its pictures before they are made.
void check_pictures(const DemoOptions& options) {
  if (options.supersample > 1) {
    if (!options.headless)
      throw UsageError("--supersample is for pictures without a window: give --headless too");
    constexpr int kMaxDrawn = 16384;  // pixels a side, as llvmpipe draws them
    if (options.supersample * std::max(options.size.width, options.size.height) > kMaxDrawn) {
      throw UsageError(
          fmt::format("--supersample {}: pictures of {}x{} would be drawn with more than {} pixels a side",
                      options.supersample, options.size.width, options.size.height, kMaxDrawn));
    }
  }
  const char* const drawn = options.statistics ? "--statistics" : options.turntable ? "--turntable" : nullptr;
  if (drawn != nullptr && !options.out && !options.video)
    throw UsageError(fmt::format("{} shows in pictures only: give --out or --video too", drawn));
  if (!options.video) return;
  const std::optional<render::VideoFormat> format = render::video_format(*options.video);
  if (!format) {
    throw UsageError(fmt::format("--video {}: give a file name that ends in {}", options.video->string(),
                                 render::kVideoEndings));
  }
  const int highest = render::highest_frame_rate(*format);
  if (options.fps && *options.fps > highest) {
    throw UsageError(fmt::format("--fps {}: {} shows at most {} frames a second", *options.fps,
                                 options.video->extension().string(), highest));
  }
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = base::utf8_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

/// Checks that no output replaces another one or a file that the demo reads.
void check_files(const DemoOptions& options) {
  refuse_standard_output({"--save-scene", options.save_scene});
  if (options.save_scene && options.save_scene->extension() != ".toml")
    throw UsageError(
        fmt::format("--save-scene {}: give a file name that ends in .toml", options.save_scene->string()));
  if (options.save_scene && !is_utf8(options.save_scene->filename().string()))
    throw UsageError(fmt::format("--save-scene {}: give a file name in UTF-8; the scene names its state file",
                                 options.save_scene->string()));
  std::vector<NamedFile> written = written_files(options);
  check_distinct(written);
  for (const NamedFile& file : {NamedFile{"--record", options.record}, {"--out", options.out}})
    refuse_standard_output(file);
  if (options.scene && demos::is_scene_file(*options.scene))
    check_kept({{"the scene", *options.scene}}, written);
  // A recording may replace the one that is replayed.
  std::erase_if(written, [](const NamedFile& file) { return file.name == "--record"; });
  check_kept({{"--replay", options.replay}}, written);
}

/// The state file beside a saved scene.
std::optional<std::filesystem::path> state_of(std::optional<std::filesystem::path> scene) {
  if (scene) scene->replace_extension(".state");
  return scene;
}

/// Refuses a scene that cannot be written now, not at the end of a long run.
void check_saved_scene(const DemoOptions& options) {
  if (!options.save_scene) return;
  const base::WholeFile scene(*options.save_scene), state(*state_of(options.save_scene));
}

/// @param findings, trace, timing  null: there are none
demos::SimulationOptions simulation_options(const DemoOptions& options, ls_sim::Findings* findings,
                                            ls_sim::Trace* trace, ls_sim::Timing* timing) {
  SC_ASSERT(options.spes >= 1 && options.spes <= dma::kSpeCount, "{} SPEs of {}", options.spes,
            dma::kSpeCount);
  return {.solver = options.solver,
          .machine = options.machine,
          .contacts = options.contacts,
          .spes = options.spes,
          .schedule = options.schedule,
          .findings = findings,
          .trace = trace,
          .timing = timing};
}

}  // namespace

std::vector<NamedFile> written_files(const DemoOptions& options) {
  return {{"--video", options.video},           {"--record", options.record},
          {"--trace", options.trace},           {"--json", options.json},
          {"--save-scene", options.save_scene}, {"the state of --save-scene", state_of(options.save_scene)}};
}

void check_scene_kept(const std::vector<std::filesystem::path>& scene, const DemoOptions& options) {
  for (const std::filesystem::path& file : scene)
    check_kept({{"a file of the scene", file}}, written_files(options));
}

std::string scene_to_load(const DemoOptions& options, int dimension,
                          const std::optional<std::string>& recorded, const std::string& usual) {
  if (options.scene) return *options.scene;
  if (!recorded) return usual;
  SC_ASSERT(options.replay, "a recording of the scene {} has no name", *recorded);
  // A recording may name any file, and is no reason to run a script.
  const auto is_it = [&](const demos::SceneListing& listing) {
    return listing.dimension == dimension && listing.name == *recorded;
  };
  if (std::ranges::any_of(demos::list_scenes(), is_it)) return *recorded;
  throw std::runtime_error(
      fmt::format("{}: a recording of the scene {}, which does not come with softcell; give its file with "
                  "--scene",
                  options.replay->string(), *recorded));
}

int run_demo(const DemoOptions& options, std::string_view verb, const LoadScenes& load) {
  check_window_options(options);
  check_pictures(options);
  check_files(options);
  const InterruptGuard guard;  // before the first file is opened, so that no part of one is left
  const demos::PictureFolders folders(options);  // other outputs may go there as well
  OutputFiles files(written_files(options));
  check_saved_scene(options);
  // A recording or a trace belongs to one scene.
  const std::vector<demos::NamedDemo> scenes =
      load(!options.headless && !options.record && !options.replay && !options.trace);
  SC_ASSERT(!scenes.empty(), "{} runs no scene", verb);
  // Opened now, so that a file that cannot be written is refused before a long run.
  base::WholeFile* const trace_file = files.open(options.trace);
  base::WholeFile* const json_file = files.open(options.json);
  ls_sim::Findings findings;
  // For kernels built for the SPU, each run has the times that it would take on a PS3.
  std::optional<ls_sim::Timing> timing;
  if (options.machine == ls_sim::Machine::kSpu) timing.emplace(options.spes);
  std::optional<ls_sim::Trace> trace;
  if (options.trace)
    trace.emplace(options.spes, ls_sim::Trace::kMostEvents,
                  timing ? ls_sim::TraceClock::kSimulated : ls_sim::TraceClock::kHost);
  const demos::SimulationOptions how = simulation_options(
      options, options.checked ? &findings : nullptr, trace ? &*trace : nullptr, timing ? &*timing : nullptr);
  const demos::Run run = options.headless ? run_headless(options, verb, scenes.front().make, how, guard)
                                          : demos::play({.title = "softcell " + std::string(verb),
                                                         .width = options.size.width,
                                                         .height = options.size.height,
                                                         .frames = options.frames,
                                                         .ui_scale = options.ui_scale},
                                                        scenes, how, [&] { return guard.interrupted(); });
  if (run.record.interrupted) {
    print_interrupted(options, run.record);
    return kExitInterrupted;
  }

  const demos::DemoCounts counts = run.demo->counts();
  if (!options.quiet && counts.soft_bodies + counts.rigid_bodies == 0)
    fmt::print(stderr, "softcell: the scene {} has no bodies\n", run.demo->scene_name());
  const DemoFigures figures = demo_figures(options, *run.demo, run.record, timing ? &*timing : nullptr);
  const std::vector<ls_sim::Finding> found = findings.list();
  print_findings(found);       // before a file that cannot be written may end the run
  std::exception_ptr refused;  // a scene that cannot be saved takes nothing else of the run with it
  if (options.save_scene) {
    try {
      run.demo->save_scene(options.save_scene);
    } catch (const std::runtime_error&) {
      refused = std::current_exception();
    }
  }
  if (trace) trace->write(*trace_file);
  if (json_file != nullptr) {
    auto document = to_json(figures);
    if (options.checked) document["findings"] = to_json(std::span(found));
    write_json(*json_file, document);
  }
  files.commit();
  if (!options.quiet) print_summary(figures, options);
  if (refused) std::rethrow_exception(refused);
  run.demo->check_replay();
  return found.empty() ? 0 : kExitFindings;
}

}  // namespace softcell::tool
