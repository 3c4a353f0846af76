#pragma once
// What rigid bodies lie on or hang from while soft ones press on them.
//
// Their engine solves that, and contacts with soft bodies are solved before. A crate on a floor would get out of the way of a heavy body as if
// the floor were not there, and only then be stopped by it: the lighter it is, the deeper the body sinks onto it. So for contacts with soft
// bodies a rigid one moves as what it lies on lets it: the touches that the press loads hold it, in both directions, and across as long as they
// do not slide, as sequential impulses tell. In the end their impulses on what soft bodies have done are found by the same, and the engine
// has nothing left to stop. Joints hold it likewise; of those the engine is left a part.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/supported_set.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/surfaces/contact_rigid.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// Used by one thread, in each substep in the order hold(), add_impulse(), release(). Allocates when there are more bodies or touches than
/// ever before.
class Supports {
 public:
  /// Sets ContactRigid::held of those that are pressed on and lie on something or are joined to it, and their velocities to what that leaves of
  /// them.
  /// @param rigids  stay where they are until release()  @param step  seconds
  void hold(std::span<ContactRigid> rigids, const RigidLinks& links, std::span<const Press> presses,
            float step);

  bool empty() const { return count_ == 0; }

  /// What a contact has given to a rigid body, kg m/s, at a place in the world. Of one that is in no set without effect.
  /// @param rigid  its index
  void add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point, const Eigen::Vector3f& impulse);

  /// Gives rigid bodies the velocities with which their engine is to go on: by the impulses of soft bodies, and of what they lie on. What moves
  /// of the latter gets those as well.
  void release();

 private:
  /// Indices of touches or joints by their rigid bodies.
  struct OfRigid {
    std::vector<std::uint32_t> first, links;
    std::span<const std::uint32_t> of(std::uint32_t rigid) const {
      return std::span(links).subspan(first[rigid], first[rigid + 1] - first[rigid]);
    }
  };
  void find_parts(std::span<const ContactRigid> rigids, const RigidLinks& links);
  void look_at(std::span<ContactRigid> rigids, const RigidLinks& links, std::span<const Press> presses,
               float step);

  DisjointSets together_;               // rigid bodies that hold each other
  std::vector<std::uint32_t> part_of_;  // of each rigid body: the lowest of those that are joined to it
  std::vector<std::uint32_t> joined_;   // how many these are
  OfRigid touches_, joints_;
  std::vector<std::uint32_t> pressed_, set_;
  std::vector<SupportedSet> sets_;  // and behind count_ those that keep room for others
  std::size_t count_ = 0;
};

}  // namespace softcell::ppu
