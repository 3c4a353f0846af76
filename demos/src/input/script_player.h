#pragma once
// Turns a scene's script into the events of each frame.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "input_event.h"
#include "scene/scripted_input.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// Frames last 1/60 s and are counted from 0; an event of the script happens at the frame nearest to its time. One thread uses it; the
/// script must outlive it.
template <int Dimension>
class ScriptPlayer {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  explicit ScriptPlayer(const ScriptedInput<Dimension>& script) : script_(script) {}

  /// The events at the beginning of a frame. Valid until the next call.
  std::span<const Event> events_at(std::int64_t frame) {
    SC_ASSERT(frame >= 0, "frame {}", frame);
    events_.clear();
    for (const float time : script_.resets) {
      if (frame_at(time) == frame) events_.push_back({.action = Action::kReset});
    }
    add_pauses(frame);
    for (const GravityChange& change : script_.gravity) {
      if (frame_at(change.time) == frame)
        events_.push_back({.action = Action::kGravity, .value = Vector::Unit(1) * -change.gravity});
    }
    for (const auto& impulse : script_.impulses) {
      if (frame_at(impulse.time) == frame) {
        events_.push_back({.action = Action::kPush,
                           .body = static_cast<std::uint32_t>(impulse.body),
                           .value = impulse.velocity});
      }
    }
    for (std::uint32_t i = 0; i < script_.drags.size(); ++i) add_drag(i, frame);
    return events_;
  }

 private:
  static std::int64_t frame_at(float time) { return std::llround(double{time} * 60); }

  /// Pauses may touch and overlap: time goes on where the last of them ends. A pause that ends at the frame at which it begins has no
  /// effect.
  void add_pauses(std::int64_t frame) {
    bool begins = false, ends = false, covered = false;
    for (const ScriptedPause& pause : script_.pauses) {
      const std::int64_t begin = frame_at(pause.begin), end = frame_at(pause.end);
      if (begin == end) continue;
      begins = begins || begin == frame;
      ends = ends || end == frame;
      covered = covered || (begin <= frame && frame < end);
    }
    if (ends && !covered) events_.push_back({.action = Action::kResume});
    if (begins) events_.push_back({.action = Action::kPause});
  }

  void add_drag(std::uint32_t hand, std::int64_t frame) {
    SC_ASSERT(hand < script_.drags.size(), "drag {} of {}", hand, script_.drags.size());
    const auto& drag = script_.drags[hand];
    const std::int64_t begin = frame_at(drag.begin), end = frame_at(drag.end);
    if (frame < begin || frame > end) return;
    if (frame == begin) {
      events_.push_back({.action = Action::kGrab,
                         .hand = hand,
                         .body = static_cast<std::uint32_t>(drag.body),
                         .value = drag.from});
    }
    if (frame == end) {
      events_.push_back({.action = Action::kRelease, .hand = hand});
      return;
    }
    const auto share = static_cast<float>(frame - begin) / static_cast<float>(end - begin);
    events_.push_back(
        {.action = Action::kMoveHand, .hand = hand, .value = drag.from + share * (drag.to - drag.from)});
  }

  const ScriptedInput<Dimension>& script_;
  std::vector<Event> events_;
};

}  // namespace softcell::demos
