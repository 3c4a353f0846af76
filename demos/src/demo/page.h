#pragma once
// The text over the picture: the figures of the frame and, in a window, help.

#include <cstdint>
#include <string>
#include <vector>

#include "demo.h"
#include "scene/look.h"
#include "softcell/render/overlay.h"

namespace softcell::demos {

struct Page {
  Look look;
  int width = 0, height = 0;  ///< of the window, pixels

  std::string scene;
  int dimension = 2;
  DemoCounts counts;
  FrameTimes times;
  bool paused = false, replays = false;
  std::size_t spes = 0;                  ///< SPEs in use
  double spe_ms = 0;                     ///< of the busiest SPE in the previous frame
  std::vector<double> each_spe_ms = {};  ///< of each SPE
  std::uint64_t dma_bytes = 0;           ///< in the previous frame
  std::string notice = {};               ///< a message for the user; empty: none
};

inline constexpr float kMenuWidth = 310;   ///< of the menu with its margin, at scale 1, pixels
inline constexpr float kTextScale = 1.3f;  ///< of a page's text on displays of usual density

/// Draws the figures, and help or how to get it, in a window. Calls Dear ImGui: call it between begin() and end() of an overlay.
/// @param scale  of the text  @param shown_per_second  pictures that the window showed recently
void draw_page(const Page& page, float scale, double shown_per_second);

/// Draws the figures over the last frame of a renderer that draws into no window.
/// @param scale  of the text, as the overlay's
void draw_statistics(const Page& page, float scale, render::Overlay& overlay, render::Renderer& renderer);

/// Makes the pages of one demo. Call next() once per frame, so that it knows what the SPEs did in that frame. Used by one thread.
class DemoPages {
 public:
  /// @param times  of the frame that was stepped last  @param width,height  of the picture, pixels
  Page next(const Demo& demo, const FrameTimes& times, const Look& look, int width, int height);

 private:
  std::vector<ls_sim::SpeStatistics> before_;  // up to the previous frame
};

}  // namespace softcell::demos
