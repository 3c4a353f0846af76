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
};

/// Opens a window and plays in it, at 60 frames a second, until the user closes it, the options' number of
/// frames is over, or a replay is.
/// @param scenes       the first is shown; the user may go on to the next.
/// @param interrupted  is asked in each frame whether to end
/// @return the last scene's run
/// @throws std::runtime_error  there is no display: the sentence says how to do without; or as Demo::step().
Run play(const WindowOptions& options, const std::vector<MakeDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted);

}  // namespace softcell::demos
