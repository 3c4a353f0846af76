#pragma once
// How many iterations groups of contacts get in a round, and which of them take turns.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contact_solver/contact_settings.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/contact_rigid.h"

namespace softcell::ppu {

inline int iterations_of(const ContactGroup& group, const ContactSettings& settings) {
  return group.heavy ? settings.heavy_iterations : settings.iterations;
}

/// Calls work(group, iterations). Groups that alternate come after the others.
template <typename Work>
void for_each_turn(std::span<ContactGroup* const> groups, const ContactSettings& settings, const Work& work) {
  int turns = 0;
  for (ContactGroup* const group : groups) {
    const int iterations = iterations_of(*group, settings);
    if (group->alternates)
      turns = std::max(turns, iterations);
    else
      work(*group, iterations);
  }
  for (int i = 0; i < turns; ++i)
    for (ContactGroup* const group : groups)
      if (group->alternates && i < iterations_of(*group, settings)) work(*group, 1);
}

/// Used by one thread; keeps allocated memory.
class GroupTurns {
 public:
  /// Finds out which groups with rigid bodies are ContactGroup::heavy, and which alternate.
  void weigh(std::span<ContactGroup> with_rigid, std::span<const ContactBody> bodies,
             std::span<const ContactRigid> rigids);

 private:
  /// Which groups touch a rigid body that moves.
  struct TouchedRigid {
    static constexpr std::size_t kNobody = ~std::size_t{0};
    std::size_t first = kNobody;  // group
    bool by_several = false;
    float lightest = 0;  // kg, of the soft bodies that touch it
  };
  std::vector<TouchedRigid> touched_rigids_;
};

}  // namespace softcell::ppu
