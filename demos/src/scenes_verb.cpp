#include <fmt/format.h>

#include <algorithm>

#include "scene_file/scene_library.h"
#include "verbs.h"

namespace softcell::demos {

int run_scenes() {
  std::size_t width = 0;
  for (const SceneListing& scene : list_scenes()) width = std::max(width, scene.name.size());
  for (const SceneListing& scene : list_scenes())
    fmt::print("{:{}}  {}d  {}\n", scene.name, width, scene.dimension, scene.title);
  return 0;
}

}  // namespace softcell::demos
