#pragma once
// The side of rigid triangles on which a body is, and the last place where it was on that side. It keeps its side while it is near them.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace softcell::ppu {

/// What one body remembers from substep to substep. A piece of a broken body takes over a copy.
class KnownSides {
 public:
  /// Forgets the triangles that the body was not near in the last substep.
  void begin_substep();

  /// 1: the body is in front of the triangles of a rigid body's part; -1: behind them. While the body is near them, the answer changes only
  /// after it has looked like the other side in many substeps: a body that is pressed flat may look so in a few.
  /// @param rigid  ContactRigid::number   @param part  Obstacle::part
  /// @param seen  above 0: it looks like the front now; below 0: like the back; 0: unclear
  float side_of(std::uint32_t rigid, std::uint32_t part, int seen);
  /// The last answer of side_of(), or 1.
  float last_side_of(std::uint32_t rigid, std::uint32_t part) const;

  /// A place well inside the body, in a rigid body's frame: the last one that it reached without passing through a triangle of this part.
  std::optional<Eigen::Vector3f> last_place(std::uint32_t rigid, std::uint32_t part) const;
  /// Makes this place last_place(), in this substep and the next one.
  void set_place(std::uint32_t rigid, std::uint32_t part, const Eigen::Vector3f& place);

  /// Where a new piece comes from, in metres in the world.
  struct Origin {
    Eigen::Vector3f near;    ///< well inside the whole, near the piece
    Eigen::Vector3f middle;  ///< the middle of the whole, for a piece from a part that was pressed flat
  };
  void begin_piece(const Origin& origin);
  /// Has a value in the first substep of a piece.
  const std::optional<Origin>& origin() const { return origin_; }

 private:
  static constexpr auto of(std::uint32_t rigid, std::uint32_t part) {
    return [=](const auto& known) { return known.rigid == rigid && known.part == part; };
  }
  struct Side {
    std::uint32_t rigid, part;
    bool is_near;  // in this substep
    int side;      // 0: not known
    int doubts;    // substeps that showed the other side, since one last showed this side
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
