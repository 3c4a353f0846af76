#pragma once
// A soft body that touches nothing (SoftBodySettings::contacts is false). Neither Bullet nor the contact solver knows of it.

#include <memory>
#include <optional>
#include <utility>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/coupled_body.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

class FreeBody final : public CoupledBody {
 public:
  FreeBody(btDiscreteDynamicsWorld& world, SoftBody<3> soft) : CoupledBody(world, std::move(soft)) {
    SC_ASSERT(soft_.model().outer().empty(), "a body that touches nothing has {} particles that touch",
              soft_.model().outer().size());
  }

  void begin_substep() override {
    if (!was_changed()) return;
    rouse();
    see_changes();
  }
  bool was_pushed() const override { return false; }
  void apply(float) override {}

  void end_substep(float step, const std::optional<SleepSettings>& sleep) override {
    if (soft_.asleep()) {
      if (sleep && !falls_another_way()) return;
      rouse();
    }
    soft_.advance_inner(step, to_eigen(world_.getGravity()));
    if (sleep) fall_asleep_when_still(step, *sleep);
  }

  bool can_be_touched() const override { return false; }
  bool can_break() const override { return true; }
  Bounds<3> box() const override { return soft_.bounds(); }
  float reach() const override { return 0; }

 private:
  void fall_asleep() override {}
};

}  // namespace softcell::ppu
