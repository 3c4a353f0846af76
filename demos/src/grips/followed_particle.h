#pragma once
// Finds out where a particle is after its body has broken.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/fracture.h"

namespace softcell::demos {

/// If a crack turns one particle into several, follows the one in the first piece that has it: the largest piece, if that one does.
template <int Dimension>
struct FollowedParticle {
  ppu::SoftBody<Dimension>* body = nullptr;  ///< null: the piece that had the particle has vanished
  std::uint32_t number = 0;

  /// @param broken  in the order in which the bodies broke
  /// @return whether the particle has another number, is in another body, or has vanished
  bool follow(std::span<const ppu::BrokenBody<Dimension>> broken) {
    bool changed = false;
    for (const ppu::BrokenBody<Dimension>& one : broken)
      if (body != nullptr && one.body == body) go_on(one), changed = true;
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
    SC_ASSERT(broken.vanished > 0, "particle {} is in none of {} pieces", number,
              broken.particles_before.size());
    body = nullptr;
  }
};

}  // namespace softcell::demos
