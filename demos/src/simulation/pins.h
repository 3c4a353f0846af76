#pragma once
// Pins: parts of soft bodies that hands have left where they are in the world, in either dimension.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "hand_patch.h"
#include "held_bodies.h"
#include "input/hands.h"
#include "shown.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::demos {

/// What a hand of either kind holds of a soft body. None: nothing, or a rigid body.
/// @param hands   those at particles  @param bodies  of these: see Hands
template <int Dimension, class Bodies>
std::optional<HeldPart<Dimension>> part_held_by(std::uint32_t hand, const HeldBodies<Dimension>& held,
                                                const Hands<Dimension>& hands, const Bodies& bodies) {
  if (auto part = held.part(hand)) return part;
  for (const typename Hands<Dimension>::Held& one : hands.held()) {
    if (one.hand != hand) continue;
    const ppu::SoftBody<Dimension>& body = bodies[one.body];
    const auto particle = static_cast<std::uint32_t>(one.particle);
    return HeldPart<Dimension>(body, HandPatch<Dimension>(body.model(), particle), body.position(particle));
  }
  return std::nullopt;
}

/// Welds to the world. One that breaks, or loses its body, is gone by itself. One thread uses it.
/// @tparam Dimension  2 or 3. `SoftBodies` is BulletSoftBodies or Box2dSoftBodies, always the same one.
template <int Dimension>
class Pins {
 public:
  static constexpr std::size_t kMost = 100;  ///< one more takes the place of the oldest

  /// No effect: a part that is crushed flat, which nothing can hold.
  /// @param source  the scene's body that the body is, or is a piece of
  template <class SoftBodies>
  void add(SoftBodies& bodies, std::size_t source, const HeldPart<Dimension>& part) {
    forget_ended(bodies);
    if (pins_.size() == kMost) {
      bodies.detach(pins_.front().id);
      pins_.erase(pins_.begin());
    }
    try {
      const auto id = bodies.attach(*part.body, ppu::Patch<Dimension>::of_particles(part.particles));
      pins_.push_back({id, source, drawn(part)});
    } catch (const std::invalid_argument&) {
      return;
    }
  }
  /// @param source  as above; kEveryBody: all pins go
  template <class SoftBodies>
  void remove(SoftBodies& bodies, std::size_t source) {
    forget_ended(bodies);
    std::erase_if(pins_, [&](const Pin& pin) {
      if (source != kEveryBody && pin.source != source) return false;
      bodies.detach(pin.id);
      return true;
    });
  }
  /// Their world is gone.
  void forget() { pins_.clear(); }

  /// Appends the heads of those that hold.
  template <class SoftBodies>
  void append(const SoftBodies& bodies, std::vector<ShownRope<Dimension>>& ropes) const {
    for (const Pin& pin : pins_)
      if (bodies.attachment(pin.id)) ropes.push_back(pin.head);
  }

 private:
  struct Pin {
    ppu::AttachmentId id;
    std::size_t source;
    ShownRope<Dimension> head;  // a pin stays where it is
  };

  template <class SoftBodies>
  void forget_ended(const SoftBodies& bodies) {
    std::erase_if(pins_, [&](const Pin& pin) { return !bodies.attachment(pin.id); });
  }

  /// A short thick rope is a round head.
  static ShownRope<Dimension> drawn(const HeldPart<Dimension>& part) {
    const float thickness = kThickness * part.radius;
    return {.ends = {part.point, part.point + kHeight * thickness * Eigen::Vector<float, Dimension>::Unit(1)},
            .length = 0,
            .thickness = thickness,
            .colour = {0.88f, 0.54f, 0.03f}};
  }
  static constexpr float kThickness = 0.2f;  // of the radius of what the hand held
  static constexpr float kHeight = 0.3f;     // of that thickness

  std::vector<Pin> pins_;
};

}  // namespace softcell::demos
