// The command `softcell`: parses the command line, calls a verb, turns what goes wrong into one line and an
// exit status.

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <regex>
#include <stdexcept>

#include "command_line/command_tree.h"
#include "command_line/manual_page.h"
#include "command_line/shell_completion.h"
#include "command_line/usage_sentence.h"
#include "command_line/whole_number.h"
#include "kernel_task_options.h"
#include "one_line.h"
#include "softcell/soft_bodies/lattice.h"
#include "usage_error.h"
#include "verbs.h"

namespace {

using namespace softcell;
using namespace softcell::demos;

constexpr int kMaxFrames = 1'000'000;
constexpr int kMinPixels = 16, kMaxPixels = 8192;
constexpr int kMaxRounds = 100'000;
constexpr std::uint64_t kMaxSeeds = 1'000'000'000;
constexpr const char* kTraceHelp = "Write a trace of what happened when; `softcell report` shows it";
constexpr const char* kDmaValues = "eager|lazy|random:SEED";
constexpr const char* kDmaHelp = "When transfers finish (default: eager)";

PictureSize parse_size(const std::string& text) {
  static const std::regex pattern("([0-9]{1,5})x([0-9]{1,5})");
  std::smatch match;
  PictureSize size{0, 0};
  if (std::regex_match(text, match, pattern)) size = {std::stoi(match[1]), std::stoi(match[2])};
  const auto allowed = [](int pixels) { return pixels >= kMinPixels && pixels <= kMaxPixels; };
  if (!allowed(size.width) || !allowed(size.height)) {
    throw UsageError("--size " + text +
                     ": give WIDTHxHEIGHT in pixels, each 16 to 8192, for example 1280x720");
  }
  return size;
}

dma::Schedule parse_dma(const std::string& text) {
  try {
    return dma::parse_schedule(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--dma " + text + ": " + error.what());
  }
}

ls_sim::Clock parse_clock(const std::string& text) {
  if (text == "host") return ls_sim::Clock::kHost;
  if (text == "simulated") return ls_sim::Clock::kSimulated;
  throw UsageError("--clock " + text + ": give host or simulated");
}

View2d parse_view(const std::string& text) {
  if (text == "dots") return View2d::kDots;
  if (text == "lattice") return View2d::kLattice;
  if (text == "filled") return View2d::kFilled;
  throw UsageError("--view " + text + ": give dots, lattice or filled");
}

View parse_view_3d(const std::string& text) {
  if (text == "mesh") return View::kMesh;
  if (text == "lattice") return View::kLattice;
  if (text == "rotations") return View::kRotations;
  if (text == "contacts") return View::kContacts;
  throw UsageError("--view " + text + ": give mesh, lattice, rotations or contacts");
}

Solver parse_engine(const std::string& text) {
  if (text == "native") return Solver::kSpe;
  if (text == "reference") return Solver::kReference;
  throw UsageError("--engine " + text + ": give native or reference");
}

Skin parse_skin(const std::string& text) {
  if (text == "spe") return Skin::kSpe;
  if (text == "gpu") return Skin::kGpu;
  throw UsageError("--skin " + text + ": give spe or gpu");
}

/// Adds every verb to the parser; `chosen` becomes the call that the command line asks for.
class CommandLine {
 public:
  CommandLine() {
    app_.require_subcommand(0, 1);
    app_.set_version_flag("--version", "softcell " SOFTCELL_VERSION);
    add_demo();
    add_spu();
    add_scenes();
    add_bench();
    add_report();
    add_shell();
  }

  int run(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) throw UsageError(usage_sentence(app_, error));
      if (const auto sentence = more_behind_help(app_, argc, argv)) throw UsageError(*sentence);
      return app_.exit(error);  // --help, --version
    }
    if (const auto sentence = empty_value(app_)) throw UsageError(*sentence);
    if (!chosen_) throw UsageError(verbs_sentence(app_));
    return chosen_();
  }

  /// That was called; the command itself before run().
  std::string verb() const { return called_verb(app_); }

 private:
  void add_demo() {
    CLI::App* demo = app_.add_subcommand("demo", "Run a demo: 2d, 3d");
    demo->require_subcommand(0, 1);
    add_demo_2d(*demo);
    add_demo_3d(*demo);
  }

  void add_demo_2d(CLI::App& demo) {
    CLI::App* d = demo.add_subcommand("2d", "Soft bodies in a Box2D world, stepped on six emulated SPEs");
    add_demo_options(*d, demo_2d_, "man");
    d->add_option("--view", view_, "What is drawn of soft bodies (default: filled)")
        ->type_name("dots|lattice|filled");
    d->callback([this] {
      chosen_ = [this] {
        parse_texts(demo_2d_);
        demo_2d_.view = parse_view(view_);
        return run_demo_2d(demo_2d_);
      };
    });
  }

  void add_demo_3d(CLI::App& demo) {
    CLI::App* d = demo.add_subcommand("3d", "Soft bodies in a Bullet world, skinned on six emulated SPEs");
    add_demo_options(*d, demo_3d_, "arena");
    d->add_option("--mesh", demo_3d_.mesh, "Put this OBJ, PLY or STL model into the scene (default: drop)")
        ->type_name("FILE");
    CLI::Option* const cells =
        take_whole_number(d->add_option("--cells", demo_3d_.cells,
                                        "Lattice cells along the model's longest side (default: 8)"),
                          2, ppu::kMaxLatticeCellsPerAxis)
            ->needs("--mesh")
            ->type_name("CELLS");
    d->add_option("--cell", demo_3d_.cell, "Edge of a lattice cell in the model's units, in place of --cells")
        ->needs("--mesh")
        ->excludes(cells)
        ->type_name("LENGTH");
    d->add_option("--view", view_3d_, "What is drawn of soft bodies (default: mesh)")
        ->type_name("mesh|lattice|rotations|contacts");
    d->add_option("--skin", skin_,
                  "Who makes mesh vertices from particles: spe (default), or gpu, a vertex shader")
        ->type_name("spe|gpu");
    d->callback([this] {
      chosen_ = [this] {
        parse_texts(demo_3d_);
        demo_3d_.skin = parse_skin(skin_);
        demo_3d_.view = parse_view_3d(view_3d_);
        return run_demo_3d(demo_3d_);
      };
    });
  }

  /// What all demos have.
  void add_demo_options(CLI::App& d, DemoOptions& options, const std::string& default_scene) {
    d.add_flag("--headless", options.headless, "Run without a window, as fast as it goes");
    d.add_option(
         "--scene", options.scene,
         "Scene by name, or a scene file; `softcell scenes` lists them (default: " + default_scene + ")")
        ->type_name("SCENE");
    take_whole_number(
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
                 "Write a video to this file, which ends in .mp4 (with --headless; needs ffmpeg)")
        ->type_name("FILE");
    d.add_flag("--statistics", options.statistics,
               "Draw each frame's figures over its picture (with --headless; in a window S does)");
    d.add_option("--size", size_, "Size of pictures in pixels, or of the window (default: 1280x720)")
        ->type_name("WIDTHxHEIGHT");
    take_whole_number(d.add_option("--spes", options.spes, "SPEs at work, 1 to 6 (default: 6)"), 1, 6)
        ->type_name("SPES");
    d.add_option("--dma", schedule_, kDmaHelp)->type_name(kDmaValues);
    d.add_option("--engine", engine_,
                 "Who does shape matching: native, the SPEs (default), or reference, the PPU with Eigen")
        ->type_name("native|reference");
    d.add_flag("--checked", options.checked,
               "Run the instrumented flavour of the kernels; findings end with status 3");
    d.add_option("--record", options.record, "Write what happens in each frame, to be done again by --replay")
        ->type_name("FILE");
    d.add_option(
         "--replay", options.replay,
         "Do again what --record wrote, in place of the scene's script (default scene: the recorded one)")
        ->type_name("FILE");
    d.add_option("--trace", options.trace, kTraceHelp)->type_name("FILE");
    d.add_option("--json", options.json, "Write statistics to this file")->type_name("FILE");
    d.add_flag("--quiet", options.quiet, "Print nothing but what goes wrong");
  }

  void parse_texts(DemoOptions& options) const {
    options.size = parse_size(size_);
    options.schedule = parse_dma(schedule_);
    options.solver = parse_engine(engine_);
  }

  void add_spu() {
    CLI::App* spu = app_.add_subcommand("spu", "SPU kernels: run, explore, budget");
    spu->require_subcommand(0, 1);
    add_spu_run(*spu);
    add_spu_explore(*spu);
    CLI::App* b = spu->add_subcommand(
        "budget", "Local store of each kernel: sections, stack used, share of 256 KB, budget");
    b->add_option("--json", budget_.json, "Write the table to this file as well")->type_name("FILE");
    b->callback([this] { chosen_ = [this] { return run_budget(budget_); }; });
  }

  void add_spu_run(CLI::App& spu) {
    CLI::App* r = spu.add_subcommand(
        "run", "Run a kernel on your own data: softcell spu run saxpy.spu.elf --in x=x.bin --arg @x 1024");
    run_task_.add_to(*r);
    r->add_option("--dma", schedule_, kDmaHelp)->type_name(kDmaValues);
    r->add_option(
         "--clock", clock_,
         "What time is to the kernel: host (default), or simulated, where it advances with each channel "
         "operation and SPEs take turns, so that a run is the same every time")
        ->type_name("host|simulated");
    r->add_option("--trace", run_.trace, kTraceHelp)->type_name("FILE");
    r->add_option("--json", run_.json, "Write statistics, findings and faults to this file as well")
        ->type_name("FILE");
    r->callback([this] {
      chosen_ = [this] {
        run_.task = run_task_.task();
        run_.schedule = parse_dma(schedule_);
        run_.clock = parse_clock(clock_);
        return run_spu_run(run_);
      };
    });
  }

  void add_spu_explore(CLI::App& spu) {
    CLI::App* e = spu.add_subcommand(
        "explore",
        "Run a kernel under many orders of its transfers and SPEs; all must have the same outcome");
    explore_task_.add_to(*e);
    take_whole_number(e->add_option("--seeds", explore_.seeds,
                                    "Orders to try: --dma random:1 to random:SEEDS (default: 100)"),
                      1, kMaxSeeds)
        ->type_name("SEEDS");
    e->add_flag("--quiet", explore_.quiet, "No progress bar");
    e->add_option("--json", explore_.json, "Write the result to this file as well")->type_name("FILE");
    e->callback([this] {
      chosen_ = [this] {
        explore_.task = explore_task_.task();
        explore_.task_text = explore_task_.text();
        return run_spu_explore(explore_);
      };
    });
  }

  void add_scenes() {
    app_.add_subcommand("scenes", "List the scenes")->callback([this] { chosen_ = run_scenes; });
  }

  void add_bench() {
    CLI::App* b = app_.add_subcommand("bench", "Measure kernels, side by side in one run");
    b->add_option("--filter", bench_.filter,
                  "Only benchmarks in whose name this regular expression is found; others are not even built")
        ->type_name("REGEX");
    take_whole_number(
        b->add_option("--rounds", bench_.rounds,
                      "How often each is run, in turn; minimum and median are reported (default: 31)"),
        1, kMaxRounds)
        ->type_name("ROUNDS");
    b->add_flag("--list", bench_.list, "Print the names of the benchmarks and measure nothing");
    b->add_option("--json", bench_.json, "Write the figures to this file as well")->type_name("FILE");
    b->callback([this] { chosen_ = [this] { return run_bench(bench_); }; });
  }

  void add_report() {
    CLI::App* r = app_.add_subcommand("report", "Make a page to look at of what --trace recorded");
    r->add_option("TRACE", report_.trace, "The file that --trace wrote")->required()->type_name("FILE");
    r->add_option("--out", report_.out, "HTML page to write; it opens offline")
        ->required()
        ->type_name("FILE");
    r->callback([this] { chosen_ = [this] { return run_report(report_); }; });
  }

  void add_shell() {
    CLI::App* c =
        app_.add_subcommand("completion", "Print a script for the shell that completes softcell's commands");
    c->add_option("SHELL", shell_, "bash or zsh: source <(softcell completion bash)")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh"}).description(""))
        ->type_name("bash|zsh");
    c->callback([this] {
      chosen_ = [this] {
        const CommandVerb tree = command_tree(app_);
        std::fputs((shell_ == "zsh" ? zsh_completion(tree) : bash_completion(tree)).c_str(), stdout);
        return 0;
      };
    });
    app_.add_subcommand("man", "Print the manual page: softcell man | man -l -")->callback([this] {
      chosen_ = [this] {
        std::fputs(manual_page(command_tree(app_), SOFTCELL_VERSION).c_str(), stdout);
        return 0;
      };
    });
  }

  CLI::App app_{"Runs Cell/PS3 SPU job kernels on a PC; its main workload are FastLSM soft bodies.",
                "softcell"};
  Demo2dOptions demo_2d_;
  Demo3dOptions demo_3d_;
  KernelTaskOptions run_task_, explore_task_;
  SpuRunOptions run_;
  SpuExploreOptions explore_;
  BudgetOptions budget_;
  BenchOptions bench_;
  ReportOptions report_;
  std::string size_ = "1280x720";
  std::string view_ = "filled";
  std::string view_3d_ = "mesh";
  std::string schedule_ = "eager";
  std::string engine_ = "native";
  std::string skin_ = "spe";
  std::string clock_ = "host";
  std::string shell_;
  std::function<int()> chosen_;
};

/// What was printed may still wait in the stream, and a full disk shows when it goes out.
void finish_printing() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("cannot write to standard output: ") + std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CommandLine command_line;
    try {
      const int status = command_line.run(argc, argv);
      finish_printing();
      return status;
    } catch (const UsageError& error) {
      std::fprintf(stderr, "softcell: %s (%s --help lists what is allowed)\n", one_line(error.what()).c_str(),
                   command_line.verb().c_str());
      return 2;
    }
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "softcell: there is not enough memory\n");
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softcell: %s\n", one_line(error.what()).c_str());
    return 1;
  }
}
