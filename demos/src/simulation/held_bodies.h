#pragma once
// What hands hold, and how these hands move, in either dimension.

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

  /// The hand lets go of what it has, and takes this. It is where it takes the body: nothing jumps.
  void hold(std::uint32_t hand, std::unique_ptr<Grip<Dimension>> grip) {
    SC_ASSERT(grip != nullptr, "hand {} takes nothing", hand);
    release(hand);
    const Vector at = grip->point();
    hands_.push_back({hand, at, at, Vector::Zero(), std::move(grip)});
  }
  /// @param to  metres: where the hand is at the end of the frame
  void move(std::uint32_t hand, const Vector& to) {
    for (Hand& held : hands_) {
      if (held.number == hand) held.to = to;
    }
  }
  /// Throws what the hand holds.
  void release(std::uint32_t hand) {
    for (const Hand& held : hands_) {
      if (held.number == hand) held.grip->let_go(held.velocity);
    }
    std::erase_if(hands_, [hand](const Hand& held) { return held.number == hand; });
  }
  /// What the hand holds of a soft body.
  std::optional<HeldPart<Dimension>> part(std::uint32_t hand) const {
    for (const Hand& held : hands_)
      if (held.number == hand) return held.grip->part();
    return std::nullopt;
  }
  /// The body has broken, or is gone. @param body  its address
  void forget(const void* body) {
    std::erase_if(hands_, [body](const Hand& held) { return held.grip->holds(body); });
  }
  /// Bodies have broken, in this order: hands go on with what they held, if it has not vanished.
  void follow(std::span<const ppu::BrokenBody<Dimension>> broken) {
    for (Hand& hand : hands_)
      if (auto grip = hand.grip->follow(broken)) hand.grip = std::move(*grip);
    std::erase_if(hands_, [](const Hand& hand) { return hand.grip == nullptr; });
  }
  /// What was held stays as it is.
  void release_all() { hands_.clear(); }
  bool empty() const { return hands_.empty(); }

  /// After the events of a frame of `seconds`.
  void begin_frame(float seconds) {
    SC_ASSERT(seconds > 0, "a frame of {} s", seconds);
    using Strength = HandStrength<Dimension>;
    for (Hand& hand : hands_) {
      // Wherever somebody sends it, from one end of the range of numbers to the other.
      const typename Strength::Vector way =
          hand.to.template cast<double>() - hand.from.template cast<double>();
      const Vector velocity =
          Strength::limited(way / double{seconds}, Strength::kMostSpeed).template cast<float>();
      hand.velocity += kNewShare * (velocity - hand.velocity);
    }
  }
  /// Before each substep of the frame, `step` seconds long: a hand moves evenly from where it was to where it is.
  /// @param gravity  m/s^2
  void pull(int substep, int substeps, const Vector& gravity, float step) {
    SC_ASSERT(0 <= substep && substep < substeps, "substep {} of {}", substep, substeps);
    const float share = static_cast<float>(substep + 1) / static_cast<float>(substeps);
    for (Hand& hand : hands_) {
      hand.grip->pull({(1 - share) * hand.from + share * hand.to, hand.velocity}, gravity, step);
      if (substep + 1 == substeps) hand.from = hand.to;
    }
  }

  /// Appends, for each hand, where it holds a body and where it is itself, metres.
  void append(std::vector<std::array<Vector, 2>>& hands) const {
    for (const Hand& hand : hands_) hands.push_back({hand.grip->point(), hand.to});
  }

 private:
  // Of a hand's velocity, what one frame counts: a mouse that reports in every other frame moves no body in jerks.
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
