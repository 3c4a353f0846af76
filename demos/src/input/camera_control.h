#pragma once
// How the user moves the camera of three dimensions.

#include <SDL.h>

#include "scene/look.h"
#include "scene/scene_camera.h"

namespace softcell::demos {

/// Drag with the left button: about what the camera looks at. With the middle one, or with Shift: sideways. With the right one:
/// looks around, and flies with W A S D Q E. The wheel: nearer and farther. Used by one thread.
class CameraControl {
 public:
  CameraControl() = default;
  /// @param camera  the scene's  @param width, height  of the window, in the units in which SDL gives the mouse
  CameraControl(const render::Camera& camera, int height);

  /// @return true: the event was the camera's, and means nothing else
  bool handle(const SDL_Event& event, Look& look);

  /// Flies on. Call it in each frame.
  void next_frame(Look& look) const;

 private:
  void move(const SDL_MouseMotionEvent& motion, Look& look) const;
  bool handle_key(const SDL_KeyboardEvent& key);

  render::Camera camera_;
  int height_ = 720;
  bool flies_ = false;  // the right button is down
  struct Keys {
    float right = 0, left = 0, up = 0, down = 0, forward = 0, back = 0;
  } held_;  // 1: the key is down
};

}  // namespace softcell::demos
