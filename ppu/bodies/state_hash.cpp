#include "softcell/soft_bodies/state_hash.h"

#include <xxhash.h>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

template <class Position, class Velocity>
std::uint64_t hash_of(std::span<const Position> positions, std::span<const Velocity> velocities,
                      std::uint64_t before) {
  const auto x = std::as_bytes(positions);
  const auto v = std::as_bytes(velocities);
  const std::uint64_t after_x = XXH3_64bits_withSeed(x.data(), x.size(), before);
  return XXH3_64bits_withSeed(v.data(), v.size(), after_x);
}

/// Adds the rest shape of bodies that have yielded; all others keep the hash of an elastic body.
template <int kDimension>
std::uint64_t with_rest_shape(const SoftBody<kDimension>& body, std::uint64_t hash) {
  if (!body.has_own_rest()) return hash;
  const auto rest = body.rest_positions();
  return XXH3_64bits_withSeed(rest.data(), rest.size() * sizeof(rest[0]), hash);
}

}  // namespace

// Vectors have no padding, or a fourth float that is always 0.
std::uint64_t state_hash(const SoftBody<3>& body, std::uint64_t before) {
  return with_rest_shape(body, hash_of(body.padded_positions(), body.velocities(), before));
}
std::uint64_t state_hash(const SoftBody<2>& body, std::uint64_t before) {
  return with_rest_shape(body, hash_of(body.positions(), body.velocities(), before));
}

std::uint64_t state_hash(std::span<const SoftBody<3>* const> bodies) {
  std::uint64_t hash = 0;
  for (const SoftBody<3>* body : bodies) {
    SC_ASSERT(body != nullptr, "one of {} bodies is null", bodies.size());
    hash = state_hash(*body, hash);
  }
  return hash;
}

}  // namespace softcell::ppu
