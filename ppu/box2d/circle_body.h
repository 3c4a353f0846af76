#pragma once
// A soft body whose outer particles are b2Bodies with a circle each.

#include <box2d/b2_fixture.h>

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/box2d/box2d_body.h"

namespace softcell::ppu {

/// Its particles are in the order of SoftBodyModel::outer().
class CircleBody final : public Box2dBody {
 public:
  /// @param group  below 0 and used by no other body: Box2D makes no contacts within a negative group.
  CircleBody(b2World& world, SoftBody<2> soft, std::int16_t group);
  ~CircleBody() override;

  std::int16_t group() const { return group_; }
  std::span<b2Body* const> particles() const override { return particles_; }
  b2Body* particle(std::uint32_t number) const override { return of_number_[number]; }

  void set_filter(const CollisionFilter& filter) override;
  bool was_pushed() const override;
  /// Sets the new velocities, with which Box2D integrates.
  void hand_over(float step) override;
  /// Takes over outer particles from Box2D; inner ones follow them.
  void end_step(float step) override;
  void shift(const Eigen::Vector2f& by) override;

 private:
  /// A rigid body that a particle touched when the body fell asleep.
  struct Support {
    const b2Body* body;
    b2Transform pose;
  };

  bool was_disturbed() const override;
  void remember_supports();
  bool has_lost_support() const;
  void exchange_particles() override;
  void gather_particles() override;
  void place_particles() override;
  void place_particle(std::size_t particle) override;
  void set_particles_awake(bool awake) override;
  void add_particles();
  void add_particle(std::uint32_t number);
  void remove_particles();
  b2Filter own_filter() const;

  std::int16_t group_;
  std::vector<b2Body*> particles_;
  std::vector<Support> supports_;   // filled while the body sleeps
  std::vector<b2Body*> of_number_;  // by the particle's number in the body; null: an inner particle
};

}  // namespace softcell::ppu
