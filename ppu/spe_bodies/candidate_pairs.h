#pragma once
// Keeps the candidates for contacts of two bodies (spu::FindCandidate) from step to step. They stay valid until some part of one body has
// moved against some part of the other by more than the margin with which the candidates were found.
//
// Each step adds to a body's way a vector and a length: the vector is the middle of all particles' displacements, and no displacement
// differs from it by more than the length. Vectors are added as vectors, so bodies that fall side by side do not move against each other.

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

  /// What is known of a pair of bodies.
  struct Known {
    Pair pair;
    std::uint32_t slot = 0;  ///< place of the pair's candidates; no other pair has it
    float margin = 0;        ///< metres: to find candidates with, or found with; 0: not worth keeping them
    std::uint32_t count = spu::kFindUnknown;  ///< of candidates, if known
    /// How far the second body had moved against the first when they were found.
    Eigen::Vector3d apart{0, 0, 0};
    double spread = 0;       ///< the sum of both lengths at that time
    bool overflows = false;  ///< the kernel once had no room for all that it found
  };

  /// Forgets everything: the bodies are others than before.
  void clear(std::size_t bodies);

  /// The displacements of a body's particles since the step before lie between `low` and `high`, metres.
  void add_way(std::uint32_t body, const Eigen::Vector3f& low, const Eigen::Vector3f& high);

  /// Begins a step, after all ways have been added. Pairs not asked for until end_step() are forgotten.
  void begin_step();
  /// What is known of a pair, or a new entry. @pre pairs come in ascending order
  /// @param spacing  metres, of the finer body's cells
  /// @return valid until the next call of any function; its count may be set until then, or later through known()
  Known& of(const Pair& pair, float spacing);
  void end_step();

  /// The pairs of the last step, in the order in which they were asked for.
  std::span<Known> known() { return known_; }
  std::size_t slots() const { return slots_; }  ///< all slots in use are below this

 private:
  struct Way {
    Eigen::Vector3d vector{0, 0, 0};
    double length = 0;
    // in the last step
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
