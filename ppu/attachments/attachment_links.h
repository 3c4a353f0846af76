#pragma once
// What the couplings to Bullet and Box2D share about attachments: a list of links with numbers, each with its rows (attachment_rows.h).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ppu/attachments/attachment_rows.h"
#include "ppu/numbers/turned_towards.h"
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

/// The place in the world that holds a link, and the place to which the program moves it.
template <int kDimension>
struct HeldPlace {
  using Vector = Eigen::Vector<float, kDimension>;
  using Turn = std::conditional_t<kDimension == 2, float, Eigen::Quaternionf>;  ///< in two dimensions radians

  AttachmentFrame<kDimension> frame{};
  Vector goal = Vector::Zero();
  Turn turn = no_turn(), goal_turn = no_turn();
  float seconds = 0;   ///< until it arrives
  bool moves = false;  ///< it has not arrived yet
  // Within a step, at its end:
  Turn end_turn = no_turn();
  float end_seconds = 0;

  /// @throws std::invalid_argument  as check_seconds_of_move()
  void move(const Vector& to, const Turn& to_turn, float within) {
    check_seconds_of_move(within);
    goal = to;
    goal_turn = to_turn;
    seconds = within;
    moves = true;
  }
  /// Sets where it is at the end of a step. It moves evenly, and in the last step exactly to the goal.
  void begin(float step) {
    if (!moves) return;
    const bool arrives = !(step < seconds);
    const float share = arrives ? 1.0f : step / seconds;
    frame.end_position = arrives ? goal : Vector(frame.position + share * (goal - frame.position));
    end_turn = turned_towards(turn, goal_turn, share);
    if constexpr (kDimension == 2)
      frame.end_rotation = rotation_matrix(end_turn);
    else
      frame.end_rotation = end_turn.toRotationMatrix();
    end_seconds = seconds - step;
  }
  /// Ends a step that has begun.
  void end() {
    if (!moves) return;
    frame.position = frame.end_position;
    frame.rotation = frame.end_rotation;
    turn = end_turn;
    seconds = end_seconds;
    moves = seconds > 0;
  }

 private:
  static Turn no_turn() {
    if constexpr (kDimension == 2)
      return 0;
    else
      return Turn::Identity();
  }
};

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
/// @tparam Link  has `id`, `rows`, soft bodies `a` and `b`, and `rigid`: what it is attached to, `b` or `rigid`; both null: the world
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
  /// @throws std::invalid_argument  there is no link with that number, or it is not to the world
  Link& to_world(AttachmentId id) const {
    Link& link = at(id);
    if (link.b != nullptr || link.rigid != nullptr)
      throw std::invalid_argument(
          "an attachment to another body cannot be moved; only those to the world can");
    return link;
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

  // The same for links that the program does not end itself, which take_ended() returns. Calls `after(link)` for each.

  /// @return whether there are any
  template <class Which, class After>
  bool end_those(EndedAttachment::Reason reason, const Which& which, const After& after) {
    const Pointers gone = take(which);
    for (const auto& link : gone) {
      ended_.push_back({link->id, reason});
      after(*link);
    }
    return !gone.empty();
  }
  /// Those that broke.
  template <class After>
  bool end_broken(const After& after) {
    return end_those(
        EndedAttachment::Reason::kBroken, [](const Link& link) { return link.rows.broke(); }, after);
  }
  /// Those to a rigid body that has gone, by `is_there(link)`. It does not look at such bodies again.
  template <class IsThere, class After>
  bool end_gone(const IsThere& is_there, const After& after) {
    const auto is_gone = [&](Link& link) {
      if (link.rigid == nullptr || is_there(link)) return false;
      link.rigid = nullptr;
      return true;
    };
    return end_those(EndedAttachment::Reason::kGone, is_gone, after);
  }
  /// Those of a soft body.
  template <class Body, class After>
  bool end_those_of(const Body& body, const After& after) {
    return end_those(
        EndedAttachment::Reason::kGone, [&](const Link& link) { return link.a == &body || link.b == &body; },
        after);
  }
  /// Those of a broken body that no piece takes over; moves the others. The parameters are those of PiecesOfPatches.
  template <class Body, class After>
  void follow_pieces(const Body& body, std::span<const PieceOfBody<Body>> pieces,
                     std::span<const std::vector<std::uint32_t>> vanished, const After& after) {
    if (empty()) return;
    const PiecesOfPatches<Body> of_patches(body, pieces, vanished);
    end_those(
        EndedAttachment::Reason::kGone, [&](const Link& link) { return of_patches.is_gone(link); }, after);
    end_those(
        EndedAttachment::Reason::kBroken, [&](Link& link) { return !of_patches.follow(link); }, after);
  }
  std::vector<EndedAttachment> take_ended() { return std::exchange(ended_, {}); }

 private:
  Pointers links_;
  std::vector<EndedAttachment> ended_;
  std::uint32_t next_ = 1;  // 0 names none
};

}  // namespace softcell::ppu
