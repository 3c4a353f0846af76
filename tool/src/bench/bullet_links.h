#pragma once
// Bullet's soft bodies on lattices. Include it after softcell's headers: btSoftBody.h has a global variable named `seed`.

#include <BulletSoftBody/btSoftBody.h>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::tool {

/// Appends links along the edges and across the faces of cells. @pre the body's nodes are the lattice's particles
inline void append_links(const ppu::Lattice<3>& lattice, btSoftBody& body) {
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    for (const std::uint32_t other : lattice.neighbours[i]) {
      SC_ASSERT(other < lattice.particles.size(), "particle {} has neighbour {} of {}", i, other,
                lattice.particles.size());
      const int apart = (lattice.particles[i] - lattice.particles[other]).squaredNorm();
      if (other > i && apart <= 2) body.appendLink(static_cast<int>(i), static_cast<int>(other));
    }
  }
}

}  // namespace softcell::tool
