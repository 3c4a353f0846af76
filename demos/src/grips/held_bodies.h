#pragma once
// The bodies that hands hold, and how the hands move, in either dimension.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "grip.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// One thread uses it.
template <int Dimension>
class HeldBodies {
 public:
  using Vector = Eigen::Vector<float, Dimension>;

  /// The hand lets go of the body that it holds, and takes this one. Its position becomes the held point, so that nothing jumps.
  void hold(std::uint32_t hand, std::unique_ptr<Grip<Dimension>> grip) {
    SC_ASSERT(grip != nullptr, "hand {} takes nothing", hand);
    release(hand);
    const Vector at = grip->point();
    hands_.push_back({hand, at, at, Vector::Zero(), std::move(grip)});
  }
  /// @param to  metres: the hand's position at the end of the frame
  void move(std::uint32_t hand, const Vector& to) {
    for (Hand& held : hands_) {
      if (held.number == hand) held.to = to;
    }
  }
  /// Throws the body that the hand holds.
  void release(std::uint32_t hand) {
    for (const Hand& held : hands_) {
      if (held.number == hand) held.grip->let_go(held.velocity);
    }
    std::erase_if(hands_, [hand](const Hand& held) { return held.number == hand; });
  }
  /// The part of a soft body that the hand holds.
  std::optional<HeldPart<Dimension>> part(std::uint32_t hand) const {
    for (const Hand& held : hands_)
      if (held.number == hand) return held.grip->part();
    return std::nullopt;
  }
  /// Lets go of a body that has broken or is gone. @param body  its address
  void forget(const void* body) {
    std::erase_if(hands_, [body](const Hand& held) { return held.grip->holds(body); });
  }
  /// Call it when bodies have broken, in this order: hands keep hold of what they held unless it has vanished.
  void follow(std::span<const ppu::BrokenBody<Dimension>> broken) {
    for (Hand& hand : hands_)
      if (auto grip = hand.grip->follow(broken)) hand.grip = std::move(*grip);
    std::erase_if(hands_, [](const Hand& hand) { return hand.grip == nullptr; });
  }
  /// Lets go of everything without changing any velocities.
  void release_all() { hands_.clear(); }
  bool empty() const { return hands_.empty(); }

  /// Call it after the events of a frame that lasts `seconds`.
  void begin_frame(float seconds) {
    SC_ASSERT(seconds > 0, "a frame of {} s", seconds);
    using Strength = HandStrength<Dimension>;
    for (Hand& hand : hands_) {
      // In double precision: somebody may send a hand from one end of the range of floats to the other.
      const typename Strength::Vector way =
          hand.to.template cast<double>() - hand.from.template cast<double>();
      const Vector velocity =
          Strength::limited(way / double{seconds}, Strength::kMostSpeed).template cast<float>();
      hand.velocity += kNewShare * (velocity - hand.velocity);
    }
  }
  /// Call it before each substep of the frame, `step` seconds long: a hand moves at constant speed from its old to its new position.
  /// @param gravity  m/s^2
  void pull(int substep, int substeps, const Vector& gravity, float step) {
    SC_ASSERT(0 <= substep && substep < substeps, "substep {} of {}", substep, substeps);
    const float share = static_cast<float>(substep + 1) / static_cast<float>(substeps);
    for (Hand& hand : hands_) {
      hand.grip->pull({(1 - share) * hand.from + share * hand.to, hand.velocity}, gravity, step);
      if (substep + 1 == substeps) hand.from = hand.to;
    }
  }

  /// Appends the held point and the hand's position for each hand, metres.
  void append(std::vector<std::array<Vector, 2>>& hands) const {
    for (const Hand& hand : hands_) hands.push_back({hand.grip->point(), hand.to});
  }

 private:
  // The weight of one frame in a hand's smoothed velocity: a mouse that reports only in every second frame does not jerk the body.
  static constexpr float kNewShare = 0.5f;

  struct Hand {
    std::uint32_t number;
    Vector from, to;  // in the frame
    Vector velocity;  // m/s, smoothed over frames
    std::unique_ptr<Grip<Dimension>> grip;
  };
  std::vector<Hand> hands_;
};

}  // namespace softcell::demos
