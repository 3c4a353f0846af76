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
  std::optional<int> frames;       ///< after which the run ends; none: no such limit
  std::optional<float> ui_scale;   ///< of text and menus; none: that of the display
};

/// Opens a window and plays scenes in it at 60 frames a second, until the user closes it, the options' number of frames is reached, or a
/// replay ends.
/// @param scenes       the first is shown; the user may switch to the next or choose one.
/// @param interrupted  called in each frame; if it returns true, the run ends
/// @return the run of the last scene
/// @throws std::runtime_error  there is no display: the message says how to run without one; or as Demo::step().
Run play(const WindowOptions& options, const std::vector<NamedDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted);

}  // namespace softcell::demos
