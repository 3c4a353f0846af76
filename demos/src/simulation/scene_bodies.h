#pragma once
// Tells which soft bodies of a world are a scene's bodies, and which are pieces of them, in either dimension.

#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "changed_material.h"
#include "input/input_event.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// The number of a soft body in its world. @pre it is in that world
template <int Dimension, class Bodies>
std::size_t number_in(const Bodies& bodies, const ppu::SoftBody<Dimension>& soft) {
  std::size_t body = 0;
  while (&bodies[body] != &soft) ++body;
  return body;
}

/// The soft bodies of a world come in this order: the scene's bodies, then the pieces that have broken from them. One thread uses it.
/// @tparam Dimension  2 or 3. `SoftBodies` is BulletSoftBodies or Box2dSoftBodies, always the same one.
template <int Dimension>
class SceneBodies {
 public:
  using Model = std::shared_ptr<const ppu::SoftBodyModel<Dimension>>;

  SceneBodies() = default;
  /// @param whole  models of the scene's bodies before they break
  explicit SceneBodies(std::vector<Model> whole) : whole_(std::move(whole)) { forget_pieces(); }

  /// The number of the scene's bodies.
  std::size_t size() const { return whole_.size(); }
  const std::vector<Model>& whole() const { return whole_; }

  /// For each body of the world the number of the scene's body that it is, or is a piece of.
  const std::vector<std::size_t>& sources() const { return sources_; }
  /// @pre body < sources().size()
  std::size_t source(std::size_t body) const {
    SC_ASSERT(body < sources_.size(), "body {} of {}", body, sources_.size());
    return sources_[body];
  }

  /// Call it after bodies have broken. @param broken  what the world's poll_broken() has returned since the last call
  template <class SoftBodies>
  void add_pieces(const SoftBodies& bodies, std::span<const ppu::BrokenBody<Dimension>> broken) {
    for (const ppu::BrokenBody<Dimension>& one : broken)
      sources_.insert(sources_.end(), one.pieces.size(), source(number_in(bodies, *one.body)));
    SC_ASSERT(sources_.size() == bodies.size(), "the sources of {} soft bodies of {}", sources_.size(),
              bodies.size());
  }
  /// Call it when the world has been replaced by one in which no body has broken.
  void forget_pieces() {
    sources_.resize(whole_.size());
    std::iota(sources_.begin(), sources_.end(), std::size_t{0});
  }

  /// The scene's first body that has broken, or has begun to break.
  template <class SoftBodies>
  std::optional<std::size_t> first_broken(const SoftBodies& bodies) const {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].shared_model() != whole_[source(b)] || bodies.is_breaking(bodies[b])) return source(b);
    return std::nullopt;
  }

  /// Sets the material of a body and of all of its pieces, each once. For kEveryBody, call it with each body of the world.
  /// @param body  of the scene; for kEveryBody, of the world  @param step  seconds per substep
  template <class SoftBodies>
  void set_material(SoftBodies& bodies, const InputEvent<Dimension>& event, std::size_t body,
                    float step) const {
    if (event.body != kEveryBody && body >= size()) return;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (event.body == kEveryBody ? b == body : source(b) == body)
        bodies[b].set_material(changed_material(bodies[b], event, step));
  }

  /// Makes a body whole again: removes its pieces.
  /// @param let_go   called with the number of each body that is removed, is replaced, or gets another number, before that
  /// @param removed  called with the number of each removed body, after that
  template <class SoftBodies, class LetGo, class Removed>
  void make_whole(SoftBodies& bodies, std::size_t body, const LetGo& let_go, const Removed& removed) {
    SC_ASSERT(body < size(), "body {} of {} is made whole", body, size());
    for (std::size_t b = bodies.size(); b-- > size();) {
      if (sources_[b] != body) continue;
      let_go(b);
      for (std::size_t after = b + 1; after < bodies.size(); ++after)
        let_go(after);  // because their numbers change
      bodies.remove(bodies[b]);
      sources_.erase(sources_.begin() + static_cast<std::ptrdiff_t>(b));
      removed(b);
    }
    if (bodies[body].shared_model() == whole_[body]) return;
    let_go(body);
    bodies[body] = ppu::SoftBody<Dimension>(whole_[body]);
  }

 private:
  std::vector<Model> whole_;
  std::vector<std::size_t> sources_;
};

}  // namespace softcell::demos
