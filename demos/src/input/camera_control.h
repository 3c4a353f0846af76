#pragma once
// How the user moves the camera of three dimensions.

#include <SDL.h>

#include "scene/look.h"
#include "scene/scene_camera.h"
#include "window_size.h"

namespace softcell::demos {

/// Dragging with the left button turns the camera about the point it looks at; with the middle button, or with Shift, it moves the camera
/// sideways; with the right button the camera looks around, and flies with W A S D Q E. The wheel moves it nearer and farther. Used by one
/// thread.
class CameraControl {
 public:
  CameraControl() = default;
  /// @param camera  the scene's  @param height  of the window, in the units in which SDL gives the mouse
  CameraControl(const render::Camera& camera, int height);

  /// @return true: the camera has used the event, and it means nothing else
  bool handle(const SDL_Event& event, Look& look);

  /// Moves the camera on while it flies. Call it in each frame.
  void next_frame(Look& look) const;

 private:
  void move(const SDL_MouseMotionEvent& motion, Look& look) const;
  bool handle_key(const SDL_KeyboardEvent& key);

  render::Camera camera_;
  WindowSize window_{.height = 720};
  bool flies_ = false;  // the right button is down
  struct Keys {
    float right = 0, left = 0, up = 0, down = 0, forward = 0, back = 0;
  } held_;  // 1: the key is down
};

}  // namespace softcell::demos
