#pragma once

#include <string_view>
#include <vector>

#include "../interrupt.h"
#include "../run_record.h"

namespace softcell::demos {

/// Opens a window and plays in it, at 60 frames a second, until the user closes it, the options' number of
/// frames is over, or a replay is.
/// @param scenes  the first is shown; the user may go on to the next.
/// @return the last scene's run
/// @throws std::runtime_error  there is no display: the sentence says how to do without; or as Demo::step().
Run play(const DemoOptions& options, std::string_view verb, const std::vector<MakeDemo>& scenes,
         const SimulationOptions& how, const InterruptGuard& guard);

}  // namespace softcell::demos
