#include "softcell/soft_bodies/state_hash.h"

#include <xxhash.h>

namespace softcell::ppu {
namespace {

// Vectors have no padding; corners keep a fourth float, always 0.
template <class Body>
std::uint64_t hash_of(const Body& body, std::uint64_t before) {
  const auto x = std::as_bytes(body.positions());
  const auto v = std::as_bytes(body.velocities());
  const std::uint64_t after_x = XXH3_64bits_withSeed(x.data(), x.size(), before);
  return XXH3_64bits_withSeed(v.data(), v.size(), after_x);
}

}  // namespace

std::uint64_t state_hash(const SoftBody& body, std::uint64_t before) { return hash_of(body, before); }
std::uint64_t state_hash(const SoftBody2d& body, std::uint64_t before) { return hash_of(body, before); }

std::uint64_t state_hash(std::span<const SoftBody* const> bodies) {
  std::uint64_t hash = 0;
  for (const SoftBody* body : bodies) hash = state_hash(*body, hash);
  return hash;
}

}  // namespace softcell::ppu
