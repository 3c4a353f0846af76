#pragma once
// For how long what may touch of two bodies (spu::FindCandidate) stays the same: until something of the one has moved
// against something of the other by more than the margin with which candidates were looked for.
//
// Each step adds to a body's way: the particle in the middle of all displacements moves along a vector, and all others move
// like it but for a length. Vectors are added as vectors, so bodies that fall side by side do not move against each other.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact_find_job.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more bodies or pairs than ever before.
class CandidatePairs {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// What is known of two bodies.
  struct Known {
    Pair pair;
    std::uint32_t slot = 0;  ///< of the pair's candidates, of no other pair
    float margin = 0;  ///< metres: with which they are to be looked for, or have been; 0: none is worth it
    std::uint32_t count = spu::kFindUnknown;  ///< of candidates, if they are known
    Eigen::Vector3d apart{
        0, 0, 0};       ///< by how much the second body has moved against the first, when they were found
    double spread = 0;  ///< and the lengths of both
    bool overflows = false;  ///< the kernel had no room for all that it found, once
  };

  /// There are other bodies than before: nothing is known.
  void clear(std::size_t bodies);

  /// A body's particles have moved by what lies between `low` and `high`, metres, since the step before.
  void add_way(std::uint32_t body, const Eigen::Vector3f& low, const Eigen::Vector3f& high);

  /// A step begins after all ways are known: what is not asked for until end_step() is forgotten.
  void begin_step();
  /// What is known of a pair, or that nothing is. @pre pairs come in ascending order
  /// @param spacing  metres, of the finer one's cells
  /// @return good until the next call of anything; its count may be set until then, or by known() later
  Known& of(const Pair& pair, float spacing);
  void end_step();

  /// The pairs of the last step, in the order in which they were asked for.
  std::span<Known> known() { return known_; }
  std::size_t slots() const { return slots_; }  ///< slots in use are below

 private:
  struct Way {
    Eigen::Vector3d vector{0, 0, 0};
    double length = 0;
    // Of the last step.
    Eigen::Vector3d last{0, 0, 0};
    double last_length = 0;
  };

  std::vector<Way> ways_;
  std::vector<Known> known_, before_;
  std::size_t next_before_ = 0;
  std::vector<std::uint32_t> free_slots_;
  std::size_t slots_ = 0;
};

}  // namespace softcell::ppu
