#pragma once
// A scene as plain data: what is in the world, how it looks, and what happens. The demo, its tests and the benchmarks use it. Metres,
// kilograms, seconds; y is up.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "attachment_placement.h"
#include "beginning.h"
#include "breaking.h"
#include "rigid_body.h"
#include "scripted_input.h"
#include "softcell/render/camera.h"
#include "softcell/render/frame.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/mesh.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

struct SoftBodyPlacement {
  std::string name;
  std::string described;  ///< where it is written, for messages: "arena.toml:12:1: soft body 3"
  ppu::TriangleMesh mesh;
  ppu::SoftBodySettings settings;
  Eigen::Vector3f position{0, 0, 0};  ///< of the mesh's own origin
  /// rad/s: the two ends along x turn about x against each other this fast at the beginning.
  float twist = 0;
  render::Colour colour{0.8f, 0.8f, 0.8f};
  bool own_materials = false;  ///< draw the mesh's own materials, where it has any, instead of `colour`
  std::vector<StrengthSlab<3>> strengths = {};  ///< the weakest slab counts
};

struct RigidBox {
  Eigen::Vector3f size{1, 1, 1};
  float mass = 0;  ///< 0: does not move
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
  render::Colour colour{0.8f, 0.8f, 0.8f};
  float opacity = 1;
  render::Pattern pattern = render::Pattern::kPlain;
  bool wall = false;  ///< a wall of the framework: glass while it stands between the camera and the scene
};

/// A convex shape that does not move.
struct Obstacle {
  ppu::TriangleMesh mesh;
  Eigen::Vector3f position{0, 0, 0};
  render::Colour colour{0.8f, 0.8f, 0.8f};
  bool own_materials = false;  ///< as for a soft body
};

/// The ground tilts about the x and z axes: angle(t) = amplitude sin(2 pi t / period), with the tilt growing over the first seconds. The
/// world stays in the ground's frame, in which the direction of gravity turns; the camera turns with it.
struct TiltScript {
  float amplitude_x = 0, amplitude_z = 0;  ///< radians
  float period_x = 1, period_z = 1;        ///< seconds
  float begin = 0;                         ///< seconds
};

/// Names of ppu::ContactMethod in scene files, on the command line and in statistics, in the enum's order.
inline constexpr std::array<std::string_view, 2> kContactMethods{"spheres", "surface"};

struct SceneDocument;  // of the room scene_file

struct Scene {
  std::string name, title;
  std::vector<SoftBodyPlacement> soft_bodies;
  std::vector<RigidBox> boxes;  ///< the framework's floor and walls first
  std::vector<Obstacle> obstacles;
  std::vector<RigidBody> rigid_bodies;
  std::vector<Joint> joints;
  std::vector<AttachmentPlacement<3>> attachments;
  TiltScript tilt;
  float gravity = 9.81f;  ///< m/s^2
  float friction = 0.6f;
  float restitution = 0;                                       ///< 0..1, of rigid bodies
  int substeps = 2;                                            ///< of a frame of 1/60 s
  ppu::ContactMethod contacts = ppu::ContactMethod::kSurface;  ///< the user may choose another
  bool sleep = false;  ///< soft bodies that have come to rest fall asleep
  int frames = 300;    ///< how long the scene is worth watching without a user
  render::Camera camera;
  render::Light light;
  ScriptedInput<3> script;
  std::vector<ScriptedCut<3>> cuts;
  std::vector<int> pictures;                 ///< frames worth a picture, ascending
  std::vector<std::filesystem::path> files;  ///< that it was read from: nothing may be written there
  std::vector<std::string> notes;  ///< for the user, a sentence each: parts of meshes that were not read
  std::shared_ptr<const Beginning<3>> begin;      ///< null: bodies begin at rest in their own shape
  std::shared_ptr<const SceneDocument> document;  ///< that it was read from, for saving; null: none
};

}  // namespace softcell::demos
