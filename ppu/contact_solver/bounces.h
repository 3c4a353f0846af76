#pragma once
// Restitution: a body that hits something fast enough leaves it as a rigid body would. A body that a sharp edge would crush is stopped as a
// rigid body would be.
//
// Shape matching carries an impulse from the surface to the rest of a body one substep later, so a restitution of the surface alone is lost
// inside the body. Bounces therefore change the rigid motion of whole bodies: six numbers each. They are solved before the other contacts,
// which then find the bodies already on their way back. A sleeping soft body acts as a wall in the substep in which it is hit, and one that
// attachments hold at more than a line always acts as a wall that moves as what holds it.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/obstacles/contact_rigid.h"

namespace softcell::ppu {

struct BounceSettings {
  float least_speed = 0.2f;  ///< m/s: slower impacts do not bounce, so that bodies come to rest
  /// m/s^2, of soft bodies and of rigid ones that move; their velocities already include it.
  Eigen::Vector3f gravity{0, 0, 0};
  /// How two restitutions are combined: by their product, as in Bullet, or by the larger one, as in Box2D.
  enum class Mix { kProduct, kLarger } mix = Mix::kProduct;

  float restitution_of(float a, float b) const { return mix == Mix::kProduct ? a * b : std::max(a, b); }
  /// Whether a body with that restitution may bounce off anything.
  bool may_bounce(float restitution) const { return mix == Mix::kLarger || restitution > 0; }
};

/// A contact that bounces if it is fast enough; or a sharp contact, which limits how far a body moves on.
struct BounceContact {
  static constexpr float kNoLimit = SoftContact::kNoLimit;
  static constexpr std::uint32_t kNobody = ~0u;
  std::uint32_t a = 0, b = kNobody;  ///< bodies; b kNobody: `rigid`
  std::uint32_t rigid = 0;
  Eigen::Vector3f point{0, 0, 0};   ///< metres: a's point at the substep's end if nothing touched
  Eigen::Vector3f normal{0, 1, 0};  ///< from the other one to a
  float gap = 0;                    ///< metres at the substep's beginning, not negative
  float approach = 0;               ///< m/s, of the two surfaces against each other
  float restitution = 0;            ///< 0..1; ignored for a sharp contact
  float room = kNoLimit;            ///< metres, SoftContact::room
  std::uint32_t cell = 0;           ///< of a, for a sharp contact
  float friction = 0;

  bool is_sharp() const { return room < kNoLimit; }
};

/// Used by one thread. Allocates when there are more contacts or bodies than ever before.
class Bounces {
 public:
  void clear() { contacts_.clear(), bounces_.clear(); }
  void add(const BounceContact& contact);
  bool empty() const { return contacts_.empty(); }

  /// Changes the velocities of bodies that bounce, and their pushes: in this substep a body moves with its old velocity until it touches,
  /// and with its new velocity afterwards. This keeps momentum, angular momentum and, if the restitution is 1, energy, except for what
  /// gravity does within the substep.
  void solve(std::span<ContactBody> bodies, std::span<ContactRigid> rigids, const BounceSettings& settings,
             float step);

  /// Calls work(contact, impulse) for each impulse on a body in the last solve(): kg m/s along the normal, above 0.
  template <typename Work>
  void for_each_impulse(const Work& work) const {
    for (const Bounce& bounce : bounces_)
      if (bounce.impulse > 0) work(contacts_[bounce.contact], static_cast<float>(bounce.impulse));
  }

  /// Calls work(rigid, point, impulse) for each impulse on a rigid body in the last solve(): kg m/s, at a place in the world.
  template <typename Work>
  void for_each_impulse_on_rigid(const Work& work) const {
    for (const Bounce& bounce : bounces_)
      if (contacts_[bounce.contact].b == BounceContact::kNobody)
        work(contacts_[bounce.contact].rigid, Eigen::Vector3f(bounce.point_b.cast<float>()),
             Eigen::Vector3f((-bounce.impulse * bounce.normal - bounce.friction_impulse).cast<float>()));
  }

  /// The bodies of the last solve() whose velocities have changed, ascending.
  std::span<const std::uint32_t> changed() const { return changed_; }

 private:
  /// The part of a body that moves as if it were rigid. If the body bounces, this is all of it. A sharp edge stops only what is near: the
  /// ends of a long body fall on.
  struct Part {
    static constexpr float kEverything = std::numeric_limits<float>::infinity();
    Bounds<3> cells{};  ///< around the low corners of cells that meet something sharp, by Lattice::cells
    float thickness = kEverything;  ///< cells: all moves as far from these, and nothing twice as far
    /// 0..1: the share of a particle's mass that counts, and of the part's change of motion that it gets.
    double share_of(const Eigen::Vector3i& particle) const;
  };
  /// A part of a body treated as rigid, at the moment of its first touch.
  struct Whole {
    Eigen::Vector3d centre{0, 0, 0};
    Eigen::Vector3d velocity{0, 0, 0}, spin{0, 0, 0};
    Eigen::Vector3d velocity_before{0, 0, 0}, spin_before{0, 0, 0};
    double inverse_mass = 0;
    Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
    const HeldMobility* held = nullptr;  ///< null: it is free

    Eigen::Vector3d velocity_at(const Eigen::Vector3d& point) const {
      return velocity + spin.cross(Eigen::Vector3d(point - centre));
    }
    struct Change {
      Eigen::Vector3d velocity, spin;
    };
    Change change_by(const Eigen::Vector3d& point, const Eigen::Vector3d& impulse) const;
    /// By the impulses so far.
    Eigen::Vector3d change_at(const Eigen::Vector3d& point) const {
      return velocity - velocity_before + (spin - spin_before).cross(point - centre);
    }
    /// Keeps a share of what the impulses have changed.
    void keep(double share) {
      velocity = velocity_before + share * (velocity - velocity_before);
      spin = spin_before + share * (spin - spin_before);
    }
    double mobility(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
    void push(const Eigen::Vector3d& point, const Eigen::Vector3d& impulse);
  };
  /// A contact that is being solved.
  struct Bounce {
    std::uint32_t contact = 0;
    Whole *a = nullptr, *b = nullptr;
    Eigen::Vector3d point{0, 0, 0};  ///< world, when a touches
    /// Likewise; of a rigid b, which changes its velocity at once, as it is at the substep's beginning.
    Eigen::Vector3d point_b{0, 0, 0};
    Eigen::Vector3d normal{0, 1, 0};
    /// m/s: the velocity of a against b at that moment, gravity until then included.
    Eigen::Vector3d hits{0, 0, 0};
    double target = 0, mobility = 1, impulse = 0;
    Eigen::Vector3d friction_impulse{0, 0, 0};

    Eigen::Vector3d whole_impulse() const { return impulse * normal + friction_impulse; }
  };

  /// The kinetic energy, in joules, that bodies which hit each other gain in the frame of what they hit, if they keep a share s of their
  /// impulses: s linear + s^2 square.
  struct Gain {
    double linear = 0, square = 0;
    /// The largest share that gains nothing.
    double share_kept() const {
      return linear + square > 0 && square > 0 ? std::max(0.0, -linear / square) : 1.0;
    }
  };

  static Whole whole_of(const ContactBody& body, const Part& part, double time,
                        const Eigen::Vector3d& gained);
  static Whole whole_of(const ContactRigid& rigid);
  /// The least velocity of a against b along the normal after the bounce, m/s; none: the contact needs no change.
  /// @param share  of the substep, until they touch
  static std::optional<double> target_of(const BounceContact& contact, Bounce& bounce, double share,
                                         const BounceSettings& settings, double step);
  void choose_contacts();
  void choose_parts(std::span<const ContactBody> bodies);
  void choose(std::span<const ContactBody> bodies, std::span<const ContactRigid> rigids,
              const BounceSettings& settings, float step);
  void iterate();
  std::uint32_t set_of(const Whole& whole) {
    return together_.find(static_cast<std::uint32_t>(&whole - wholes_.data()));
  }
  std::uint32_t set_of(const Bounce& bounce) {
    return set_of(bounce.a->inverse_mass > 0 ? *bounce.a : *bounce.b);
  }
  void find_those_together();
  void take_back_gained_energy();
  void apply(std::span<ContactBody> bodies, std::span<ContactRigid> rigids, float step) const;

  std::vector<BounceContact> contacts_;
  std::vector<std::uint32_t> chosen_;            // of contacts_
  std::vector<std::uint32_t> bouncing_;          // bodies with at least one contact that is not sharp
  std::vector<std::uint32_t> changed_, rigids_;  // that bounce, ascending
  std::vector<float> share_;                     // of each of changed_: of the substep until it touches
  std::vector<Part> parts_;                      // likewise
  std::vector<Whole> wholes_;                    // of changed_, then of rigids_
  std::vector<Bounce> bounces_;
  DisjointSets together_;    // of wholes_: those that hit each other, directly or through others
  std::vector<Gain> gains_;  // of each set, by its lowest member
};

}  // namespace softcell::ppu
