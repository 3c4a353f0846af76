#pragma once
// Rigid bodies that the program moves by setting their place, not their velocity: doors, lifts, characters.
//
// Such a body is somewhere else when the next substep begins, and may already be in a soft body. Contacts see it move there, from where it
// was. A program that sets places once a frame of several substeps would throw what it pushes if all of the way lay in the first of them,
// so the way is spread over as many substeps as lay between the last two changes: at the frame's end the body is where the program has put
// it. What goes too far for that has not moved but been put elsewhere.

#include <Eigen/Core>
#include <optional>

namespace softcell::ppu {

/// A place and an orientation.
struct Pose {
  Eigen::Vector3f position{0, 0, 0};  ///< metres
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();

  bool operator==(const Pose& other) const {
    return position == other.position && rotation == other.rotation;
  }
};

/// A motion that lasts a substep.
struct MovedByPlace {
  Pose from;
  Eigen::Vector3f velocity{0, 0, 0};  ///< m/s
  Eigen::Vector3f spin{0, 0, 0};      ///< rad/s
};

/// Follows one body from substep to substep. Used by one thread.
class FollowedPlace {
 public:
  /// @param pose  where the body is; it has not moved yet
  explicit FollowedPlace(const Pose& pose) : seen_(pose), shown_(pose) {}

  /// Whether the body stands still in this substep. Call this first, and follow() if it does not.
  bool stands(const Pose& now) const { return left_ == 0 && now == seen_; }
  /// Counts a substep in which it stands still.
  void stand() { ++since_; }
  /// The world's origin has moved, and with it all that lies in the world: that is no motion. @param by  metres, added to all positions
  void shift(const Eigen::Vector3f& by) { seen_.position += by, shown_.position += by; }
  /// The motion of this substep. None if the body has been put elsewhere: farther than half of what it measures, than 100 m/s take it, or
  /// turned by more than 60 degrees.
  /// @param now   where the program has put it
  /// @param size  of the body along its longest axis, metres
  /// @param step  seconds, of this substep
  std::optional<MovedByPlace> follow(const Pose& now, float size, float step);

 private:
  Pose seen_;      // where the program has put it
  Pose shown_;     // where contacts see it
  int left_ = 0;   // substeps until these two are the same
  int since_ = 0;  // substeps since the program has moved it
  bool has_moved_ = false;
};

}  // namespace softcell::ppu
