#pragma once
// Bodies of one world that break, and stay whole until another thread has made their pieces.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// How many substeps pass from a break to its pieces, which are made in the meantime by another thread. A number that depends on the body
/// alone: with as many results are the same, however fast that thread is. One core makes the pieces of 1,000 particles in some 8 ms.
inline int substeps_until_pieces(std::size_t particles) {
  constexpr std::size_t kAtOnce = 100;  // takes less than handing over
  return particles <= kAtOnce ? 0 : 2 + static_cast<int>(particles / 1000);
}

/// What was removed is not named any more.
template <int kDimension>
void forget_removed(const SoftBody<kDimension>& body, std::vector<BrokenBody<kDimension>>& broken) {
  std::erase_if(broken, [&](const BrokenBody<kDimension>& one) { return one.body == &body; });
  for (BrokenBody<kDimension>& one : broken) {
    const auto found = std::find(one.pieces.begin(), one.pieces.end(), &body);
    if (found == one.pieces.end()) continue;
    one.particles_before.erase(one.particles_before.begin() + 1 + (found - one.pieces.begin()));
    one.pieces.erase(found);
  }
}

/// In the order in which they began.
/// @tparam Coupled  has soft()   @tparam Pieces  what is made
template <int kDimension, class Coupled, class Pieces>
class Breaks {
 public:
  struct Break {
    Coupled* body = nullptr;
    std::shared_ptr<const SoftBodyModel<kDimension>> model;
    std::uint32_t resets = 0;  ///< SoftBody::resets() when it began
    std::size_t faces = 0;
    int substeps = 0;  ///< until it has pieces
    std::future<Pieces> pieces;

    /// The body was assigned, teleported or straightened since: it is not the one that was strained.
    bool is_void() const { return body->soft().shared_model() != model || body->soft().resets() != resets; }
  };

  bool has(const Coupled& body) const {
    return std::any_of(breaks_.begin(), breaks_.end(), [&](const Break& one) { return one.body == &body; });
  }
  /// @param faces  that break   @param substeps  until it has pieces
  void begin(Coupled& body, std::size_t faces, int substeps, std::future<Pieces> pieces) {
    breaks_.push_back(
        {&body, body.soft().shared_model(), body.soft().resets(), faces, substeps, std::move(pieces)});
  }
  /// After a substep. @return those whose bodies have pieces now; those that are void are gone
  std::vector<Break> take_due() {
    std::vector<Break> due;
    for (Break& one : breaks_)
      if (one.substeps-- <= 0 && !one.is_void()) due.push_back(std::move(one));
    std::erase_if(breaks_, [](const Break& one) { return one.substeps < 0 || one.is_void(); });
    return due;
  }
  /// @return the break of a body, if it is breaking and the break is not void. It is not breaking any more
  std::optional<Break> take(const Coupled& body) {
    const auto found =
        std::find_if(breaks_.begin(), breaks_.end(), [&](const Break& one) { return one.body == &body; });
    if (found == breaks_.end()) return std::nullopt;
    Break one = std::move(*found);
    breaks_.erase(found);
    if (one.is_void()) return std::nullopt;
    return one;
  }
  void forget(const Coupled& body) {
    std::erase_if(breaks_, [&](const Break& one) { return one.body == &body; });
  }

 private:
  std::vector<Break> breaks_;
};

}  // namespace softcell::ppu
