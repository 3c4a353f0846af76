#pragma once
// Which soft bodies of a Box2D world may fall asleep, and with what.

#include <box2d/b2_world.h>

#include <functional>
#include <utility>
#include <vector>

#include "ppu/box2d/box2d_body.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// What touches, or hangs together by joints, rests as a whole or not at all: soft bodies and those rigid ones
/// that can move. Were bodies to fall asleep one by one, those that are awake yet would wake those below them
/// again and again.
class Rest {
 public:
  /// The soft body of a b2Body, null for others.
  using SoftBodyOf = std::function<Box2dBody*(const b2Body&)>;

  Rest(const b2World& world, SoftBodyOf soft_body_of)
      : world_(world), soft_body_of_(std::move(soft_body_of)) {}

  /// Puts `body` to sleep with all that it touches, if all of it has been at rest for long enough.
  /// @pre  the body is awake.
  void settle(Box2dBody& body, const SleepSettings& settings);

 private:
  bool rests(const Box2dBody& body, const SleepSettings& settings) const;
  bool rests(const b2Body& body, const SleepSettings& settings) const;
  void add_neighbours(b2Body& body);
  void add(b2Body& body);

  const b2World& world_;
  SoftBodyOf soft_body_of_;
  std::vector<Box2dBody*> soft_;  // what was reached so far
  std::vector<b2Body*> rigid_;
};

}  // namespace softcell::ppu
