#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "demo/run_record.h"

namespace softcell::demos {

struct WindowOptions {
  std::string title;
  int width = 1280, height = 720;  ///< pixels
  std::optional<int> frames;       ///< to be played
  std::optional<float> ui_scale;   ///< of text and menus; none: as dense as the display is
};

/// Opens a window and plays in it, at 60 frames a second, until the user closes it, the options' number of frames
/// is reached, or a replay ends.
/// @param scenes       the first is shown; the user may switch to the next, or choose one.
/// @param interrupted  called in each frame; true ends the run
/// @return the last scene's run
/// @throws std::runtime_error  there is no display: the sentence says how to do without; or as Demo::step().
Run play(const WindowOptions& options, const std::vector<NamedDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted);

}  // namespace softcell::demos
