#pragma once
// Keeps track of a world's bodies that break. Each stays whole until another thread has made its pieces.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// How many substeps pass from a break until its pieces appear; another thread makes them meanwhile. The number depends on the body alone,
/// so results do not depend on how fast that thread is. One core makes the pieces of 1,000 particles in some 8 ms.
inline int substeps_until_pieces(std::size_t particles) {
  constexpr std::size_t kAtOnce = 100;  // takes less time than handing over
  return particles <= kAtOnce ? 0 : 2 + static_cast<int>(particles / 1000);
}

/// Whether the test for breaks is put off to the next substep, when the solver has ended its part: by then an SPE may have found that the
/// body has not broken. Not for bodies whose pieces appear at once, nor for those whose rest shape may flow in that part.
template <int kDimension>
bool is_tested_late(const SoftBody<kDimension>& body) {
  return substeps_until_pieces(body.positions().size()) > 0 && !body.settings().plasticity &&
         !body.has_own_rest();
}

/// Removes a body that no longer exists from reports of broken bodies.
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

/// The breaks, in the order in which they began.
/// @tparam Coupled  has soft() and can_break()   @tparam Pieces  what the other thread makes
template <int kDimension, class Coupled, class Pieces>
class Breaks {
 public:
  /// A body after a substep that may have broken it.
  struct Strained {
    explicit Strained(Coupled& coupled)
        : body(&coupled), model(coupled.soft().shared_model()), resets(coupled.soft().resets()) {}

    Coupled* body;
    std::shared_ptr<const SoftBodyModel<kDimension>> model;
    std::uint32_t resets;  ///< SoftBody::resets()

    /// Whether the body was assigned, teleported or straightened since: then it is not the strained one any more.
    bool is_void() const { return body->soft().shared_model() != model || body->soft().resets() != resets; }
  };
  struct Break : Strained {
    std::size_t faces = 0;
    int substeps = 0;  ///< until the pieces appear
    std::future<Pieces> pieces;
  };

  /// Call it after a substep: tests the bodies that may break. New pieces are tested from the next substep on; bodies that are already
  /// breaking are not tested.
  /// @param maker  its begin_break(body, faces, substeps) starts making pieces, which appear after that many substeps
  template <class Bodies, class Maker>
  void test(const Bodies& bodies, Maker& maker) {
    for (std::size_t i = 0, count = bodies.size(); i < count; ++i) {  // pieces are appended after them
      Coupled& body = *bodies[i];
      const SoftBody<kDimension>& soft = body.soft();
      if (!soft.settings().fracture || soft.asleep() || !body.can_break() || has(body)) continue;
      if (is_tested_late(soft))
        to_test_.emplace_back(body);
      else
        test(body, substeps_until_pieces(soft.positions().size()), maker);
    }
  }
  /// Call it in the next substep: tests the bodies that wait for it. @param solver  a StepAhead, which has ended its part
  template <class Solver, class Maker>
  void test_late(const Solver& solver, Maker& maker) {
    for (const Strained& one : to_test_)
      if (!one.is_void() && solver.may_break(one.body->soft())) test_late(*one.body, maker);
    to_test_.clear();
  }
  /// Call it between substeps: whether a body is breaking. If its test was put off, it is tested now.
  template <class Maker>
  bool is_breaking(Coupled& body, Maker& maker) {
    const bool waits = std::erase_if(to_test_, [&](const Strained& one) {
                         return one.body == &body && !one.is_void();
                       }) != 0;
    if (waits) test_late(body, maker);
    return has(body);
  }

  bool has(const Coupled& body) const {
    return std::any_of(breaks_.begin(), breaks_.end(), [&](const Break& one) { return one.body == &body; });
  }
  /// @param faces  that break   @param substeps  until the pieces appear
  void begin(Coupled& body, std::size_t faces, int substeps, std::future<Pieces> pieces) {
    breaks_.push_back({Strained(body), faces, substeps, std::move(pieces)});
  }
  /// Call it after a substep. Also removes void breaks. @return the breaks whose pieces appear now
  std::vector<Break> take_due() {
    std::vector<Break> due;
    for (Break& one : breaks_)
      if (one.substeps-- <= 0 && !one.is_void()) due.push_back(std::move(one));
    std::erase_if(breaks_, [](const Break& one) { return one.substeps < 0 || one.is_void(); });
    return due;
  }
  /// Ends the break of a body. @return the break, if the body was breaking and the break is not void
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
    std::erase_if(to_test_, [&](const Strained& one) { return one.body == &body; });
    std::erase_if(breaks_, [&](const Break& one) { return one.body == &body; });
  }

 private:
  template <class Maker>
  void test(Coupled& body, int substeps, Maker& maker) {
    if (const auto faces = strained_faces(body.soft(), break_test_); !faces.empty())
      maker.begin_break(body, faces, substeps);
  }
  /// The substep that has strained the body counts already.
  template <class Maker>
  void test_late(Coupled& body, Maker& maker) {
    if (!body.soft().settings().fracture) return;  // its user has changed the settings
    test(body, substeps_until_pieces(body.soft().positions().size()) - 1, maker);
  }

  BreakTest<kDimension> break_test_;
  std::vector<Strained> to_test_;
  std::vector<Break> breaks_;
};

}  // namespace softcell::ppu
