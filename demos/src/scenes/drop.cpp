// One soft body falls onto a floor: ours, or the user's own model.

#include <algorithm>

#include "scenes.h"
#include "softcell/ppu/shapes.h"
#include "softcell/ppu/stiffness.h"

namespace softcell::demos {
namespace {

constexpr float kLongestSide = 1.6f;  // metres, to which the user's model is scaled
constexpr float kModulus =
    300;  // E / rho of the material in m^2/s^2: a block of a metre sinks in by 2 % of its height

}  // namespace

Scene make_drop(const std::optional<OwnModel>& model) {
  SoftBodyPlacement body{
      .name = "body", .mesh = {}, .settings = {}, .position = {}, .colour = render::srgb(0xD26A35)};
  body.settings.half_width = 2;
  body.settings.density = 200;
  body.settings.damping = 0.05f;
  if (model) {
    const ppu::Bounds box = ppu::bounds(model->mesh);
    const float scale = kLongestSide / (box.high - box.low).maxCoeff();
    body.mesh = model->mesh;
    ppu::fit(body.mesh, kLongestSide);
    body.settings.cell_size = model->cell_size * scale;
  } else {
    body.mesh = ppu::make_torus(0.75f, 0.3f, 96, 40);
    body.settings.cell_size = 0.2f;
  }
  Scene scene;
  // The same material for any cell size, as far as alpha goes: fine lattices end up softer.
  const double step = 1.0 / 60 / scene.substeps;
  const double stiffest =
      ppu::specific_modulus(double{body.settings.cell_size}, step, 1, body.settings.half_width);
  body.settings.alpha = static_cast<float>(std::min(1.0, kModulus / stiffest));
  const float half_height = (ppu::bounds(body.mesh).high - ppu::bounds(body.mesh).low).y() / 2;
  body.position = {0, half_height + 1.2f, 0};

  scene.boxes.push_back({.size = {12, 1, 12},
                         .position = {0, -0.5f, 0},
                         .colour = render::srgb(0xB9B4A7),
                         .pattern = render::Pattern::tiles});
  scene.soft_bodies.push_back(std::move(body));
  scene.camera = {.eye = {2.6f, 2.4f, 4.2f},
                  .target = {0, 0.7f, 0},
                  .tan_half_fov_y = 0.4f,
                  .near_plane = 0.5f,
                  .far_plane = 60};
  scene.light.shadow_radius = 4;
  return scene;
}

}  // namespace softcell::demos
