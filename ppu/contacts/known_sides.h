#pragma once
// The side of rigid triangles on which a body is, and the last place where it was on that side. It keeps its side while it is near them.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ppu/obstacles/triangle_sheets.h"

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
  /// As last_side_of(), but 0 if it has been unclear from the beginning.
  int known_side_of(std::uint32_t rigid, std::uint32_t part) const;

  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// One sheet of a part's triangles near the body.
  struct SheetSeen {
    std::uint32_t sheet;  ///< as `sheets` numbers them
    /// A triangle of it by which it is found again in the next substep, when others may be near.
    std::uint32_t nearest;
    int seen;  ///< as in side_of()
  };
  /// Like side_of(), for one sheet of a part's triangles. If it has been unclear from the beginning, the answer is side_of() of the part.
  /// @param triangles  of the part, near the body   @param sheets  of these
  float side_of_sheet(std::uint32_t rigid, std::uint32_t part, std::span<const Triangle> triangles,
                      const TriangleSheets& sheets, const SheetSeen& sheet);
  /// Whether the body remembers its side of a sheet of this part.
  bool knows_sheets(std::uint32_t rigid, std::uint32_t part) const;

  /// How far a body has come without passing through a triangle, in the frame of these triangles, metres.
  struct Track {
    Eigen::Vector3f safe;    ///< the last place that it reached so
    Eigen::Vector3f middle;  ///< where its middle was then, which may have been pressed through
  };
  std::optional<Track> track(std::uint32_t rigid, std::uint32_t part) const;
  /// Sets track(), for this substep and the next one.
  void set_track(std::uint32_t rigid, std::uint32_t part, const Track& track);

  /// The body is a piece that has just broken off. What the whole knew stays.
  /// @param origin  well inside of the whole, near the piece, metres in the world
  void begin_piece(const Eigen::Vector3f& origin);
  /// The origin that begin_piece() has set, in the piece's first substep.
  const std::optional<Eigen::Vector3f>& origin() const { return origin_; }

 private:
  static constexpr auto of(std::uint32_t rigid, std::uint32_t part) {
    return [=](const auto& known) { return known.rigid == rigid && known.part == part; };
  }
  static constexpr auto of_whole(std::uint32_t rigid, std::uint32_t part) {
    return [=](const Side& known) { return of(rigid, part)(known) && !known.sheet; };
  }
  struct Side {
    std::uint32_t rigid, part;
    bool is_near = true;                 // in this substep
    std::optional<Triangle> sheet = {};  // one of its triangles; none: this is of all triangles of the part
    int side = 0;                        // 0: not known
    int doubts = 0;  // substeps that showed the other side, since one last showed this side

    void look(int seen);
  };
  struct KnownTrack {
    std::uint32_t rigid, part;
    bool is_near;  // in this substep
    Track track;
  };
  std::vector<Side> sides_;
  std::vector<KnownTrack> tracks_;
  std::optional<Eigen::Vector3f> origin_;
  bool is_new_ = false;  // no substep has begun since begin_piece()
};

}  // namespace softcell::ppu
