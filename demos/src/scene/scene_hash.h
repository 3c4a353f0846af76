#pragma once
// A hash of all parts of a scene that affect its simulation: scenes with equal hashes behave equally under equal events.

#include <cstdint>

#include "scene.h"
#include "scene_2d.h"

namespace softcell::demos {

/// It leaves out names, looks, the camera, and the script, whose events a recording has.
/// @param contacts  the method of the simulation, which need not be the scene's
/// @source  XXH3, the 64-bit variant, over the values in order
std::uint64_t scene_hash(const Scene& scene, ppu::ContactMethod contacts);
std::uint64_t scene_hash(const Scene2d& scene, ppu::ContactMethod contacts);
inline std::uint64_t scene_hash(const Scene& scene) { return scene_hash(scene, scene.contacts); }
inline std::uint64_t scene_hash(const Scene2d& scene) { return scene_hash(scene, scene.contacts); }

}  // namespace softcell::demos
