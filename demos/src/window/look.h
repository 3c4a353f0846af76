#pragma once

namespace softcell::demos {

/// How a window shows a scene; none of it reaches the simulation.
struct Look {
  int view = 0;                          ///< View2d or View, as a number
  bool statistics = true, help = false;  ///< pages over the picture
  // Of the camera in three dimensions, about what it looks at:
  float turn = 0, rise = 0;  ///< radians, counter-clockwise from above and upwards
  float distance = 1;        ///< as a factor
};

}  // namespace softcell::demos
