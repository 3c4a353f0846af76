#pragma once
// One number for all of a scene that decides how its simulation goes: equal numbers, equal runs under equal
// events.

#include <cstdint>

#include "scene.h"
#include "scene_2d.h"

namespace softcell::demos {

/// Not part of it: names, looks, the camera, and the script, whose events a recording has.
/// @source  XXH3, the 64-bit variant, over the values in order
std::uint64_t scene_hash(const Scene& scene);
std::uint64_t scene_hash(const Scene2d& scene);

}  // namespace softcell::demos
