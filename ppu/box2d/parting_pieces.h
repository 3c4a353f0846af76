#pragma once
// Pieces of a broken body that still overlap: a particle at a crack is split into several at one place, whose circles overlap. A contact
// would push them apart by a cell at once, in any direction. So two such particles touch only after they have been apart.

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
  /// Adds pieces of one body before the next step: pairs of their particles that overlap do not touch.
  void add(std::span<Box2dBody* const> pieces);
  bool empty() const { return pairs_.empty(); }
  /// Whether two particles may touch.
  bool may_touch(const b2Body& a, const b2Body& b) const;

  /// A particle of another body that must not touch a particle of this one.
  struct Kept {
    Box2dBody* other;
    std::uint32_t number_of_other, number;  ///< numbers of the particles in the other body and in this one
  };
  /// Removes the pairs of a body that gets other particles or is removed. @return its pairs, in the order in which they were added
  std::vector<Kept> take(const Box2dBody& body);
  /// Passes the pairs of a body that broke to its piece. @param particle_of  for each particle of the piece: its number in the whole
  void keep(std::span<const Kept> kept, Box2dBody& piece, std::span<const std::uint32_t> particle_of);

  /// Call it after a step: pairs that are apart touch from now on.
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

  std::vector<Pair> pairs_;  // as they were added: this determines the order of Box2D's contacts
  std::set<Key> keys_;       // of `pairs_`
};

}  // namespace softcell::ppu
