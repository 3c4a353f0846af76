#pragma once
// What the couplings to Bullet and Box2D share about attachments: a list of links with numbers, each with its rows (attachment_rows.h).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ppu/contacts/attachment_rows.h"
#include "softcell/base/text.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {

/// Whether the attached bodies also collide with each other.
template <int kDimension>
bool touches(const AttachmentSettings<kDimension>& settings) {
  return settings.touch.value_or(settings.kind == AttachmentKind::kRope);
}

/// The place in the world that holds a patch. @throws std::invalid_argument  a rope has no point
template <int kDimension>
AttachmentFrame<kDimension> frame_in_world(const AttachmentSettings<kDimension>& settings,
                                           const PatchParticles<kDimension>& particles) {
  if (settings.kind == AttachmentKind::kRope && !settings.point)
    throw std::invalid_argument("a rope to the world has no point; it needs the place of its other end");
  AttachmentFrame<kDimension> frame;
  frame.position = frame.end_position = settings.point.value_or(particles.middle());
  return frame;
}

/// @throws std::invalid_argument  an attachment cannot be moved within that many seconds
inline void check_seconds_of_move(float seconds) {
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw std::invalid_argument("an attachment is moved within " + base::shortest(seconds) +
                                " s; it must be 0 or above, and finite");
}

/// A piece of a broken body, and which particle of the whole each of its particles was.
template <class Body>
struct PieceOfBody {
  Body* body = nullptr;
  std::span<const std::uint32_t> particle_of;
};

/// Moves the attachments of a body that has broken into pieces, of which the body itself is one, to the piece that has all particles of
/// their patch, each exactly once. If only a piece that was too small to keep has them, the patch is gone with it.
template <class Body>
class PiecesOfPatches {
 public:
  /// @param vanished  for each piece that was not kept: the particles of the whole that it had, ascending
  PiecesOfPatches(const Body& body, std::span<const PieceOfBody<Body>> pieces,
                  std::span<const std::vector<std::uint32_t>> vanished)
      : body_(body), pieces_(pieces), vanished_(vanished) {
    for (const PieceOfBody<Body>& piece : pieces) {
      std::map<std::uint32_t, std::uint32_t>& numbers = number_of_.emplace_back();
      std::vector<std::uint32_t> twice;
      for (std::uint32_t i = 0; i < piece.particle_of.size(); ++i)
        if (!numbers.try_emplace(piece.particle_of[i], i).second) twice.push_back(piece.particle_of[i]);
      for (const std::uint32_t particle : twice) numbers.erase(particle);
    }
  }

  /// Whether one of the link's patches is gone. Call it before follow(). @tparam Link  as AttachmentLinks
  template <class Link>
  bool is_gone(const Link& link) const {
    return (link.a == &body_ && is_gone(link.rows.particles(false))) ||
           (link.b == &body_ && is_gone(link.rows.particles(true)));
  }
  /// Moves the link to the pieces. @tparam Link  as AttachmentLinks   @return false: no piece has all particles of one of its patches
  template <class Link>
  bool follow(Link& link) const {
    return (link.a != &body_ || follow(link.a, link.rows, false)) &&
           (link.b != &body_ || follow(link.b, link.rows, true));
  }

 private:
  bool is_gone(std::span<const std::uint32_t> patch) const {
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece)
      if (numbers_in(piece, patch)) return false;
    return std::ranges::any_of(vanished_, [&](const std::vector<std::uint32_t>& particle_of) {
      return std::ranges::all_of(
          patch, [&](std::uint32_t particle) { return std::ranges::binary_search(particle_of, particle); });
    });
  }
  template <class Rows>
  bool follow(Body*& side, Rows& rows, bool is_b) const {
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      std::optional<std::vector<std::uint32_t>> numbers = numbers_in(piece, rows.particles(is_b));
      if (!numbers) continue;
      rows.renumber(is_b, std::move(*numbers));
      side = pieces_[piece].body;
      return true;
    }
    return false;
  }
  /// The patch's particle numbers in a piece; none: the piece does not have all of them.
  std::optional<std::vector<std::uint32_t>> numbers_in(std::size_t piece,
                                                       std::span<const std::uint32_t> patch) const {
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t particle : patch) {
      const auto found = number_of_[piece].find(particle);
      if (found == number_of_[piece].end()) return std::nullopt;
      numbers.push_back(found->second);
    }
    return numbers;
  }

  const Body& body_;
  std::span<const PieceOfBody<Body>> pieces_;
  std::span<const std::vector<std::uint32_t>> vanished_;
  std::vector<std::map<std::uint32_t, std::uint32_t>> number_of_;  // of particles that it has once
};

/// All attachments, in the order in which they were made.
/// @tparam Link  has `id`, `rows`, and soft bodies `a` and `b`
template <class Link>
class AttachmentLinks {
 public:
  using Pointers = std::vector<std::unique_ptr<Link>>;

  bool empty() const { return links_.empty(); }
  auto begin() const { return links_.begin(); }
  auto end() const { return links_.end(); }

  /// Appends a link and gives it a number.
  Link& add(Link link) {
    link.id = AttachmentId{next_++};
    return *links_.emplace_back(std::make_unique<Link>(std::move(link)));
  }
  /// Null: there is no link with that number.
  Link* find(AttachmentId id) const {
    const auto found = std::ranges::find_if(links_, [&](const auto& link) { return link->id == id; });
    return found == links_.end() ? nullptr : found->get();
  }
  /// @throws std::invalid_argument  there is no link with that number
  Link& at(AttachmentId id) const {
    if (Link* const link = find(id)) return *link;
    throw std::invalid_argument("there is no attachment " + std::to_string(static_cast<std::uint32_t>(id)));
  }
  /// Removes the links for which `which(link)` is true; calls it once for each. Allocates nothing if there are none. @return the removed
  /// links, in order
  template <class Which>
  Pointers take(const Which& which) {
    Pointers taken;
    std::erase_if(links_, [&](auto& link) {
      if (!which(*link)) return false;
      taken.push_back(std::move(link));
      return true;
    });
    return taken;
  }

 private:
  Pointers links_;
  std::uint32_t next_ = 1;  // 0 names none
};

}  // namespace softcell::ppu
