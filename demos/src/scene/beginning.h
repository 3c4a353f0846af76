#pragma once
// A moment of a run from which a scene may begin, in place of bodies at rest: the part of a saved scene beside its parameters.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

namespace softcell::demos {

inline constexpr std::size_t kMostPins = 100;

/// Dimension: 2 or 3. Metres, seconds, radians.
template <int Dimension>
struct Beginning {
  using Vector = Eigen::Matrix<float, Dimension, 1>;
  /// In two dimensions an angle, counter-clockwise; in three dimensions a quaternion of unit length.
  using Rotation = std::conditional_t<Dimension == 3, Eigen::Quaternionf, float>;
  using AxialVector = std::conditional_t<Dimension == 3, Eigen::Vector3f, float>;

  static Rotation upright() {
    if constexpr (Dimension == 3)
      return Rotation::Identity();
    else
      return 0;
  }
  static AxialVector at_rest() {
    if constexpr (Dimension == 3)
      return AxialVector::Zero();
    else
      return 0;
  }

  struct SoftBody {
    std::vector<Vector> positions, velocities;  ///< of its particles, in the lattice's order
    std::vector<Vector> rest;  ///< particle positions in its own rest shape; empty: the model's
  };
  struct RigidBody {
    std::uint32_t body = 0;  ///< its number in the world, counting those that do not move
    Vector position = Vector::Zero();
    Rotation rotation = upright();
    Vector velocity = Vector::Zero();
    AxialVector angular_velocity = at_rest();
  };

  /// A part of a soft body that a hand has pinned.
  struct Pin {
    std::uint32_t body = 0;  ///< its number in the scene
    Vector point = Vector::Zero();
    float radius = 0;                      ///< metres around the point: the part that the hand held
    std::vector<std::uint32_t> particles;  ///< the particles that stay where they are, ascending
  };

  std::optional<Vector> gravity;        ///< m/s^2; none: the scene's
  std::optional<Vector> tilt;           ///< in 3D, of the ground, as for Action::kTilt; none: the scene's own
  float time_scale = 1;                 ///< as for Action::kTimeScale
  std::int64_t frames = 0;              ///< frames that have passed: the script goes on after them
  double seconds = 0;                   ///< simulated seconds: the scene's own tilting goes on from there
  std::vector<SoftBody> soft_bodies;    ///< all of the scene's soft bodies, in order
  std::vector<RigidBody> rigid_bodies;  ///< all that move, in ascending order
  std::vector<std::uint32_t> ended_attachments;  ///< numbers of those that have broken, in ascending order
  std::vector<Pin> pins;                         ///< at most kMostPins, the oldest first
};

}  // namespace softcell::demos
