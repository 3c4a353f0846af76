#pragma once
// What a hand at the mouse, a scene's script or a recording does to a simulation: a short list of plain data for each frame. The simulation
// treats all three alike.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "scene/frame_time.h"

namespace softcell::demos {

enum class Action : std::uint8_t {
  kGrab,        ///< the hand takes the particle nearest to `value` (m) of `body`, and lets go of another
  kMoveHand,    ///< the hand is at `value` (m) now; no effect if it holds nothing
  kRelease,     ///< the hand lets go
  kPush,        ///< `value` (m/s) is added to all particles of `body`
  kGravity,     ///< `value` (m/s^2) is gravity from now on
  kReset,       ///< restores the beginning, gravity included; hands let go. A pause goes on.
  kPause,       ///< time stands still
  kResume,      ///< time goes on
  kSingleStep,  ///< during a pause: simulates one frame
  kHome,        ///< puts `body` where it was at the beginning, at rest and in its own shape
  kTilt,        ///< in 3D: the ground is tilted by `value` (radians) about x, then z, from now on; its y is 0
  kHold,        ///< the hand lets go, and holds soft body `body` at `value` (m), in 3D on its surface
  kHoldRigid,   ///< the hand holds rigid body `body` of the scene at `value` (m), if it moves; likewise
  // Actions with a number, which is the first of `value`; kNumbers has its range:
  kTimeScale,  ///< how fast time passes: 1 as on the clock, less is slow motion
  kSubsteps,   ///< per frame, from now on
  kAlpha,      ///< of `body`: see ppu::SoftBodySettings, for this and the next six
  kFrequency,
  kModulus,  ///< sets alpha
  kDamping,
  kFriction,
  kYield,  ///< makes the body plastic, if it has few enough particles; 0 makes it elastic
  kCreep,  ///< of a plastic body
  /// A blade that reaches from `value` (m) along `edge` (m) moves by `way` (m), and cuts `body` and its pieces. In 2D it is a point without
  /// an edge.
  kCut,
  kPin,    ///< the part of a soft body that the hand holds stays where it is in the world, if there is one
  kUnpin,  ///< takes the pins of `body` and its pieces off
};
inline constexpr int kActions = 25;

/// The range of an action's number.
struct NumberRange {
  Action action;
  float low, high;
  bool whole = false;
};
inline constexpr std::array<NumberRange, 9> kNumbers{{{Action::kTimeScale, 0.02f, 4},
                                                      {Action::kSubsteps, 1, kMaxSubsteps, true},
                                                      {Action::kAlpha, 0, 1},
                                                      {Action::kFrequency, 0, 1000},
                                                      {Action::kModulus, 0, 1e9f},
                                                      {Action::kDamping, 0, 1},
                                                      {Action::kFriction, 0, 100},
                                                      {Action::kYield, 0, 1},
                                                      {Action::kCreep, 0.001f, 1e6f}}};
/// Null: the action has no number.
inline const NumberRange* number_of(Action action) {
  const auto* const found = std::ranges::find(kNumbers, action, &NumberRange::action);
  return found == kNumbers.end() ? nullptr : found;
}

/// A value of `body`: for grabbing and holding, the body with the nearest particle; for other actions, all bodies.
inline constexpr std::uint32_t kEveryBody = std::numeric_limits<std::uint32_t>::max();
/// Values of `hand`: the user's hand at the mouse, and the two at a controller. The hands of a script are numbered from 0, one for each
/// drag.
inline constexpr std::uint32_t kUsersHand = std::numeric_limits<std::uint32_t>::max(),
                               kUsersLeftHand = kUsersHand - 1, kUsersRightHand = kUsersHand - 2;
inline constexpr bool is_users_hand(std::uint32_t hand) { return hand >= kUsersRightHand; }

/// It happens at the beginning of a frame. Fields that the action does not use are 0. Dimension: 2 or 3.
template <int Dimension>
struct InputEvent {
  using Vector = Eigen::Matrix<float, Dimension, 1>;

  Action action = Action::kPause;
  std::uint32_t hand = 0;
  std::uint32_t body = 0;
  Vector value = Vector::Zero();
  Vector edge = Vector::Zero(), way = Vector::Zero();

  bool operator==(const InputEvent&) const = default;
};

}  // namespace softcell::demos
