#pragma once
// What a demo did in a frame, as a page over its picture: the same in a window and without one.

#include <vector>

#include "../demo.h"
#include "page.h"

namespace softcell::demos {

/// Follows one demo: asked once for each frame, so that it knows what the SPEs did in it. Used by one thread.
class DemoPages {
 public:
  /// @param times  of the frame that was stepped last  @param width,height  of the picture, pixels
  Page next(const Demo& demo, const FrameTimes& times, const Look& look, int width, int height);

 private:
  std::vector<ls_sim::SpeStatistics> before_;  // up to the frame before
};

}  // namespace softcell::demos
