#pragma once
// The parts of the beginning of a run, and of saving and restoring one of its moments, that are the same in both dimensions.

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "describe_refusal.h"
#include "input/controls.h"
#include "scene/attachment_placement.h"
#include "scene/beginning.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// Gravity, tilt and time scale at a scene's beginning.
template <int Dimension, class SceneOf>
typename Controls<Dimension>::Initial initial_controls(const SceneOf& scene) {
  typename Controls<Dimension>::Initial initial;
  initial.gravity.y() = -scene.gravity;
  if (!scene.begin) return initial;
  if (scene.begin->gravity) initial.gravity = *scene.begin->gravity;
  initial.tilt = scene.begin->tilt;
  initial.time_scale = scene.begin->time_scale;
  return initial;
}

/// The error message for a moment at which a body has broken: no scene can begin with it.
inline std::string has_broken(const std::string& scene, const std::string& body) {
  return fmt::format(
      "the scene {} cannot be saved or changed: '{}' has broken, and a scene file has whole bodies only; "
      "reset the scene first",
      scene, body);
}

/// Moves a body's particles to where the scene begins with them.
/// @throws std::runtime_error  the state belongs to another body
template <int Dimension>
void set_beginning(ppu::SoftBody<Dimension>& body, const typename Beginning<Dimension>::SoftBody& state,
                   const std::string& name) {
  SC_ASSERT(state.positions.size() == state.velocities.size(), "{} positions and {} velocities of body '{}'",
            state.positions.size(), state.velocities.size(), name);
  SC_ASSERT(state.rest.empty() || state.rest.size() == state.positions.size(),
            "{} positions and {} at rest of body '{}'", state.positions.size(), state.rest.size(), name);
  if (state.positions.size() != body.positions().size())
    throw std::runtime_error(fmt::format("soft body '{}' has {} particles, and its saved state has {}", name,
                                         body.positions().size(), state.positions.size()));
  if (!state.rest.empty()) body.set_rest_positions(state.rest);
  body.set_state(state.positions, state.velocities);
}

/// The same for all soft bodies of a scene, except those added at this moment: they stay where they are placed.
template <int Dimension, class SceneOf, class Bodies>
void set_beginnings(const SceneOf& scene, Bodies& bodies) {
  const Beginning<Dimension>& begin = *scene.begin;
  if (begin.soft_bodies.size() > scene.soft_bodies.size())
    throw std::runtime_error(fmt::format("the scene {} has {} soft bodies, and its saved state has {}",
                                         scene.name, scene.soft_bodies.size(), begin.soft_bodies.size()));
  for (std::size_t b = 0; b < begin.soft_bodies.size(); ++b)
    set_beginning<Dimension>(bodies[b], begin.soft_bodies[b], scene.soft_bodies[b].name);
}

/// @throws std::runtime_error  the number of rigid bodies in the scene's saved state is not `moving`
template <class SceneOf>
void check_moving_bodies(const SceneOf& scene, std::size_t moving) {
  if (scene.begin->rigid_bodies.size() == moving) return;
  throw std::runtime_error(
      fmt::format("the scene {} has {} rigid bodies that move, and its saved state has {}", scene.name,
                  moving, scene.begin->rigid_bodies.size()));
}

/// Makes all attachments of a scene. @param rigid_of  gives the rigid body of a placement, or null
/// @return  their ids, in the scene's order   @throws std::runtime_error  one of them cannot be made
template <int Dimension, class SceneOf, class Bodies, class RigidOf>
std::vector<ppu::AttachmentId> make_attachments(const SceneOf& scene, Bodies& bodies,
                                                const RigidOf& rigid_of) {
  using Patch = ppu::Patch<Dimension>;
  std::vector<ppu::AttachmentId> made;
  for (const AttachmentPlacement<Dimension>& placement : scene.attachments) {
    const ppu::SoftBody<Dimension>& body = bodies[placement.body];
    const auto patch = Patch::of_surface(placement.at, placement.radius);
    made.push_back(describe_refusal(placement.described, [&] {
      if (placement.other) {
        const auto other = Patch::of_surface(placement.other_at, placement.other_radius);
        return bodies.attach(body, patch, bodies[*placement.other], other, placement.settings);
      }
      if (auto* const rigid = rigid_of(placement))
        return bodies.attach(body, patch, *rigid, placement.settings);
      return bodies.attach(body, patch, placement.settings);
    }));
  }
  return made;
}

/// Ends the attachments that had ended before the scene begins. @param attachments  of the scene, in order
/// @throws std::runtime_error  the scene has fewer
template <class SceneOf, class Bodies>
void end_attachments(const SceneOf& scene, const std::vector<ppu::AttachmentId>& attachments,
                     Bodies& bodies) {
  for (const std::uint32_t number : scene.begin->ended_attachments) {
    if (number >= attachments.size())
      throw std::runtime_error(
          fmt::format("attachment {} of the saved state is none of the {} of the scene {}", number,
                      attachments.size(), scene.name));
    bodies.detach(attachments[number]);
  }
}

template <class Bodies>
std::vector<std::uint32_t> ended_attachments(const std::vector<ppu::AttachmentId>& attachments,
                                             const Bodies& bodies) {
  std::vector<std::uint32_t> ended;
  for (std::uint32_t i = 0; i < attachments.size(); ++i)
    if (!bodies.attachment(attachments[i])) ended.push_back(i);
  return ended;
}

template <int Dimension>
typename Beginning<Dimension>::SoftBody state_of(const ppu::SoftBody<Dimension>& body) {
  const auto x = body.positions(), v = body.velocities();
  typename Beginning<Dimension>::SoftBody state{
      .positions = {x.begin(), x.end()}, .velocities = {v.begin(), v.end()}, .rest = {}};
  if (body.has_own_rest()) state.rest = body.rest_positions();
  return state;
}

}  // namespace softcell::demos
