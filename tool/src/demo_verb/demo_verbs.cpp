#include "demo_verbs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <regex>
#include <string>

#include "command_line/shared_options.h"
#include "scene/scene.h"
#include "scene_file/scene_library.h"
#include "softcell/soft_bodies/lattice.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

constexpr int kMaxFrames = 1'000'000;
constexpr int kMinPixels = 16, kMaxPixels = 8192;
constexpr int kMaxSupersample = 8;

demos::PictureSize parse_size(const std::string& text) {
  static const std::regex pattern("([0-9]{1,5})x([0-9]{1,5})");
  std::smatch match;
  demos::PictureSize size{0, 0};
  if (std::regex_match(text, match, pattern)) size = {std::stoi(match[1]), std::stoi(match[2])};
  const auto allowed = [](int pixels) { return pixels >= kMinPixels && pixels <= kMaxPixels; };
  if (!allowed(size.width) || !allowed(size.height)) {
    throw UsageError("--size " + text +
                     ": give WIDTHxHEIGHT in pixels, each 16 to 8192, for example 1280x720");
  }
  return size;
}

demos::View2d parse_view(const std::string& text) {
  if (text == "dots") return demos::View2d::kDots;
  if (text == "lattice") return demos::View2d::kLattice;
  if (text == "filled") return demos::View2d::kFilled;
  throw UsageError("--view " + text + ": give dots, lattice or filled");
}

demos::View parse_view_3d(const std::string& text) {
  if (text == "mesh") return demos::View::kMesh;
  if (text == "lattice") return demos::View::kLattice;
  if (text == "rotations") return demos::View::kRotations;
  if (text == "contacts") return demos::View::kContacts;
  throw UsageError("--view " + text + ": give mesh, lattice, rotations or contacts");
}

void parse_engine(const std::string& text, DemoOptions& options) {
  options.solver = text == "reference" ? demos::Solver::kReference : demos::Solver::kSpe;
  options.machine = text == "interpreter" ? ls_sim::Machine::kSpu : ls_sim::Machine::kHost;
  if (text != "native" && text != "interpreter" && text != "reference")
    throw UsageError("--engine " + text + ": give native, interpreter or reference");
}

ppu::ContactMethod parse_contacts(const std::string& text) {
  const auto found = std::ranges::find(demos::kContactMethods, text);
  if (found == demos::kContactMethods.end())
    throw UsageError("--contacts " + text + ": give spheres or surface");
  return static_cast<ppu::ContactMethod>(found - demos::kContactMethods.begin());
}

demos::Skin parse_skin(const std::string& text) {
  if (text == "spe") return demos::Skin::kSpe;
  if (text == "gpu") return demos::Skin::kGpu;
  throw UsageError("--skin " + text + ": give spe or gpu");
}

/// @return  whether the text is "z"
bool parse_up(const std::string& text) {
  if (text != "y" && text != "z") throw UsageError("--up " + text + ": give y or z");
  return text == "z";
}

class DemoVerbs final : public Verb {
 public:
  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* demo = command.add_subcommand("demo", "Run a demo: 2d, 3d");
    demo->require_subcommand(0, 1);
    add_2d(*demo, chosen);
    add_3d(*demo, chosen);
  }

 private:
  void add_2d(CLI::App& demo, Call& chosen) {
    CLI::App* d = demo.add_subcommand("2d", "Soft bodies in a Box2D world, stepped on six emulated SPEs");
    add_demo_options(*d, demo_2d_, "man");
    d->add_option(
         "--image", demo_2d_.image,
         "Cut out what is painted in this PNG picture and put it into the scene (default scene: picture)")
        ->type_name("FILE");
    accept_whole_number(
        d->add_option("--cells", demo_2d_.cells,
                      "Lattice cells along the longest side of what is painted, 2 to 256 (default: 20)"),
        2, ppu::kMaxLatticeCellsPerAxis)
        ->needs("--image")
        ->type_name("CELLS");
    d->add_option("--view", view_, "What is drawn of soft bodies (default: filled)")
        ->type_name("dots|lattice|filled");
    d->callback([&] {
      chosen = [this] {
        parse_texts(demo_2d_);
        demo_2d_.view = parse_view(view_);
        demo_2d_.view_name = view_;
        return run_demo_2d(demo_2d_);
      };
    });
  }

  void add_3d(CLI::App& demo, Call& chosen) {
    CLI::App* d =
        demo.add_subcommand("3d", "Soft bodies in a Bullet world, stepped and skinned on six emulated SPEs");
    add_demo_options(*d, demo_3d_, "arena");
    d->add_option(
         "--mesh", demo_3d_.model.mesh,
         "Put this glTF, OBJ, PLY or STL model into the scene, which must take one (default scene: drop)")
        ->type_name("FILE");
    d->add_option("--up", up_, "The model's axis that points upwards (default: y)")
        ->needs("--mesh")
        ->type_name("y|z");
    d->add_option("--unit", demo_3d_.model.unit,
                  "Length of one of the model's units in metres (default: the model gets the size of what it "
                  "replaces)")
        ->needs("--mesh")
        ->type_name("METRES");
    CLI::Option* const cells =
        accept_whole_number(
            d->add_option("--cells", demo_3d_.model.cells,
                          "Lattice cells along the model's longest side, 2 to 256 (default: 8)"),
            2, ppu::kMaxLatticeCellsPerAxis)
            ->needs("--mesh")
            ->type_name("CELLS");
    d->add_option("--cell", demo_3d_.model.cell,
                  "Edge of a lattice cell in the model's units, in place of --cells")
        ->needs("--mesh")
        ->excludes(cells)
        ->type_name("LENGTH");
    d->add_option("--tessellate", demo_3d_.model.tessellation,
                  "Halve edges of the model's triangles that are longer than this many cells, 0.125 to 100 "
                  "(with 1 the surface follows the lattice)")
        ->needs("--mesh")
        ->type_name("CELLS");
    d->add_option("--view", view_3d_, "What is drawn of soft bodies (default: mesh)")
        ->type_name("mesh|lattice|rotations|contacts");
    d->add_option("--turntable", demo_3d_.turntable,
                  "Move the camera around the scene once in this many seconds (with --headless)")
        ->type_name("SECONDS");
    d->add_option("--skin", skin_,
                  "Who makes mesh vertices from particles: spe (default), or gpu, a vertex shader")
        ->type_name("spe|gpu");
    d->callback([&] {
      chosen = [this] {
        parse_texts(demo_3d_);
        demo_3d_.skin = parse_skin(skin_);
        demo_3d_.model.z_up = parse_up(up_);
        demo_3d_.view = parse_view_3d(view_3d_);
        demo_3d_.view_name = view_3d_;
        return run_demo_3d(demo_3d_);
      };
    });
  }

  /// Adds the options that all demos have.
  void add_demo_options(CLI::App& d, DemoOptions& options, const std::string& default_scene) {
    d.add_flag("--headless", options.headless, "Run without a window, as fast as it goes");
    d.add_option("--contacts", contacts_,
                 "What soft bodies touch with: spheres, rigid ones at their outer particles (circles in two "
                 "dimensions), or surface, what is drawn (default: the scene's)")
        ->type_name("spheres|surface");
    d.add_option(
         "--scene", options.scene,
         "Scene by name, or a scene file; `softcell scenes` lists them (default: " + default_scene + ")")
        ->type_name("SCENE");
    accept_whole_number(
        d.add_option(
            "--frames", options.frames,
            "Frames of 1/60 s to simulate (default: the replay's; else the scene's, mostly 300, or in a "
            "window as many as you like)"),
        1, kMaxFrames)
        ->type_name("FRAMES");
    d.add_option(
         "--out", options.out,
         "Folder for numbered PNG frames (with --headless); those of an earlier run in it are removed")
        ->type_name("DIR");
    d.add_option("--video", options.video,
                 "Write a video to this file, which ends in .mp4, .webm, .gif or .apng (with --headless; "
                 "needs ffmpeg); "
                 "if the run is interrupted, the video has the frames up to then")
        ->type_name("FILE");
    accept_whole_number(d.add_option("--fps", options.fps,
                                     "Frames a second of the video, 1 to 60 (default: 60, in a .gif 20)"),
                        1, demos::FilmRate::kFramesPerSecond)
        ->needs("--video")
        ->type_name("FPS");
    accept_whole_number(
        d.add_option(
            "--supersample", options.supersample,
            "Draw pictures 1 to 8 times as large and make them smaller, for finer edges (with --headless; "
            "default: 1)"),
        1, kMaxSupersample)
        ->type_name("FACTOR");
    d.add_flag("--statistics", options.statistics,
               "Draw each frame's figures over its picture (with --headless; in a window S does)");
    d.add_option("--size", size_, "Size of pictures in pixels, or of the window (default: 1280x720)")
        ->type_name("WIDTHxHEIGHT");
    d.add_option("--ui-scale", options.ui_scale,
                 "Size of text and menus in a window, 0.5 to 4 (default: the scale of the display)")
        ->type_name("FACTOR");
    accept_whole_number(d.add_option("--spes", options.spes, "SPEs at work, 1 to 6 (default: 6)"), 1,
                        dma::kSpeCount)
        ->type_name("SPES");
    add_dma_option(d, schedule_);
    d.add_option("--engine", engine_,
                 "Who does shape matching: native, the SPEs (default); interpreter, the SPEs with the "
                 "kernels that a compiler for the "
                 "SPU has made; or reference, the PPU with Eigen")
        ->type_name("native|interpreter|reference");
    d.add_flag("--checked", options.checked,
               "Run the checked images of the kernels; findings end with status 3");
    d.add_option("--record", options.record, "Record the events of each frame, for --replay")
        ->type_name("FILE");
    d.add_option(
         "--replay", options.replay,
         "Replay what --record wrote, in place of the scene's script (default scene: the recorded one)")
        ->type_name("FILE");
    d.add_option("--save-scene", options.save_scene,
                 "At the end, save the scene as it is then: a scene file, which ends in .toml, and its state "
                 "beside it")
        ->type_name("FILE");
    add_trace_option(d, options.trace);
    add_json_option(d, options.json, "statistics");
    d.add_flag("--quiet", options.quiet, "Print errors only");
  }

  void parse_texts(DemoOptions& options) const {
    options.size = parse_size(size_);
    options.schedule = parse_dma(schedule_);
    parse_engine(engine_, options);
    if (contacts_) options.contacts = parse_contacts(*contacts_);
  }

  Demo2dOptions demo_2d_;
  Demo3dOptions demo_3d_;
  std::string size_ = "1280x720";
  std::string view_ = "filled";
  std::string view_3d_ = "mesh";
  std::string schedule_ = "eager";
  std::string engine_ = "native";
  std::string skin_ = "spe";
  std::string up_ = "y";
  std::optional<std::string> contacts_;
};

int run_scenes() {
  std::size_t width = 0;
  for (const demos::SceneListing& scene : demos::list_scenes()) width = std::max(width, scene.name.size());
  for (const demos::SceneListing& scene : demos::list_scenes())
    fmt::print("{:{}}  {}d  {}\n", scene.name, width, scene.dimension, scene.title);
  return 0;
}

class ScenesVerb final : public Verb {
 public:
  void add_to(CLI::App& command, Call& chosen) override {
    command.add_subcommand("scenes", "List the scenes")->callback([&] { chosen = run_scenes; });
  }
};

}  // namespace

std::unique_ptr<Verb> demo_verbs() { return std::make_unique<DemoVerbs>(); }
std::unique_ptr<Verb> scenes_verb() { return std::make_unique<ScenesVerb>(); }

}  // namespace softcell::tool
