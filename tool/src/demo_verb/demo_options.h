#pragma once
// The options of a demo from the command line.

#include <filesystem>
#include <optional>
#include <string>

#include "demo/pictures.h"
#include "input/input_log.h"
#include "scene/look.h"
#include "scene_file/own_model.h"
#include "scene_file/picture_cells.h"
#include "simulation/simulation_options.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/schedule.h"

namespace softcell::tool {

/// The options that the demos share.
struct DemoOptions : demos::PictureOptions, demos::RecordingFiles {
  bool headless = false;
  std::optional<std::string> scene;  ///< name or file
  std::optional<int> frames;         ///< default: the scene's
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> save_scene = {};  ///< at the end of the run
  demos::Solver solver = demos::Solver::kSpe;
  ls_sim::Machine machine = ls_sim::Machine::kHost;
  std::optional<ppu::ContactMethod> contacts = {};  ///< none: the scene's
  int spes = dma::kSpeCount;
  dma::Schedule schedule{};
  bool checked = false;  ///< run instrumented kernels
  std::optional<std::filesystem::path> trace;
  std::string view_name = {};          ///< the value of --view
  std::optional<float> ui_scale = {};  ///< of text and menus in a window
  bool quiet = false;                  ///< prints errors only, not even progress on a terminal
};

/// The default scene is arena, or drop if a mesh is given.
struct Demo3dOptions : DemoOptions {
  demos::OwnModelOptions model;
  demos::View view = demos::View::kMesh;
  demos::Skin skin = demos::Skin::kSpe;
};

/// The default scene is man, or picture if a picture is given.
struct Demo2dOptions : DemoOptions {
  std::optional<std::filesystem::path> image;  ///< the user's own picture
  int cells = demos::kCellsAlongPicture;       ///< along the longest side of its silhouette
  demos::View2d view = demos::View2d::kFilled;
};

}  // namespace softcell::tool
