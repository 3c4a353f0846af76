#pragma once
// One number for the state of all soft bodies: equal numbers, equal bytes.

#include <cstdint>
#include <span>

#include "softcell/ppu/soft_body.h"

namespace softcell::ppu {

/// Hash over positions and velocities of the particles of several bodies, fed body by body. The order counts.
class StateHash {
 public:
  StateHash();
  ~StateHash();
  StateHash(const StateHash&) = delete;
  StateHash& operator=(const StateHash&) = delete;

  void add(const SoftBody& body);
  std::uint64_t value() const;  ///< XXH3, 64 bits; of everything added so far

 private:
  struct State;
  State* state_;
};

/// @source  XXH3, the 64-bit variant with seed 0.
std::uint64_t state_hash(std::span<const SoftBody* const> bodies);

}  // namespace softcell::ppu
