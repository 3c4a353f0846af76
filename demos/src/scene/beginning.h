#pragma once
// A moment of a run, from which a scene may begin in place of its bodies' rest: what a saved scene holds beside its parameters.

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
  /// In two dimensions an angle, counter-clockwise; in three of unit length.
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
    std::vector<Vector> rest;  ///< their positions in the body's own rest shape; empty: it has the model's
  };
  struct RigidBody {
    std::uint32_t body = 0;  ///< its number in the world, those that do not move included
    Vector position = Vector::Zero();
    Rotation rotation = upright();
    Vector velocity = Vector::Zero();
    AxialVector angular_velocity = at_rest();
  };

  /// Where a hand has left a soft body.
  struct Pin {
    std::uint32_t body = 0;  ///< its number in the scene
    Vector point = Vector::Zero();
    float radius = 0;                      ///< metres around the point, that the hand held
    std::vector<std::uint32_t> particles;  ///< which stay where they are, ascending
  };

  std::optional<Vector> gravity;  ///< m/s^2; none: the scene's
  std::optional<Vector> tilt;  ///< in 3D, of the ground, as Action::kTilt has it; none: as the scene has it
  float time_scale = 1;        ///< as Action::kTimeScale has it
  std::int64_t frames = 0;     ///< that have passed: the script goes on behind them
  double seconds = 0;          ///< that were simulated: the scene's own tilting goes on from there
  std::vector<SoftBody> soft_bodies;             ///< all of the scene's, in order
  std::vector<RigidBody> rigid_bodies;           ///< all that move, ascending
  std::vector<std::uint32_t> ended_attachments;  ///< numbers of those that have broken, ascending
  std::vector<Pin> pins;                         ///< at most kMostPins, the oldest first
};

}  // namespace softcell::demos
