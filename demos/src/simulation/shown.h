#pragma once
// A copy of everything that a picture shows of a simulation at one moment, so that one thread can draw it while another simulates the next
// frames.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "ppu/bullet/bullet_world.h"
#include "skin_job.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::demos {

/// The pose of a rigid body in two dimensions.
struct Pose2d {
  Eigen::Vector2f position{0, 0};  ///< of its own origin, metres
  float cosine = 1, sine = 0;      ///< of its angle

  bool operator==(const Pose2d&) const = default;
};

/// A rope that has not broken.
template <int kDimension>
struct ShownRope {
  std::array<Eigen::Vector<float, kDimension>, 2> ends;  ///< metres
  float length = 0;                                      ///< metres: slack while its ends are closer
  float thickness = 0;                                   ///< metres
  Eigen::Vector3f colour{0, 0, 0};                       ///< linear
};

/// Metres.
struct Shown2d {
  std::vector<std::vector<Eigen::Vector2f>> particles;  ///< of each soft body
  /// The model of each soft body; it changes when the body breaks.
  std::vector<std::shared_ptr<const ppu::SoftBodyModel<2>>> models = {};
  std::vector<std::size_t> sources = {};  ///< likewise: Simulation2d::source()
  std::vector<Pose2d> rigid_poses;        ///< of Scene2d::rigid_bodies, in order
  std::vector<ShownRope<2>> ropes = {};
  std::vector<std::array<Eigen::Vector2f, 2>> hands;  ///< the held point, and the hand
};

struct Shown3d {
  struct Body {
    std::shared_ptr<const ppu::SoftBodyModel<3>> model;  ///< replaced when the body breaks
    std::size_t source = 0;                              ///< Simulation3d::source()
    std::vector<spu::SkinnedVertex> vertices;  ///< relative to `origin`; empty when the GPU makes them
    Eigen::Vector3f origin{0, 0, 0};
    std::vector<Eigen::Vector4f> particles;  ///< x y z 0
  };
  std::vector<Body> bodies;
  std::vector<Eigen::Matrix4f> box_poses;  ///< of Scene::boxes, then of Scene::rigid_bodies
  std::vector<ShownRope<3>> ropes;
  std::vector<ppu::Contact> contacts;                  ///< empty unless they are recorded
  std::vector<std::array<Eigen::Vector3f, 2>> hands;   ///< the held point, and the hand
  Eigen::Matrix3f tilt = Eigen::Matrix3f::Identity();  ///< from the ground's frame to the observer's
};

}  // namespace softcell::demos
