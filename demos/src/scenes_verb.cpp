#include <fmt/format.h>

#include <algorithm>

#include "scene.h"
#include "verbs.h"

namespace softcell::demos {

int run_scenes() {
  std::size_t width = 0;
  for (const SceneEntry& entry : scenes()) width = std::max(width, entry.name.size());
  for (const SceneEntry& entry : scenes()) fmt::print("{:{}}  {}\n", entry.name, width, entry.description);
  return 0;
}

}  // namespace softcell::demos
