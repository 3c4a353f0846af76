#pragma once
// Pins: parts of soft bodies that hands have left where they are in the world, in either dimension.

#include <fmt/format.h>

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
#include "scene/beginning.h"
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
  using SavedPin = typename Beginning<Dimension>::Pin;

  /// One more than kMostPins takes the place of the oldest. No effect: a part that is crushed flat, which nothing can hold.
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
  /// Those of a moment of a run, in place of all others.
  /// @param bodies  where they were at that moment  @throws std::runtime_error  one of them cannot be
  template <class SoftBodies>
  void put(SoftBodies& bodies, const std::vector<SavedPin>& pins) {
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
  /// @param source  as above; kEveryBody: all pins go
  template <class SoftBodies>
  void remove(SoftBodies& bodies, std::size_t source) {
    forget_ended(bodies);
    std::erase_if(pins_, [&](const Pin& pin) {
      if (source != kEveryBody && pin.saved.body != source) return false;
      bodies.detach(pin.id);
      return true;
    });
  }
  /// Their world is gone.
  void forget() { pins_.clear(); }

  /// Those that hold.
  template <class SoftBodies>
  std::vector<SavedPin> saved(const SoftBodies& bodies) const {
    std::vector<SavedPin> saved;
    for (const Pin& pin : pins_)
      if (bodies.attachment(pin.id)) saved.push_back(pin.saved);
    return saved;
  }
  /// Appends the heads of those that hold.
  template <class SoftBodies>
  void append(const SoftBodies& bodies, std::vector<ShownRope<Dimension>>& ropes) const {
    for (const Pin& pin : pins_)
      if (bodies.attachment(pin.id)) ropes.push_back(drawn(pin.saved));
  }

 private:
  struct Pin {
    ppu::AttachmentId id;
    SavedPin saved;  // a pin stays where it is
  };

  template <class SoftBodies>
  void add(SoftBodies& bodies, const ppu::SoftBody<Dimension>& body, const SavedPin& pin) {
    pins_.push_back({bodies.attach(body, ppu::Patch<Dimension>::of_particles(pin.particles)), pin});
  }
  template <class SoftBodies>
  void forget_ended(const SoftBodies& bodies) {
    std::erase_if(pins_, [&](const Pin& pin) { return !bodies.attachment(pin.id); });
  }

  /// A short thick rope is a round head.
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
