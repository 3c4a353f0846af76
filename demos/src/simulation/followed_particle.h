#pragma once
// Where a particle is after its body has broken.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/fracture.h"

namespace softcell::demos {

/// A particle that becomes several at a crack is followed to the largest piece that has it.
template <int Dimension>
struct FollowedParticle {
  ppu::SoftBody<Dimension>* body = nullptr;
  std::uint32_t number = 0;

  /// @param broken  in the order in which it happened
  /// @return whether it has another number, or is of another body
  bool follow(std::span<const ppu::BrokenBody<Dimension>> broken) {
    bool changed = false;
    for (const ppu::BrokenBody<Dimension>& one : broken)
      if (one.body == body) go_on(one), changed = true;
    return changed;
  }

 private:
  void go_on(const ppu::BrokenBody<Dimension>& broken) {
    for (std::size_t piece = 0; piece < broken.particles_before.size(); ++piece) {
      const auto& before = broken.particles_before[piece];
      const auto found = std::ranges::find(before, number);
      if (found == before.end()) continue;
      body = piece == 0 ? broken.body : broken.pieces[piece - 1];
      number = static_cast<std::uint32_t>(found - before.begin());
      return;
    }
    SC_ASSERT(false, "particle {} is in none of {} pieces", number, broken.particles_before.size());
  }
};

}  // namespace softcell::demos
