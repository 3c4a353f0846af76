#pragma once
// The mouse as the user's hand in a scene of two dimensions.

#include <SDL.h>

#include <vector>

#include "input_event.h"
#include "scene/scene_2d.h"

namespace softcell::demos {

/// The left button takes the nearest particle, which then follows the mouse; letting go throws it.
class MouseHand {
 public:
  /// @param width, height  of the window, in the units in which SDL gives the mouse
  MouseHand(const Camera2d& camera, int width, int height)
      : camera_(camera), width_(width), height_(height) {}

  /// Appends what the event means. Of moves that follow one another, the last counts.
  void handle(const SDL_Event& event, std::vector<InputEvent<2>>& events);

 private:
  void move(const SDL_MouseMotionEvent& motion, std::vector<InputEvent<2>>& events) const;

  Camera2d camera_;
  int width_, height_;
  bool holds_ = false;
};

}  // namespace softcell::demos
