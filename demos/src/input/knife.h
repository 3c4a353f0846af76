#pragma once
// The mouse as a knife in three dimensions: a straight stroke over the window cuts what is under it.

#include <SDL.h>

#include <functional>
#include <optional>
#include <vector>

#include "input_event.h"
#include "scene/look.h"
#include "scene/scene_camera.h"

namespace softcell::demos {

/// While Look::knife is on, the left button draws a stroke, which is seen meanwhile and cuts when the button is let go. It cuts all soft
/// bodies that are seen under it, also those that others hide.
class Knife {
 public:
  /// From where the scene is seen now.
  using Eye = std::function<render::Camera(const Look&)>;
  static constexpr int kShortest = 4;  ///< a stroke, in the units of SDL's mouse; a click cuts nothing

  /// Cuts nothing.
  Knife() = default;
  /// @param width, height  of the window, in the units in which SDL gives the mouse
  Knife(Eye eye, int width, int height);

  /// Appends what the event means.
  /// @return true: the event was the knife's
  bool handle(const SDL_Event& event, Look& look, std::vector<InputEvent<3>>& events);

 private:
  struct Point {
    int x = 0, y = 0;
  };
  void show(Look& look) const;
  void cut(const Look& look, std::vector<InputEvent<3>>& events) const;

  Eye eye_;
  int width_ = 1, height_ = 1;
  std::optional<Point> from_;  // none: nothing is being cut
  Point to_;
};

}  // namespace softcell::demos
