#pragma once
// The state of a run that events change: gravity, tilt, hands, time scale, substeps, pause.

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "hands.h"
#include "input_event.h"

namespace softcell::demos {

/// It leaves to the simulation what only the simulation can do: see apply(). One thread uses it.
template <int Dimension>
class Controls {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  /// The values that a reset also restores.
  struct Initial {
    Vector gravity = Vector::Zero();  ///< m/s^2
    std::optional<Vector> tilt = {};  ///< as for tilt()
    float time_scale = 1;
  };
  explicit Controls(const Initial& initial)
      : initial_(initial), gravity_(initial.gravity), tilt_(initial.tilt), time_scale_(initial.time_scale) {}

  /// Applies events in their order.
  /// @param bodies  the soft bodies: see Hands
  /// @param world   has reset(), which restores bodies and world as they were at the beginning; home(i), which does the
  ///                same for soft body i; hold(event), hold_rigid(event), move_hand(event) and release(hand) for hands that
  ///                hold more than a particle; set_material(event, i) for soft body i; cut(event); pin(hand); unpin(event)
  template <class Bodies, class World>
  void apply(std::span<const Event> events, Bodies& bodies, World& world) {
    for (const Event& event : events) {
      switch (event.action) {
        case Action::kGrab:
          world.release(event.hand);
          hands_.grab(event, bodies);
          break;
        case Action::kHold:
          hands_.release(event.hand);
          world.release(event.hand);
          world.hold(event);
          break;
        case Action::kHoldRigid:
          hands_.release(event.hand);
          world.release(event.hand);
          world.hold_rigid(event);
          break;
        case Action::kMoveHand:
          hands_.move(event);
          world.move_hand(event);
          break;
        case Action::kRelease:
          hands_.release(event.hand);
          world.release(event.hand);
          break;
        case Action::kPush:
          for_each(event.body, bodies, [&](std::size_t b) { bodies[b].add_velocity(event.value); });
          break;
        case Action::kGravity:
          gravity_ = event.value;
          break;
        case Action::kReset:
          hands_.release_all();
          gravity_ = initial_.gravity;
          tilt_ = initial_.tilt;
          time_scale_ = initial_.time_scale;
          due_ = 0;
          substeps_.reset();
          world.reset();
          break;
        case Action::kPause:
          paused_ = true;
          break;
        case Action::kResume:
          paused_ = false;
          break;
        case Action::kSingleStep:
          single_step_ = true;
          break;
        case Action::kHome:
          for_each(event.body, bodies, [&](std::size_t b) { world.home(b); });
          break;
        case Action::kTilt:
          tilt_ = event.value;
          break;
        case Action::kTimeScale:
          time_scale_ = number(event);
          break;
        case Action::kSubsteps:
          substeps_ = static_cast<int>(number(event));
          break;
        case Action::kAlpha:
        case Action::kFrequency:
        case Action::kModulus:
        case Action::kDamping:
        case Action::kFriction:
        case Action::kYield:
        case Action::kCreep:
          for_each(event.body, bodies, [&](std::size_t b) { world.set_material(event, b); });
          break;
        case Action::kCut:
          world.cut(event);
          break;
        case Action::kPin:
          world.pin(event.hand);
          break;
        case Action::kUnpin:
          world.unpin(event);
          break;
      }
    }
  }

  /// The number of substeps that are due in this frame: none in a pause, `substeps` in a single step. In slow motion some frames have none;
  /// the substeps are as long as always, and bodies as stiff. It ends a single step, so call it once per frame. @param substeps  per 1/60 s
  int due_substeps(int substeps) {
    if (std::exchange(single_step_, false) && paused_) return substeps;
    if (paused_) return 0;
    due_ += time_scale_ * static_cast<float>(substeps);
    const int now = static_cast<int>(due_);
    due_ -= static_cast<float>(now);
    return now;
  }

  float time_scale() const { return time_scale_; }
  /// Substeps per 1/60 s. @param of_scene  their number unless somebody has changed it
  int substeps(int of_scene) const { return substeps_.value_or(of_scene); }
  const Vector& gravity() const { return gravity_; }           ///< m/s^2
  const std::optional<Vector>& tilt() const { return tilt_; }  ///< radians; none: the scene's own
  const Hands<Dimension>& hands() const { return hands_; }
  /// @see Hands
  void forget_body(std::size_t body) { hands_.forget_body(body); }
  /// @see Hands
  template <class Follow>
  void follow_particles(const Follow& follow) {
    hands_.follow_particles(follow);
  }
  bool paused() const { return paused_; }

 private:
  static float number(const Event& event) {
    const NumberRange& range = *number_of(event.action);
    return std::clamp(event.value[0], range.low, range.high);
  }

  template <class Bodies, class Do>
  static void for_each(std::uint32_t body, const Bodies& bodies, const Do& act) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (body == kEveryBody || body == b) act(b);
    }
  }

  Hands<Dimension> hands_;
  Initial initial_;
  Vector gravity_;
  std::optional<Vector> tilt_;
  bool paused_ = false, single_step_ = false;
  float time_scale_, due_ = 0;   // due_: the part of a substep that is due
  std::optional<int> substeps_;  // none: the scene's
};

}  // namespace softcell::demos
