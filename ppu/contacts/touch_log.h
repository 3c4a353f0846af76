#pragma once
// Records which bodies touch from one poll() to the next, for the contact events of both engines.

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// What a soft body touches.
enum class TouchedKind { kSoft, kRigid, kTrigger };

/// @tparam Event  ContactEvent or ContactEvent2d. Used by one thread.
template <typename Event>
class TouchLog {
 public:
  using Vector = typename Event::Vector;
  /// A soft body's number, the kind of the other one, and its number: an order that does not depend on addresses.
  using Key = std::tuple<std::uint32_t, TouchedKind, std::uint64_t>;

  /// A pair that touches, or touched at the last poll.
  class Touch {
   public:
    Event event;

    /// Adds a contact point of the pair.
    /// @param impulse  kg m/s  @param weight  of the point in the mean of positions and normals, above 0
    void add(float impulse, float weight, const Vector& point, const Vector& normal) {
      if (!goes_on_) event.impulse = 0, weight_ = 0, event.position.setZero(), event.normal.setZero();
      goes_on_ = true;
      event.impulse += impulse;
      weight_ += weight;
      event.position += weight * point;
      event.normal += weight * normal;
    }

   private:
    friend TouchLog;
    Event take() {
      Event taken = event;
      taken.kind = is_old_ ? Event::Kind::kPersist : Event::Kind::kBegin;
      taken.position /= weight_;
      taken.normal = event.normal.norm() > 0 ? event.normal.normalized() : Vector::UnitY().eval();
      // An end event reports the place of the last touch.
      event.position = taken.position;
      event.normal = taken.normal;
      is_old_ = true;
      goes_on_ = false;
      return taken;
    }
    /// The event of the last poll again, without an impulse.
    Event persist() const {
      Event again = event;
      again.kind = Event::Kind::kPersist;
      again.impulse = 0;
      return again;
    }
    Event end() {
      if (goes_on_) take();
      Event last = event;
      last.kind = Event::Kind::kEnd;
      last.impulse = 0;
      return last;
    }

    bool is_old_ = false;   // it was part of the last poll
    bool goes_on_ = false;  // they have touched in a substep since then
    bool is_over_ = false;  // one of them has been removed
    float weight_ = 0;      // sum of weights since then; position and normal are still to be divided by it
  };

  /// Call it at the begin of each substep, before its contacts are added.
  void begin_step() { has_stepped_ = true; }
  Touch& operator[](const Key& key) { return touches_[key]; }
  void clear() { touches_.clear(); }

  /// Ends all touches of a body that is removed.
  template <typename Body>
  void forget(const Body& body) {
    for (auto& [key, touch] : touches_)
      if (touch.event.body == &body || touch.event.other == &body) touch.is_over_ = true;
  }

  /// Touches that have begun, gone on or ended since the last call, in the order of keys. Without a substep since then, all go on.
  std::vector<Event> poll() {
    std::vector<Event> events;
    for (auto entry = touches_.begin(); entry != touches_.end();) {
      Touch& touch = entry->second;
      // A touch that is over may be of a body that is gone.
      const bool goes_on =
          !touch.is_over_ && (!has_stepped_ || touch.goes_on_ || sleeps(entry->first, touch.event));
      if (!goes_on) {
        if (touch.is_old_) events.push_back(touch.end());
        entry = touches_.erase(entry);
        continue;
      }
      if (touch.goes_on_) {
        events.push_back(touch.take());
      } else if (!has_stepped_ && !sleeps(entry->first, touch.event)) {
        events.push_back(touch.persist());
      }
      ++entry;
    }
    has_stepped_ = false;
    return events;
  }

 private:
  /// Contacts of sleeping bodies are not looked for, so they go on; those of trigger volumes are looked for.
  static bool sleeps(const Key& key, const Event& event) {
    return std::get<TouchedKind>(key) != TouchedKind::kTrigger && event.body->asleep() &&
           (event.other == nullptr || event.other->asleep());
  }

  std::map<Key, Touch> touches_;
  bool has_stepped_ = false;  // since the last poll()
};

}  // namespace softcell::ppu
