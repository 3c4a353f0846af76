#pragma once
// A scene in two dimensions as plain data: see scene.h. Metres, kilograms, seconds; y is up.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "attachment_placement.h"
#include "beginning.h"
#include "breaking.h"
#include "scripted_input.h"
#include "softcell/render/frame.h"
#include "softcell/render/image.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// Cells of a soft body that have a colour of their own.
struct ColouredCells2d {
  Eigen::Vector2i low{0, 0}, high{0, 0};  ///< grid indices of the first and the last cell, inclusive
  render::Colour colour{0.8f, 0.8f, 0.8f};
};

/// The disc or ring that a soft body's cells approximate, and that is drawn instead of them.
struct Ring2d {
  Eigen::Vector2f middle{0, 0};  ///< grid coordinates
  float radius = 4, hole = 0;    ///< in cells; the hole of a disc is 0

  bool operator==(const Ring2d&) const = default;
};

/// Eyes and a mouth, drawn on a soft body's cells.
struct Face2d {
  Eigen::Vector2f centre{0, 0};  ///< grid coordinates
  float size = 4;                ///< cells
};

/// The picture that a soft body was made from and is drawn with.
struct Picture2d {
  std::shared_ptr<const render::Image> image;
  Eigen::Vector2f low{0, 0};  ///< grid coordinates of its lower left corner
  float cell_pixels = 1;      ///< edge of a cell, in pixels of the picture
};

struct SoftBody2dPlacement {
  std::string name;
  std::string described;               ///< where it is written, for messages: "man.toml:12:1: soft body 3"
  std::vector<Eigen::Vector2i> cells;  ///< grid indices of the lattice's cells, from any origin
  ppu::SoftBodySettings settings;      ///< density is in kg/m^2
  Eigen::Vector2f position{0, 0};      ///< of the centre of the cells' box
  float contact_radius = ppu::SoftBodyModel<2>::kContactRadiusInCells;  ///< cells
  render::Colour colour{0.8f, 0.8f, 0.8f};
  std::vector<ColouredCells2d> coloured_cells = {};  ///< the last one that contains a cell counts
  std::optional<Face2d> face = {};
  std::optional<Ring2d> ring = {};                ///< none: the cells themselves are drawn
  std::shared_ptr<const Picture2d> picture = {};  ///< none: the body is drawn in its colours
  std::vector<StrengthSlab<2>> strengths = {};    ///< the weakest slab counts

  /// The lattice, with the centre of its box at 0. @throws std::runtime_error  as lattice_from_cells().
  ppu::Lattice<2> lattice() const;
  float skin_margin() const;       ///< of make_skin_2d()
  ppu::Outside2d outside() const;  ///< the outline that the cells approximate, if it is not their own
  /// How the body is drawn, and what of it touches others. @param of  the body's lattice, as of lattice()
  ppu::Skin2d skin(const ppu::Lattice<2>& of) const {
    return ppu::make_skin_2d(of, skin_margin(), outside());
  }
};

struct Box2dShape {
  Eigen::Vector2f size{1, 1};  ///< metres
};
struct CircleShape {
  float radius = 0.5f;  ///< metres
};
/// Convex, 3 to 8 corners, counter-clockwise.
struct PolygonShape {
  std::vector<Eigen::Vector2f> corners;  ///< metres, relative to the body's position, which is their centroid
};

struct RigidBody2d {
  std::string name;  ///< "" if it has none, which several may have
  std::variant<Box2dShape, CircleShape, PolygonShape> shape;
  float mass = 0;  ///< kg; 0: does not move
  Eigen::Vector2f position{0, 0};
  float angle = 0;  ///< radians, counter-clockwise
  render::Colour colour{0.8f, 0.8f, 0.8f};
};

struct Camera2d {
  Eigen::Vector2f centre{0, 0};
  float height = 10;  ///< of the visible part of the world, metres

  /// The point of the world, in metres, at (x, y) of a picture, counted from the picture's upper left corner in the units of its size.
  Eigen::Vector2f point_at(int x, int y, int picture_width, int picture_height) const;
};

struct SceneDocument;  // of the room scene_file

struct Scene2d {
  std::string name, title;
  std::vector<SoftBody2dPlacement> soft_bodies;
  std::vector<RigidBody2d> rigid_bodies;  ///< the framework's walls first: left, right, bottom, top
  std::vector<AttachmentPlacement<2>> attachments;
  float gravity = 9.81f;  ///< m/s^2, downwards
  float friction = 0.6f;
  float restitution = 0;  ///< 0..1, of rigid bodies
  int substeps = 2;       ///< of a frame of 1/60 s
  /// The user may choose another; kSpheres: circles.
  ppu::ContactMethod contacts = ppu::ContactMethod::kSurface;
  bool sleep = false;  ///< bodies that have come to rest fall asleep
  int frames = 300;    ///< how long the scene is worth watching without a user
  Camera2d camera;
  ScriptedInput<2> script;
  std::vector<ScriptedCut<2>> cuts;
  std::vector<int> pictures;                      ///< frames worth a picture, ascending
  std::vector<std::filesystem::path> files;       ///< that it was read from: nothing may be written there
  std::shared_ptr<const Beginning<2>> begin;      ///< null: bodies begin at rest in their own shape
  std::shared_ptr<const SceneDocument> document;  ///< that it was read from, for saving; null: none
};

}  // namespace softcell::demos
