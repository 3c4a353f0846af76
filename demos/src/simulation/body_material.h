#pragma once

#include <optional>
#include <string>
#include <utility>

#include "ppu/matching/rest_lattice.h"
#include "ppu/matching/stiffness.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// The present material of a soft body, with substeps of their present length.
struct BodyMaterial {
  std::string name;                ///< of the body
  float alpha = 0;                 ///< 0..1
  std::optional<float> frequency;  ///< Hz, if the scene or the user states it
  float modulus = 0;               ///< m^2/s^2
  float most_modulus = 0;          ///< m^2/s^2, with alpha 1
  float damping = 0;               ///< 0..1
  float friction = 0;
  float density = 0;                          ///< kg/m^3; in 2D kg/m^2
  std::optional<ppu::Plasticity> plasticity;  ///< none: it is elastic
  bool can_be_plastic = false;                ///< whether it has few enough particles for that
};

/// @param step  seconds per substep
template <int Dimension>
BodyMaterial material_of(std::string name, const ppu::SoftBody<Dimension>& body, float step) {
  const ppu::SoftBodySettings& settings = body.settings();
  const float alpha = settings.alpha_of_step(step);
  const auto most = static_cast<float>(
      ppu::specific_modulus(double{settings.cell_size}, double{step}, 1, settings.half_width));
  return {.name = std::move(name),
          .alpha = alpha,
          .frequency = settings.frequency,
          .modulus = alpha * most,
          .most_modulus = most,
          .damping = settings.damping_of_step(step),
          .friction = settings.friction,
          .density = settings.density,
          .plasticity = settings.plasticity,
          .can_be_plastic = body.model().particles() <= ppu::kMaxPlasticParticles};
}

}  // namespace softcell::demos
