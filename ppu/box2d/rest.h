#pragma once
// Which soft bodies of a Box2D world may fall asleep, and with what.

#include <box2d/b2_world.h>

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "ppu/box2d/box2d_body.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// Who presses on whom among soft bodies that Box2D does not know.
struct SoftTouches {
  std::vector<std::pair<Box2dBody*, Box2dBody*>> soft;
  std::vector<std::pair<Box2dBody*, b2Body*>> rigid;
};

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
  /// @param touches  besides those that Box2D knows
  /// @return  the soft ones  @pre  the body is awake
  std::span<Box2dBody* const> settle(Box2dBody& body, const SleepSettings& settings,
                                     const SoftTouches& touches);

 private:
  bool rests(const Box2dBody& body, const SleepSettings& settings) const;
  bool rests(const b2Body& body, const SleepSettings& settings) const;
  void add_neighbours(b2Body& body, const SoftTouches& touches);
  void add_neighbours(Box2dBody& body, const SoftTouches& touches);
  void add(b2Body& body);
  void add(Box2dBody& body);

  const b2World& world_;
  SoftBodyOf soft_body_of_;
  std::vector<Box2dBody*> soft_;  // what was reached so far
  std::vector<b2Body*> rigid_;
};

}  // namespace softcell::ppu
