#pragma once
// A contact filter that keeps particles of soft bodies from touching: Box2D asks it about each new pair of fixtures.

#include <box2d/b2_contact_manager.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_world.h>
#include <box2d/b2_world_callbacks.h>

#include <functional>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Changes nothing in the world before install(). From then on it asks the world's own filter first, and it restores that filter when it is
/// destroyed.
/// Used by the thread that steps the world.
class Box2dFilter final : private b2ContactFilter {
 public:
  /// Answers whether two fixtures may touch.
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
  b2ContactFilter* before_ = nullptr;  // the world's own filter, after install()
};

}  // namespace softcell::ppu
