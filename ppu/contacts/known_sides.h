#pragma once
// On which side of rigid triangles a body is, and where it was last on that side: it stays there while it is near them.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace softcell::ppu {

/// What one body remembers from substep to substep. A piece of a broken body takes over a copy.
class KnownSides {
 public:
  /// Forgets the walls that the body was not near in the last substep.
  void begin_substep();

  /// 1: the body is in front of the triangles of a rigid body's part; -1: behind them. The answer stays the same as long as the body is near
  /// them, unless it looks like the other side in many substeps one after the other: pressed flat, a body may look so for some.
  /// @param rigid  ContactRigid::number   @param part  Obstacle::part
  /// @param seen  above 0: it looks like the front now; below 0: like the back; 0: unclear
  float side_of(std::uint32_t rigid, std::uint32_t part, int seen);
  /// The last answer of side_of(), or 1.
  float last_side_of(std::uint32_t rigid, std::uint32_t part) const;

  /// A place well inside of the body, in a rigid body's frame: the last one that it reached without passing through one of the triangles there.
  std::optional<Eigen::Vector3f> last_place(std::uint32_t rigid, std::uint32_t part) const;
  /// The place is last_place() from now on, in this substep and the next one.
  void set_place(std::uint32_t rigid, std::uint32_t part, const Eigen::Vector3f& place);

  /// Where a piece that has just broken off comes from, metres in the world.
  struct Origin {
    Eigen::Vector3f near;    ///< well inside of the whole, near the piece
    Eigen::Vector3f middle;  ///< of the whole, for a piece from where the whole was pressed flat
  };
  void begin_piece(const Origin& origin);
  /// In the first substep of a piece.
  const std::optional<Origin>& origin() const { return origin_; }

 private:
  static constexpr auto of(std::uint32_t rigid, std::uint32_t part) {
    return [=](const auto& known) { return known.rigid == rigid && known.part == part; };
  }
  struct Side {
    std::uint32_t rigid, part;
    bool is_near;  // in this substep
    int side;      // 0: not known
    int doubts;    // substeps one after the other in which it looked like the other side
  };
  struct Place {
    std::uint32_t rigid, part;
    bool is_near;  // in this substep
    Eigen::Vector3f place;
  };
  std::vector<Side> sides_;
  std::vector<Place> places_;
  std::optional<Origin> origin_;
  bool is_new_ = false;  // no substep has begun since begin_piece()
};

}  // namespace softcell::ppu
