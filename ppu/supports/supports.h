#pragma once
// Includes the bodies that rigid bodies lie on or hang from while soft bodies press on them.
//
// The rigid bodies' engine solves their contacts, but contacts with soft bodies are solved before. A crate on a floor would give way to a
// heavy soft body as if the floor were not there, and only then be stopped by it: the lighter the crate, the deeper the soft body sinks
// onto it. So in contacts with soft bodies a rigid body moves only as its supports let it: the contacts that the load presses on hold it in
// both directions, and across as long as they do not slide, which sequential impulses tell. In the end the supports' impulses against what
// soft bodies have done are found in the same way, and the engine has nothing left to stop. Joints hold rigid bodies likewise; a part of
// their load is left to the engine.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/numbers/disjoint_sets.h"
#include "ppu/obstacles/contact_rigid.h"
#include "ppu/obstacles/rigid_links.h"
#include "ppu/supports/supported_set.h"

namespace softcell::ppu {

/// Used by one thread; in each substep call hold(), add_impulse(), release(). Allocates when there are more bodies or contacts than ever
/// before.
class Supports {
 public:
  /// Sets ContactRigid::held of bodies that soft ones press on and that lie on something or are joined to it, and their velocities to those
  /// with their supports.
  /// @param rigids  must stay in place until release()  @param step  seconds
  void hold(std::span<ContactRigid> rigids, const RigidLinks& links, std::span<const Press> presses,
            float step);

  bool empty() const { return count_ == 0; }

  /// Adds an impulse of a soft body's contact on a rigid body, kg m/s, at a place in the world. Ignored if the body is in no set.
  /// @param rigid  its index
  void add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point, const Eigen::Vector3f& impulse);

  /// Gives rigid bodies the velocities with which their engine goes on: they include the impulses of soft bodies and of supports. Supports
  /// that can move get the opposite impulses.
  void release();

 private:
  /// Indices of contacts or joints by their rigid bodies.
  struct OfRigid {
    std::vector<std::uint32_t> first, links;
    std::span<const std::uint32_t> of(std::uint32_t rigid) const {
      return std::span(links).subspan(first[rigid], first[rigid + 1] - first[rigid]);
    }
  };
  void find_parts(std::span<const ContactRigid> rigids, const RigidLinks& links);
  void look_at(std::span<ContactRigid> rigids, const RigidLinks& links, std::span<const Press> presses,
               float step);

  DisjointSets together_;               // sets of rigid bodies that hold each other
  std::vector<std::uint32_t> part_of_;  // of each rigid body: the lowest index of the bodies joined to it
  std::vector<std::uint32_t> joined_;   // how many bodies are joined to it
  OfRigid touches_, joints_;
  std::vector<std::uint32_t> pressed_, set_;
  std::vector<SupportedSet> sets_;  // those from count_ on keep their room for later
  std::size_t count_ = 0;
};

}  // namespace softcell::ppu
