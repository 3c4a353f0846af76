#pragma once
// What tests do with simulations of both dimensions.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "scene_file/save_scene.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"

namespace softcell::demos {

template <class Simulation>
void step(Simulation& simulation, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulation.step();
}

/// The present settings of all soft bodies.
template <class Simulation>
std::vector<ppu::SoftBodySettings> settings_of(const Simulation& simulation) {
  std::vector<ppu::SoftBodySettings> all;
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b)
    all.push_back(simulation.soft_body(b).settings());
  return all;
}

template <class Simulation>
auto present(const Simulation& simulation) {
  constexpr int kDimension = std::is_same_v<Simulation, Simulation3d> ? 3 : 2;
  return PresentScene<kDimension>{simulation.moment(), settings_of(simulation), simulation.substeps()};
}

/// What a user changes while a run goes on.
template <int Dimension>
InputEvent<Dimension> change(Action action, float value, std::uint32_t body = kEveryBody) {
  InputEvent<Dimension> event;
  event.action = action;
  event.body = body;
  event.value[0] = value;
  return event;
}

}  // namespace softcell::demos
