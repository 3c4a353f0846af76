#pragma once
// The mouse moves the camera of three dimensions.

#include <SDL.h>

#include "look.h"

namespace softcell::demos {

/// Dragging turns the camera about the scene, the wheel takes it nearer.
void move_camera(const SDL_Event& event, Look& look);

}  // namespace softcell::demos
