#include "ppu/box2d/parting_pieces.h"

#include <box2d/b2_fixture.h>

#include <algorithm>
#include <cstddef>

#include "softcell/base/assert.h"

namespace softcell::ppu {

bool PartingPieces::Pair::is_apart() const {
  const float distance = a.radius() + b.radius();
  return !((b.particle().GetPosition() - a.particle().GetPosition()).LengthSquared() < distance * distance);
}

void PartingPieces::add(const Pair& pair) {
  if (keys_.insert(key_of(pair.a.particle(), pair.b.particle())).second) pairs_.push_back(pair);
}

/// Sorts circles along x, so that pairs farther apart than the widest one reaches are skipped.
void PartingPieces::add(std::span<Box2dBody* const> pieces) {
  std::vector<Side> circles;
  float widest = 0;
  for (Box2dBody* const body : pieces)
    for (const std::uint32_t number : body->soft().model().outer()) {
      circles.push_back({body, number});
      widest = std::max(widest, circles.back().radius());
    }
  const auto place = [](const Side& circle) { return circle.particle().GetPosition().x; };
  std::stable_sort(circles.begin(), circles.end(),
                   [&](const Side& a, const Side& b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < circles.size(); ++i)
    for (std::size_t j = i + 1; j < circles.size(); ++j) {
      const Pair pair{circles[i], circles[j]};
      if (!(place(pair.b) - place(pair.a) < pair.a.radius() + widest)) break;
      if (pair.a.body != pair.b.body && !pair.is_apart()) add(pair);
    }
}

bool PartingPieces::may_touch(const b2Body& a, const b2Body& b) const {
  return keys_.empty() || !keys_.contains(key_of(a, b));
}

std::vector<PartingPieces::Kept> PartingPieces::take(const Box2dBody& body) {
  std::vector<Kept> kept;
  std::erase_if(pairs_, [&](const Pair& pair) {
    if (pair.a.body != &body && pair.b.body != &body) return false;
    const Side& own = pair.a.body == &body ? pair.a : pair.b;
    const Side& other = pair.a.body == &body ? pair.b : pair.a;
    kept.push_back({other.body, other.number, own.number});
    keys_.erase(key_of(pair.a.particle(), pair.b.particle()));
    return true;
  });
  return kept;
}

void PartingPieces::keep(std::span<const Kept> kept, Box2dBody& piece,
                         std::span<const std::uint32_t> particle_of) {
  if (kept.empty()) return;
  for (std::uint32_t i = 0; i < particle_of.size(); ++i)
    for (const Kept& one : kept)
      if (one.number == particle_of[i] && piece.particle(i) != nullptr)
        add(Pair{{one.other, one.number_of_other}, {&piece, i}});
}

void PartingPieces::update() {
  SC_ASSERT(pairs_.size() == keys_.size(), "{} pairs with {} keys", pairs_.size(), keys_.size());
  std::erase_if(pairs_, [&](const Pair& pair) {
    if (!pair.is_apart()) return false;
    keys_.erase(key_of(pair.a.particle(), pair.b.particle()));
    // Makes Box2D ask again.
    pair.a.particle().GetFixtureList()->Refilter();
    pair.b.particle().GetFixtureList()->Refilter();
    return true;
  });
}

}  // namespace softcell::ppu
