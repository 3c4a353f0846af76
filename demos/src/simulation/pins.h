#pragma once
// Pins: hands have left these parts of soft bodies where they are in the world, in either dimension.

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "grips/hand_patch.h"
#include "grips/held_bodies.h"
#include "input/hands.h"
#include "scene/beginning.h"
#include "shown.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::demos {

/// The part of a soft body that a hand of either kind holds. None: the hand holds nothing, or a rigid body.
/// @param hands   those that hold particles  @param bodies  those that `hands` refers to: see Hands
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

/// Pins are welds to the world. One that breaks, or loses its body, ends by itself. One thread uses it.
/// @tparam Dimension  2 or 3. `SoftBodies` is BulletSoftBodies or Box2dSoftBodies, always the same one.
template <int Dimension>
class Pins {
 public:
  using SavedPin = typename Beginning<Dimension>::Pin;

  /// Adds a pin. If there are kMostPins already, it replaces the oldest one. No effect if the part is crushed flat, since nothing can hold
  /// that.
  /// @param source  the scene's body that the body is, or is a piece of
  template <class SoftBodies>
  void add(SoftBodies& bodies, std::size_t source, const HeldPart<Dimension>& part) {
    forget_ended(bodies);
    if (pins_.size() == kMostPins) {
      bodies.detach(pins_.front().id);
      pins_.erase(pins_.begin());
    }
    try {
      add(bodies, *part.body, {static_cast<std::uint32_t>(source), part.point, part.radius, part.particles});
    } catch (const std::invalid_argument&) {
      return;
    }
  }
  /// Replaces all pins by those of a saved moment.
  /// @param bodies  as they were at that moment  @throws std::runtime_error  one of the pins cannot be made
  template <class SoftBodies>
  void replace(SoftBodies& bodies, const std::vector<SavedPin>& pins) {
    remove(bodies, kEveryBody);
    for (const SavedPin& pin : pins) {
      try {
        add(bodies, bodies[pin.body], pin);
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error(
            fmt::format("pin {} of the saved state: {}", pins_.size() + 1, error.what()));
      }
    }
  }
  /// @param source  as above; kEveryBody: removes all pins
  template <class SoftBodies>
  void remove(SoftBodies& bodies, std::size_t source) {
    forget_ended(bodies);
    std::erase_if(pins_, [&](const Pin& pin) {
      if (source != kEveryBody && pin.saved.body != source) return false;
      bodies.detach(pin.id);
      return true;
    });
  }
  /// Call it when their world is gone.
  void forget() { pins_.clear(); }

  /// The pins that still hold.
  template <class SoftBodies>
  std::vector<SavedPin> saved(const SoftBodies& bodies) const {
    std::vector<SavedPin> saved;
    for (const Pin& pin : pins_)
      if (bodies.attachment(pin.id)) saved.push_back(pin.saved);
    return saved;
  }
  /// Appends the heads of the pins that still hold.
  template <class SoftBodies>
  void append(const SoftBodies& bodies, std::vector<ShownRope<Dimension>>& ropes) const {
    for (const Pin& pin : pins_)
      if (bodies.attachment(pin.id)) ropes.push_back(drawn(pin.saved));
  }

 private:
  struct Pin {
    ppu::AttachmentId id;
    SavedPin saved;  // of the moment at which it was made: a pin does not move
  };

  template <class SoftBodies>
  void add(SoftBodies& bodies, const ppu::SoftBody<Dimension>& body, const SavedPin& pin) {
    pins_.push_back({bodies.attach(body, ppu::Patch<Dimension>::of_particles(pin.particles)), pin});
  }
  template <class SoftBodies>
  void forget_ended(const SoftBodies& bodies) {
    std::erase_if(pins_, [&](const Pin& pin) { return !bodies.attachment(pin.id); });
  }

  /// Draws a pin's round head as a short thick rope.
  static ShownRope<Dimension> drawn(const SavedPin& pin) {
    const float thickness = kThickness * pin.radius;
    return {.ends = {pin.point, pin.point + kHeight * thickness * Eigen::Vector<float, Dimension>::Unit(1)},
            .length = 0,
            .thickness = thickness,
            .colour = {0.88f, 0.54f, 0.03f}};
  }
  static constexpr float kThickness = 0.2f;  // of the radius of what the hand held
  static constexpr float kHeight = 0.3f;     // of that thickness

  std::vector<Pin> pins_;
};

}  // namespace softcell::demos
