#pragma once
// A soft body that touches with its drawn surface. Bullet does not know of it: surface_contacts.h moves it.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/coupled_body.h"
#include "ppu/bullet/seen_object.h"
#include "ppu/contacts/contact_body.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

class SurfaceBody final : public CoupledBody {
 public:
  /// @param contact  of the model
  /// @param number  different from those of all other bodies of the world
  SurfaceBody(btDiscreteDynamicsWorld& world, SoftBody<3> soft, std::shared_ptr<const ContactModel> contact,
              std::uint32_t number)
      : CoupledBody(world, std::move(soft)), contact_(std::move(contact)), number_(number) {}

  std::uint32_t number() const { return number_; }
  const ContactModel& contact() const { return *contact_; }
  /// Tells that the body has another model than before. @param contact  of the new model
  void set_contact(std::shared_ptr<const ContactModel> contact) {
    SC_ASSERT(contact->model() == soft_.shared_model(), "a body of {} particles touches as one of {}",
              soft_.model().particles(), contact->masses().size());
    contact_ = std::move(contact);
  }

  void begin_substep() override {
    if (soft_.position(0) != place_of_sides_) set_sides({});  // the program has moved the body
    if (!was_changed()) return;
    rouse();
    see_changes();
  }
  bool was_pushed() const override { return false; }

  /// Adds gravity; contacts come after it and move the particles.
  void apply(float step) override {
    if (soft_.asleep()) return;
    SC_ASSERT(step > 0, "a substep of {} s", step);
    const Eigen::Vector3f dv = step * to_eigen(world_.getGravity());
    for (std::size_t i = 0; i < soft_.velocities().size(); ++i)
      soft_.set_velocity(i, soft_.velocities()[i] + dv);
  }

  void end_substep(float step, const std::optional<SleepSettings>& sleep) override {
    if (soft_.asleep()) {
      if (sleep && !falls_another_way()) return;
      rouse();
    }
    if (!soft_.asleep()) {
      box_asleep_.reset();
      seen_.clear();
    }
    if (sleep) count_stillness(step, *sleep);
    place_of_sides_ = soft_.position(0);
    is_still_ = sleep && stillness_.seconds() >= sleep->seconds;
  }
  /// Whether it has been still for long enough to fall asleep, if nothing else kept it awake.
  bool is_still() const { return is_still_; }

  /// The body sleeps together with those that it touches (surface_contacts.h) or, if it is attached, with those that it is attached to.
  bool may_fall_asleep(const SleepSettings& sleep) const {
    return stillness_.seconds() >= sleep.seconds && !holds_a_moving_body_;
  }
  void fall_asleep_with_others() { fall_asleep_now(); }

  /// @param speed  m/s: with which the particles of a crushed body have really moved in this substep; none of any other body
  void set_real_speed(const std::optional<float>& speed) { real_speed_ = speed; }

  /// The sides of rigid triangles on which the body is.
  KnownSides& sides() { return sides_; }
  const KnownSides& sides() const { return sides_; }
  void set_sides(const KnownSides& sides) {
    sides_ = sides;
    place_of_sides_ = soft_.position(0);
  }

  void set_attached(bool attached) { is_attached_ = attached; }
  bool is_attached() const { return is_attached_; }

  /// Bodies that touched each other in the last substep, directly or through others, have the same number. None: it has not touched a soft
  /// body yet.
  void set_island(std::uint32_t island) { island_ = island; }
  std::optional<std::uint32_t> island() const { return island_; }

  /// Whether a rigid body that is awake lies on it: then the soft body must go on carrying it.
  void set_holds_a_moving_body(bool holds) { holds_a_moving_body_ = holds; }

  bool can_be_touched() const override { return true; }
  bool can_break() const override { return true; }
  Bounds<3> box() const override { return soft_.bounds(); }
  std::optional<Bounds<3>> box_asleep() const override { return box_asleep_; }

  /// Has a sleeper remember an object near it as it is now, unless it knows it. @param place  its index in the world's list of objects
  void see(int place) {
    const btCollisionObject& object = *world_.getCollisionObjectArray()[place];
    const auto is_known = [&](const SeenObject& seen) { return seen.is(object); };
    if (std::ranges::none_of(seen_, is_known)) seen_.emplace_back(world_, place);
  }
  /// Whether an object that the body has seen since it fell asleep is gone, has changed, or has moved, however slowly, by more than the
  /// depth that contacts allow.
  bool notices_a_change() {
    if (!box_asleep_) box_asleep_ = soft_.bounds();  // for a sleeping body that was assigned to this one
    const Eigen::Vector3f middle = 0.5f * (box_asleep_->low + box_asleep_->high);
    const float far = kCreep * soft_.model().lattice().spacing;
    return std::ranges::any_of(seen_,
                               [&](SeenObject& seen) { return seen.has_changed(world_, middle, far); });
  }
  float reach() const override { return 0.1f * soft_.model().lattice().spacing; }

 private:
  static constexpr float kCreep = 0.02f;  // cells

  void fall_asleep() override { box_asleep_ = soft_.bounds(); }

  KnownSides sides_;
  Eigen::Vector3f place_of_sides_{0, 0, 0};  // where the first particle was when sides_ last applied
  std::optional<Bounds<3>> box_asleep_;
  std::vector<SeenObject> seen_;  // objects near the body since it fell asleep
  std::shared_ptr<const ContactModel> contact_;
  std::uint32_t number_;
  bool holds_a_moving_body_ = false, is_still_ = false;
  bool is_attached_ = false;
  std::optional<std::uint32_t> island_;
};

}  // namespace softcell::ppu
