#pragma once
// Which particles of soft bodies do not touch something: asked by Box2D about any two that are new to each other.

#include <box2d/b2_contact_manager.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_world.h>
#include <box2d/b2_world_callbacks.h>

#include <functional>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Nothing of it is in the world before install(). From then on it asks the world's own filter first, which it puts back at its end.
/// Used by the thread that steps the world.
class Box2dFilter final : private b2ContactFilter {
 public:
  /// Whether two may touch.
  using Question = std::function<bool(b2Fixture&, b2Fixture&)>;

  Box2dFilter(b2World& world, Question question) : world_(world), question_(std::move(question)) {}
  ~Box2dFilter() override {
    if (before_ != nullptr && world_.GetContactManager().m_contactFilter == this)
      world_.SetContactFilter(before_);
  }
  Box2dFilter(const Box2dFilter&) = delete;
  Box2dFilter& operator=(const Box2dFilter&) = delete;

  void install() {
    if (before_ != nullptr) return;
    SC_ASSERT(!world_.IsLocked(), "a filter of {} bodies is installed within a step", world_.GetBodyCount());
    before_ = world_.GetContactManager().m_contactFilter;
    world_.SetContactFilter(this);
  }

 private:
  bool ShouldCollide(b2Fixture* a, b2Fixture* b) override {
    return before_->ShouldCollide(a, b) && question_(*a, *b);
  }

  b2World& world_;
  Question question_;
  b2ContactFilter* before_ = nullptr;  // the world's, once this one is in its place
};

}  // namespace softcell::ppu
