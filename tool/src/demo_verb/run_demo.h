#pragma once
// Runs a demo with or without a window, and loads its scenes.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "demo/demo.h"
#include "demo_options.h"
#include "scene_file/save_scene.h"
#include "scene_file/scene_library.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "verb/verb_files.h"

namespace softcell::tool {

/// The files that the options ask for, except pictures in folders.
std::vector<NamedFile> written_files(const DemoOptions& options);

/// @param scene  the files that it was read from
/// @throws UsageError  an output would replace one of them.
void check_scene_kept(const std::vector<std::filesystem::path>& scene, const DemoOptions& options);

/// The name or file of the scene that the options ask for: in a replay without --scene the recorded one.
/// @param recorded  the name in the recording; none: this is no replay   @param usual  without either
/// @throws std::runtime_error  the recorded scene does not come with softcell
std::string scene_to_load(const DemoOptions& options, int dimension,
                          const std::optional<std::string>& recorded, const std::string& usual);

/// Loads the scene that the options ask for; with `all` also the scenes of the same dimension that come with softcell. The demo begins with
/// the first one.
using LoadScenes = std::function<std::vector<demos::NamedDemo>(bool all)>;

/// Runs a demo with or without a window: steps it, writes its pictures, and reports what it cost.
/// @param verb  "demo 3d"   @param load  is called once, before threads are started, because scenes in Lua fork
/// @return the exit status: 0, 3 when checked kernels have findings, or 130 when interrupted.
/// @throws UsageError  the options ask for files that a window does not write, for a video of no known format, or for a file in the place
/// of another one that is written or read.
int run_demo(const DemoOptions& options, std::string_view verb, const LoadScenes& load);

/// Writes the files that `saved` returns for the path. @param file  none: a free name  @return the path
/// @throws std::runtime_error  as for saved(), or the files cannot be written
template <class SceneOf, class Saved>
std::filesystem::path write_scene(const SceneOf& scene, const std::optional<std::filesystem::path>& file,
                                  const Saved& saved) {
  const std::filesystem::path path = file ? *file : demos::free_scene_file(scene.document.get(), scene.name);
  demos::write_scene_files(saved(path));
  return path;
}

/// @param log    has begun with `first`.
/// @param first  the scene to begin with; with `all` it is followed by those of its dimension that come with softcell.
/// @param load   loads a built-in scene by name. A scene that cannot be loaded is left out with a message: its model may not
///               be installed.
/// @tparam OneDemo  a SceneDemo, which is made from a scene, a log, SimulationOptions and the options.
template <class OneDemo, class Options>
std::vector<demos::NamedDemo> demos_of(const Options& options, const typename OneDemo::Log& log,
                                       const typename OneDemo::Scene& first, bool all,
                                       typename OneDemo::Scene (*load)(std::string_view)) {
  std::vector<demos::NamedDemo> made;
  const auto add = [&](const typename OneDemo::Scene& scene) {
    made.push_back({scene.name, scene.title, [&options, scene, log](const demos::SimulationOptions& how) {
                      return std::make_unique<OneDemo>(scene, log, how, options);
                    }});
  };
  add(first);
  SC_ASSERT(load != nullptr, "nobody loads the scenes beside {}", first.name);
  if (!all) return made;
  for (const demos::SceneListing& listing : demos::list_scenes()) {
    if (listing.dimension != OneDemo::kDimension || listing.name == first.name) continue;
    try {
      add(load(listing.name));
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "softcell: scene {} is left out: {}\n", listing.name, base::one_line(error.what()));
    }
  }
  return made;
}

}  // namespace softcell::tool
