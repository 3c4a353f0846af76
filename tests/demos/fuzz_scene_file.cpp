// Any text as a scene in TOML: it becomes a scene whose numbers are all finite, or is refused with one line.

#include <cmath>
#include <cstdlib>
#include <variant>

#include "document/value.h"
#include "scene_file/scene_library.h"

namespace {

using namespace softcell::demos;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const Scene& scene) {
  require(std::isfinite(scene.gravity) && scene.substeps > 0);
  for (const SoftBodyPlacement& body : scene.soft_bodies) {
    require(body.position.allFinite() && !body.mesh.triangles.empty());
    softcell::ppu::validate(body.settings);
  }
  for (const RigidBox& box : scene.boxes) require(box.position.allFinite() && box.size.minCoeff() > 0);
  for (const auto& drag : scene.script.drags) {
    require(drag.body < scene.soft_bodies.size() && drag.end > drag.begin);
  }
}

void check(const Scene2d& scene) {
  require(std::isfinite(scene.gravity) && scene.substeps > 0);
  for (const SoftBody2dPlacement& body : scene.soft_bodies) {
    require(body.position.allFinite() && !body.cells.empty());
    softcell::ppu::validate(body.settings);
  }
  for (const RigidBody2d& body : scene.rigid_bodies) require(body.position.allFinite() && body.mass >= 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const auto scene = parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    std::visit([](const auto& s) { check(s); }, scene);
  } catch (const SceneError&) {
    // refused, as it may be
  }
  return 0;
}
