#pragma once
// Pieces of a broken body that are still in each other: particles at a crack become several at one place, whose circles cover each other.
// They would be pushed apart by a cell at once, in any direction. So two of them touch only after they have been apart.

#include <box2d/b2_body.h>

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "ppu/box2d/box2d_body.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class PartingPieces {
 public:
  /// Bodies that have come from one, before the next step: pairs of their particles that cover each other do not touch.
  void add(std::span<Box2dBody* const> pieces);
  bool empty() const { return pairs_.empty(); }
  /// Whether two may touch.
  bool lets(const b2Body& a, const b2Body& b) const;

  /// A particle of another body that does not touch a particle of one.
  struct Kept {
    Box2dBody* other;
    std::uint32_t number_of_other, number;  ///< of particles in the other body and in the one
  };
  /// The body gets other particles, or goes. @return what it did not touch, in the order in which that began
  std::vector<Kept> take(const Box2dBody& body);
  /// What a body did not touch before it broke, its piece does not touch either. @param particle_of  of each particle of the piece
  void keep(std::span<const Kept> kept, Box2dBody& piece, std::span<const std::uint32_t> particle_of);

  /// After a step: those that are apart touch from now on.
  void update();

 private:
  struct Side {
    Box2dBody* body;
    std::uint32_t number;  // of the particle in the body
    b2Body& particle() const { return *body->particle(number); }
    float radius() const { return body->soft().model().contact_radius(number); }
  };
  struct Pair {
    Side a, b;
    bool is_apart() const;
  };
  using Key = std::pair<const b2Body*, const b2Body*>;
  static Key key_of(const b2Body& a, const b2Body& b) {
    return std::less<>()(&a, &b) ? Key(&a, &b) : Key(&b, &a);
  }
  void add(const Pair& pair);

  std::vector<Pair> pairs_;  // in the order in which they began, which reaches the order of Box2D's contacts
  std::set<Key> keys_;       // of `pairs_`
};

}  // namespace softcell::ppu
