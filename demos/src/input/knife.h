#pragma once
// The mouse as a knife: a straight stroke over the window cuts what is under it.

#include <SDL.h>

#include <functional>
#include <optional>
#include <vector>

#include "input_event.h"
#include "scene/look.h"
#include "scene/scene_2d.h"
#include "scene/scene_camera.h"
#include "window_size.h"

namespace softcell::demos {

/// While Look::knife is on, dragging with the left button draws a stroke; letting the button go cuts. It cuts all soft bodies that are seen
/// under the stroke, in three dimensions also those hidden behind others.
template <int Dimension>
class Knife {
 public:
  static constexpr int kShortest = 4;  ///< shortest stroke, in the units of SDL's mouse; a click cuts nothing
  struct Point {
    int x = 0, y = 0;
  };
  /// A stroke over a window of this size.
  struct Stroke {
    Point from, to;
    int width = 1, height = 1;
  };
  /// Makes the path of the blade from a stroke: Action::kCut without a body.
  using Blade = std::function<InputEvent<Dimension>(const Look&, const Stroke&)>;

  /// A knife that cuts nothing.
  Knife() = default;
  /// @param width, height  of the window, in the units in which SDL gives the mouse
  Knife(Blade blade, int width, int height);

  /// Appends the events that it makes of this one.
  /// @return true: the knife has used the event
  bool handle(const SDL_Event& event, Look& look, std::vector<InputEvent<Dimension>>& events);

 private:
  void show(Look& look) const;
  void cut(const Look& look, std::vector<InputEvent<Dimension>>& events) const;

  Blade blade_;
  WindowSize window_;
  std::optional<Point> from_;  // none: nothing is being cut
  Point to_;
};

/// @param eye  gives the camera from which the scene is seen now
Knife<3> knife_3d(std::function<render::Camera(const Look&)> eye, int width, int height);
Knife<2> knife_2d(const Camera2d& camera, int width, int height);

extern template class Knife<2>;
extern template class Knife<3>;

}  // namespace softcell::demos
