#pragma once

#include <optional>
#include <string>
#include <utility>

#include "ppu/matching/stiffness.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::demos {

/// What a soft body is made of, with substeps of the present length.
struct BodyMaterial {
  std::string name;                ///< the body's
  float alpha = 0;                 ///< 0..1
  std::optional<float> frequency;  ///< Hz, if that is what was stated
  float modulus = 0;               ///< m^2/s^2
  float most_modulus = 0;          ///< m^2/s^2, of alpha 1
  float damping = 0;               ///< 0..1
  float friction = 0;
  float density = 0;  ///< kg/m^3; in 2D kg/m^2
};

/// @param step  seconds of a substep
inline BodyMaterial material_of(std::string name, const ppu::SoftBodySettings& settings, float step) {
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
          .density = settings.density};
}

}  // namespace softcell::demos
