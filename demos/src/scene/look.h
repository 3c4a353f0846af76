#pragma once
// What a picture shows of a scene, and from where; none of it affects the simulation.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

namespace softcell::demos {

/// What is drawn in three dimensions.
enum class View : std::uint8_t {
  kMesh,       ///< the skinned meshes
  kLattice,    ///< particles and the edges of cells
  kRotations,  ///< how shape matching has turned the region of each particle: axes, x red, y green, z blue
  kContacts,   ///< where bodies press on each other, and in which direction
};

inline constexpr int kViews = 4;

/// What is drawn of soft bodies in two dimensions.
enum class View2d : std::uint8_t {
  kDots,     ///< particles, the outer ones with the radius of their contacts
  kLattice,  ///< particles and the edges of cells
  kFilled,   ///< the cells as one shape
};

inline constexpr int kViews2d = 3;

/// The hand of a controller in the window.
struct PointingHand {
  Eigen::Vector2f at{0.5f, 0.5f};  ///< fractions of the window, from its upper left corner
  bool holds = false;
};

/// How a window shows a scene.
struct Look {
  int view = 0;                                        ///< View2d or View, as a number
  bool statistics = true, help = false, menu = false;  ///< pages over the picture
  // The camera in three dimensions, relative to the scene's own:
  float turn = 0, rise = 0;           ///< radians about its target, counter-clockwise from above and upwards
  float distance = 1;                 ///< from its target, as a factor
  Eigen::Vector3f moved{0, 0, 0};     ///< metres: the user has moved it with its target
  Eigen::Vector3f followed{0, 0, 0};  ///< likewise, because it follows a body
  bool looks_around = false;          ///< it may also look upwards
  bool follows = false;               ///< it follows a body
  bool knife = false;                 ///< the left mouse button cuts
  std::optional<Eigen::Vector3f> marked = {};  ///< metres: the contact whose values the menu shows
  /// Where the knife began and where it is now, in fractions of the window from its upper left corner. None: it is not cutting.
  std::optional<std::array<Eigen::Vector2f, 2>> stroke = {};
  /// The controller's left and right hand. None: the trigger of that hand is not touched.
  std::array<std::optional<PointingHand>, 2> hands = {};

  /// The same look with the scene's own camera.
  Look with_scenes_camera() const {
    return {.view = view, .statistics = statistics, .help = help, .menu = menu, .knife = knife};
  }
};

}  // namespace softcell::demos
