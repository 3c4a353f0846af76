// The report's 3D demo: a walled floor with things sticking out of it, soft bodies of different shape, and a
// ground that tilts.

#include <filesystem>
#include <stdexcept>

#include "scenes.h"
#include "softcell/ppu/shapes.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;
using render::srgb;

constexpr float kHalfFloor = 4.5f;  // metres from the middle to a wall
constexpr float kWallHeight = 0.9f;
constexpr float kWallThickness = 0.3f;

// A mesh that nobody here modelled: the Stanford bunny as Debian's package glmark2-data installs it. It is
// read where it lies and is no part of softcell; the package's licence (GPL-3+) and the scan's terms are
// noted in docs/third-party.md.
constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";

ppu::TriangleMesh load_bunny(float longest_side) {
  if (!std::filesystem::exists(kBunny)) {
    throw std::runtime_error(std::string("scene arena needs ") + kBunny +
                             ": install the package glmark2-data");
  }
  ppu::TriangleMesh bunny = ppu::import_mesh(kBunny);
  ppu::fit(bunny, longest_side);
  return bunny;
}

/// Rubber of about 200 kg/m^3 that gives visibly and comes back.
ppu::SoftBodySettings rubber(float cell_size) {
  ppu::SoftBodySettings settings;
  settings.cell_size = cell_size;
  settings.half_width = 2;
  settings.density = 200;
  settings.alpha = 0.12f;
  settings.damping = 0.04f;
  return settings;
}

void add_floor_and_walls(Scene& scene) {
  const float outer = 2 * kHalfFloor + 2 * kWallThickness;
  const auto colour = srgb(0x9AA7B5);
  scene.boxes.push_back({.size = {outer, 1, outer},
                         .position = {0, -0.5f, 0},
                         .colour = srgb(0xB9B4A7),
                         .pattern = render::Pattern::tiles});
  const float middle = kHalfFloor + kWallThickness / 2;
  for (const float side : {-1.0f, 1.0f}) {
    scene.boxes.push_back({.size = {kWallThickness, kWallHeight, outer},
                           .position = {side * middle, kWallHeight / 2, 0},
                           .colour = colour});
    // The wall towards the camera is glass.
    scene.boxes.push_back({.size = {2 * kHalfFloor, kWallHeight, kWallThickness},
                           .position = {0, kWallHeight / 2, side * middle},
                           .colour = colour,
                           .opacity = side > 0 ? 0.15f : 1.0f});
  }
}

void add_obstacles(Scene& scene) {
  const auto stone = srgb(0x6F7F8F);
  scene.obstacles.push_back({ppu::make_cone(0.45f, 1.5f, 48), {-2.3f, 0.75f, -0.6f}, stone});
  scene.obstacles.push_back({ppu::make_cylinder(0.35f, 1.1f, 48), {0.6f, 0.55f, -2.9f}, stone});
  scene.obstacles.push_back({ppu::make_wedge({1.8f, 0.7f, 1.6f}), {3.4f, 0.35f, 0.4f}, stone});
  // A low wall to hang over, as in the report's figure 6.5.
  scene.boxes.push_back({.size = {0.3f, 0.8f, 1.6f}, .position = {0.2f, 0.4f, 0.2f}, .colour = stone});
}

void add_soft_bodies(Scene& scene) {
  ppu::SoftBodySettings car = rubber(0.2f);
  car.alpha = 0.8f;  // an antenna of one cell's cross-section would hang limp at less
  scene.soft_bodies.push_back(
      {"torus", ppu::make_torus(0.72f, 0.28f, 96, 40), rubber(0.2f), {-2.3f, 2.6f, -0.6f}, srgb(0xE0782C)});
  scene.soft_bodies.push_back(
      {"sphere", ppu::make_sphere(0.7f, 24), rubber(0.28f), {0.25f, 2.2f, 0.3f}, srgb(0xC23B3B)});
  scene.soft_bodies.push_back({"car", ppu::make_car(1.7f), car, {-1.2f, 1.35f, 2.6f}, srgb(0x2E7FC2)});
  scene.soft_bodies.push_back(
      {"bunny", load_bunny(1.7f), rubber(0.24f), {2.4f, 1.9f, -2.2f}, srgb(0xD9C9A8)});
  scene.soft_bodies.push_back(
      {"cube", ppu::make_box({0.9f, 0.9f, 0.9f}, 0.06f), rubber(0.225f), {2.2f, 2.4f, 1.8f}, srgb(0x4FA35A)});
}

void add_rigid_boxes(Scene& scene) {
  const auto wood = srgb(0xA9743F);
  for (const Vector3f& position :
       {Vector3f{-3.4f, 0.25f, 2.2f}, Vector3f{-3.4f, 0.75f, 2.2f}, Vector3f{-3.3f, 1.25f, 2.25f},
        Vector3f{1.6f, 0.25f, 3.2f}, Vector3f{2.2f, 0.25f, 3.3f}, Vector3f{-0.8f, 0.25f, -3.2f}}) {
    scene.boxes.push_back({.size = {0.5f, 0.5f, 0.5f}, .mass = 25, .position = position, .colour = wood});
  }
}

}  // namespace

Scene make_arena() {
  Scene scene;
  add_floor_and_walls(scene);
  add_obstacles(scene);
  add_soft_bodies(scene);
  add_rigid_boxes(scene);
  scene.tilt = {
      .amplitude_x = 0.20f, .amplitude_z = 0.26f, .period_x = 4.6f, .period_z = 6.2f, .begin = 1.5f};
  scene.camera = {.eye = {0, 6.4f, 9.6f},
                  .target = {0, 0.3f, 0.3f},
                  .tan_half_fov_y = 0.42f,
                  .near_plane = 1,
                  .far_plane = 60};
  scene.light.shadow_radius = 7.5f;
  return scene;
}

}  // namespace softcell::demos
