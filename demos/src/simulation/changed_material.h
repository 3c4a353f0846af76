#pragma once
// Applies an event to the material of a soft body.

#include <algorithm>

#include "input/input_event.h"
#include "ppu/matching/rest_lattice.h"
#include "ppu/matching/stiffness.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// @param event  with Action::kAlpha, kFrequency, kModulus, kDamping, kFriction, kYield or kCreep  @param step  seconds per substep
template <int Dimension>
ppu::SoftBodySettings changed_material(const ppu::SoftBody<Dimension>& body,
                                       const InputEvent<Dimension>& event, float step) {
  ppu::SoftBodySettings settings = body.settings();
  const NumberRange* const range = number_of(event.action);
  SC_ASSERT(range != nullptr && step > 0, "action {} with substeps of {} s sets no material",
            static_cast<int>(event.action), step);
  const float value = std::clamp(event.value[0], range->low, range->high);
  switch (event.action) {
    case Action::kAlpha:
      settings.frequency.reset();
      settings.alpha = value;
      break;
    case Action::kFrequency:
      settings.frequency = value;
      break;
    case Action::kModulus: {
      const double stiffest =
          ppu::specific_modulus(double{settings.cell_size}, double{step}, 1, settings.half_width);
      settings.frequency.reset();
      settings.alpha = stiffest > 0 ? static_cast<float>(std::min(1.0, double{value} / stiffest)) : 1;
      break;
    }
    case Action::kDamping:
      settings.damping_time.reset();
      settings.damping = value;
      break;
    case Action::kFriction:
      settings.friction = value;
      break;
    case Action::kYield:
      if (value == 0) {
        settings.plasticity.reset();
      } else if (body.model().particles() <= ppu::kMaxPlasticParticles) {
        if (!settings.plasticity) settings.plasticity.emplace();
        settings.plasticity->yield = value;
      }
      break;
    case Action::kCreep:
      if (settings.plasticity) settings.plasticity->creep = value;
      break;
    default:
      break;
  }
  return settings;
}

}  // namespace softcell::demos
