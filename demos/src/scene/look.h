#pragma once
// What a picture shows of a scene, and from where; none of it reaches the simulation.

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
  kContacts,   ///< where bodies press on each other, and which way
};

inline constexpr int kViews = 4;

/// What is drawn of soft bodies in two dimensions.
enum class View2d : std::uint8_t {
  kDots,     ///< particles, the outer ones as large as they are to others
  kLattice,  ///< particles and the edges of cells
  kFilled,   ///< the cells as one shape
};

inline constexpr int kViews2d = 3;

/// Where a hand of a controller is.
struct PointingHand {
  Eigen::Vector2f at{0.5f, 0.5f};  ///< shares of the window from its upper left corner
  bool holds = false;
};

/// How a window shows a scene.
struct Look {
  int view = 0;                                        ///< View2d or View, as a number
  bool statistics = true, help = false, menu = false;  ///< pages over the picture
  // Of the camera in three dimensions, against the scene's own:
  float turn = 0, rise = 0;  ///< radians about what it looks at, counter-clockwise from above and upwards
  float distance = 1;        ///< from what it looks at, as a factor
  Eigen::Vector3f moved{0, 0, 0};              ///< metres, with what it looks at: by the user
  Eigen::Vector3f followed{0, 0, 0};           ///< likewise, behind a body
  bool looks_around = false;                   ///< it may look upwards, too
  bool follows = false;                        ///< it goes where a body goes
  bool knife = false;                          ///< the left button of the mouse cuts
  std::optional<Eigen::Vector3f> marked = {};  ///< metres: the contact whose values the menu shows
  /// Where the knife began and where it is, as shares of the window from its upper left corner. None: it cuts nothing now.
  std::optional<std::array<Eigen::Vector2f, 2>> stroke = {};
  /// The controller's left and right hand. None: its trigger is not touched.
  std::array<std::optional<PointingHand>, 2> hands = {};

  /// The same with the scene's own camera.
  Look with_scenes_camera() const {
    return {.view = view, .statistics = statistics, .help = help, .menu = menu, .knife = knife};
  }
};

}  // namespace softcell::demos
