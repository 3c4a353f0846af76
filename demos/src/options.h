#pragma once
// What the command line asks for, one struct for each verb.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kernel_task.h"
#include "simulation_options.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::demos {

struct PictureSize {
  int width = 1280;
  int height = 720;
};

/// What the demos have in common.
struct DemoOptions {
  bool headless = false;
  std::optional<std::string> scene;          ///< name or file
  std::optional<int> frames;                 ///< default: the scene's
  std::optional<std::filesystem::path> out;  ///< folder for numbered frames
  std::optional<std::filesystem::path> video;
  std::optional<std::filesystem::path> json;
  bool statistics = false;  ///< of each frame, over its picture
  PictureSize size;
  Solver solver = Solver::kSpe;
  int spes = 6;
  dma::Schedule schedule{};
  bool checked = false;  ///< run instrumented kernels
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> record;  ///< where to write what happens
  std::optional<std::filesystem::path> replay;  ///< a recording to do again, in place of the scene's script
  bool quiet = false;  ///< nothing but what goes wrong, not even progress on a terminal
};

/// What is drawn in three dimensions.
enum class View : std::uint8_t {
  kMesh,       ///< the skinned meshes
  kLattice,    ///< particles and the edges of cells
  kRotations,  ///< how shape matching has turned the region of each particle: axes, x red, y green, z blue
  kContacts,   ///< where bodies press on each other, and which way
};

inline constexpr int kViews = 4;

/// The scene's default: arena, or drop when a mesh is given.
struct Demo3dOptions : DemoOptions {
  std::optional<std::filesystem::path> mesh;  ///< the user's own model
  int cells = 8;                              ///< along the model's longest side
  std::optional<double> cell;                 ///< their size in the model's own units, in place of `cells`
  View view = View::kMesh;
  Skin skin = Skin::kSpe;
};

/// What is drawn of soft bodies in two dimensions.
enum class View2d : std::uint8_t {
  kDots,     ///< particles, the outer ones as large as they are to others
  kLattice,  ///< particles and the edges of cells
  kFilled,   ///< the cells as one shape
};

inline constexpr int kViews2d = 3;

/// The scene's default: man.
struct Demo2dOptions : DemoOptions {
  View2d view = View2d::kFilled;
};

struct BudgetOptions {
  std::optional<std::filesystem::path> json;
};

struct SpuRunOptions {
  KernelTask task;
  dma::Schedule schedule{};
  ls_sim::Clock clock = ls_sim::Clock::kHost;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> json;
};

struct SpuExploreOptions {
  KernelTask task;
  std::string task_text;  ///< the options that make the task, to be typed again
  std::uint64_t seeds = 100;
  bool quiet = false;  ///< no progress, even on a terminal
  std::optional<std::filesystem::path> json;
};

struct BenchOptions {
  std::string filter;  ///< regular expression; empty: all
  int rounds = 31;     ///< in each of which every benchmark runs once
  bool list = false;   ///< print names, measure nothing
  std::optional<std::filesystem::path> json;
};

struct ReportOptions {
  std::filesystem::path trace;
  std::filesystem::path out;
};

}  // namespace softcell::demos
