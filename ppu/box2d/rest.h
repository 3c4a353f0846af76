#pragma once
// Decides which soft bodies of a Box2D world may fall asleep, and together with which others.

#include <box2d/b2_world.h>

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "ppu/box2d/box2d_body.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// What soft bodies touch or are attached to, as far as Box2D does not know of it.
struct SoftNeighbours {
  std::vector<std::pair<Box2dBody*, Box2dBody*>> soft;
  std::vector<std::pair<Box2dBody*, b2Body*>> rigid;
};

/// Bodies that touch or are joined, soft ones and rigid ones that can move, fall asleep together or not at all. If bodies fell asleep one
/// by one, those that are still awake would wake those below them again and again.
class Rest {
 public:
  /// The soft body of a b2Body, null for others.
  using SoftBodyOf = std::function<Box2dBody*(const b2Body&)>;

  Rest(const b2World& world, SoftBodyOf soft_body_of)
      : world_(world), soft_body_of_(std::move(soft_body_of)) {}

  /// Puts `body` to sleep with all that it touches, if all of it has been at rest for long enough.
  /// @param beside  what keeps bodies awake besides what Box2D knows to touch or to be joined
  /// @return  the soft bodies put to sleep  @pre  the body is awake
  std::span<Box2dBody* const> settle(Box2dBody& body, const SleepSettings& settings,
                                     const SoftNeighbours& beside);

 private:
  bool rests(const Box2dBody& body, const SleepSettings& settings) const;
  bool rests(const b2Body& body, const SleepSettings& settings) const;
  void add_neighbours(b2Body& body, const SoftNeighbours& beside);
  void add_neighbours(Box2dBody& body, const SoftNeighbours& beside);
  void add(b2Body& body);
  void add(Box2dBody& body);

  const b2World& world_;
  SoftBodyOf soft_body_of_;
  std::vector<Box2dBody*> soft_;  // bodies reached so far
  std::vector<b2Body*> rigid_;
};

}  // namespace softcell::ppu
