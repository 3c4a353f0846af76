#include "read_scene.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ppu/numbers/deterministic_math.h"
#include "read_attachment.h"
#include "read_begin.h"
#include "read_breaking.h"
#include "read_common.h"
#include "read_lattice_2d.h"
#include "read_material.h"
#include "read_rigid_body.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// Smallest length of rigid bodies: Box2D ends the process at a shape with almost no area.
constexpr double kSmallest = 0.01;  // metres
constexpr Range kRigidLength{.low = kSmallest, .high = kFar};
/// The least distance of a corner from the other sides, as a fraction of the polygon's length: in Box2D's floats a thinner polygon loses
/// its corners.
constexpr double kThinnest = 0.001;
constexpr int kMaxCellIndex = 1'000'000;

/// Reads four walls around the middle of the world; width and height are those of the room inside.
void read_framework(const Value& value, Scene2d& scene) {
  Vector2f room{8, 6};
  float thickness = 0.5f;
  render::Colour colour = render::srgb(0x9AA7B5);
  FieldReader(value, "framework")
      .number("width", room.x(), kRigidLength)
      .number("height", room.y(), kRigidLength)
      .number("thickness", thickness, kRigidLength)
      .colour("colour", colour)
      .finish();
  const Vector2f middle = (room + Vector2f(thickness, thickness)) / 2;
  const Vector2f upright{thickness, room.y() + 2 * thickness}, lying{room.x() + 2 * thickness, thickness};
  const auto add = [&](const Vector2f& size, const Vector2f& position) {
    RigidBody2d& wall = scene.rigid_bodies.emplace_back();
    wall.shape = Box2dShape{size};
    wall.position = position;
    wall.colour = colour;
  };
  add(upright, {-middle.x(), 0});
  add(upright, {middle.x(), 0});
  add(lying, {0, -middle.y()});
  add(lying, {0, middle.y()});
}

/// Reads the fields that rigid bodies of all shapes have.
RigidBody2d read_rigid_body(FieldReader& fields, const Scene2d& scene) {
  constexpr Range kAngle{.low = -100, .high = 100};
  RigidBody2d body;
  read_mass(fields, body.mass);
  fields.text("name", body.name)
      .vector<2>("position", body.position, kCoordinate)
      .number("angle", body.angle, kAngle)
      .colour("colour", body.colour);
  if (!body.name.empty() &&
      std::ranges::any_of(scene.rigid_bodies, [&](const auto& other) { return other.name == body.name; })) {
    throw SceneError(fields.location("name"),
                     fmt::format("{} has the name of another rigid body, '{}'; give one of them another",
                                 fields.what(), body.name));
  }
  return body;
}

std::vector<Vector2f> read_corners(FieldReader& fields) {
  constexpr std::size_t kMaxCorners = 8;  // Box2D's
  std::vector<Vector2f> corners;
  for (const Value& item : fields.items("corners", kMaxCorners)) {
    const std::string name = fmt::format("corner {} of {}", corners.size() + 1, fields.what());
    const auto* pair = std::get_if<Array>(&item.data);
    if (pair == nullptr || pair->size() != 2)
      throw SceneError(item.location, name + " must be an array of 2 numbers");
    corners.push_back({read_number((*pair)[0], "x of " + name, kCoordinate),
                       read_number((*pair)[1], "y of " + name, kCoordinate)});
  }
  return corners;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Whether every corner turns left, once around in all, and lies far enough from each other side.
bool is_convex(const std::vector<Vector2f>& corners) {
  const std::size_t n = corners.size();
  if (n < 3) return false;
  double longest = 0;
  for (const Vector2f& corner : corners)
    longest = std::max(longest, double{(corner - corners.front()).norm()});
  const double least = std::max(kSmallest, kThinnest * longest);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d along = (corners[(i + 1) % n] - corners[i]).cast<double>();
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || j == (i + 1) % n) continue;
      const Vector2d to = (corners[j] - corners[i]).cast<double>();
      if (!(cross(along, to) >= least * along.norm())) return false;
    }
  }
  return true;
}

Vector2d centroid(const std::vector<Vector2f>& corners) {
  SC_ASSERT(corners.size() >= 3, "a polygon of {} corners", corners.size());
  const Vector2d first = corners.front().cast<double>();
  Vector2d moment{0, 0};
  double area = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vector2d a = corners[i - 1].cast<double>() - first, b = corners[i].cast<double>() - first;
    moment += cross(a, b) * (a + b) / 3;
    area += cross(a, b);
  }
  return first + moment / area;
}

/// Moves the body's position to the centroid of its polygon, which stays where it is. Box2D computes an inertia about the body's position
/// and subtracts what the distance adds: for a small polygon far away nothing would be left, and Box2D ends the process.
void stand_at_centroid(RigidBody2d& body, PolygonShape& polygon) {
  const Vector2d middle = centroid(polygon.corners);
  for (Vector2f& corner : polygon.corners) corner = (corner.cast<double>() - middle).cast<float>();
  const double sine = ppu::sine(double{body.angle}), cosine = ppu::cosine(double{body.angle});
  const Vector2d turned{cosine * middle.x() - sine * middle.y(), sine * middle.x() + cosine * middle.y()};
  body.position = (body.position.cast<double>() + turned).cast<float>();
}

void read_rigid_bodies(FieldReader& root, Scene2d& scene) {
  const auto boxes = root.items("box", kMaxRigidBodies);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    FieldReader fields(boxes[i], item_name("box", i));
    Box2dShape shape;
    RigidBody2d body = read_rigid_body(fields, scene);
    fields.vector<2>("size", shape.size, kRigidLength, Need::kRequired).finish();
    body.shape = shape;
    scene.rigid_bodies.push_back(body);
  }
  const auto circles = root.items("circle", kMaxRigidBodies);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    FieldReader fields(circles[i], item_name("circle", i));
    CircleShape shape;
    RigidBody2d body = read_rigid_body(fields, scene);
    fields.number("radius", shape.radius, kRigidLength, Need::kRequired).finish();
    body.shape = shape;
    scene.rigid_bodies.push_back(body);
  }
  const auto polygons = root.items("polygon", kMaxRigidBodies);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    FieldReader fields(polygons[i], item_name("polygon", i));
    RigidBody2d body = read_rigid_body(fields, scene);
    PolygonShape shape{read_corners(fields)};
    fields.finish();
    if (!is_convex(shape.corners)) {
      throw SceneError(
          fields.location("corners"),
          fmt::format("{} must be convex and have 3 to 8 corners, counter-clockwise, each at least {} m, and "
                      "{} of its length, off the sides that it does not end",
                      fields.what(), kSmallest, kThinnest));
    }
    stand_at_centroid(body, shape);
    body.shape = std::move(shape);
    scene.rigid_bodies.push_back(std::move(body));
  }
}

Eigen::Vector2i read_cell(FieldReader& fields, std::string_view key) {
  const auto numbers = fields.items(key, 2);
  const std::string name = fmt::format("{} of {}", key, fields.what());
  if (numbers.size() != 2)
    throw SceneError(fields.location(key), name + " must be an array of 2 whole numbers");
  const auto number = [&](std::size_t i) {
    return read_integer(numbers[i], (i == 0 ? "x of " : "y of ") + name, -kMaxCellIndex, kMaxCellIndex);
  };
  return {number(0), number(1)};
}

void read_cell_colours(FieldReader& body, SoftBody2dPlacement& placement) {
  constexpr std::size_t kMaxColours = 64;
  const auto items = body.items("cell_colours", kMaxColours);
  for (std::size_t i = 0; i < items.size(); ++i) {
    FieldReader fields(items[i], fmt::format("{} of {}", item_name("colour", i), body.what()));
    ColouredCells2d& cells = placement.coloured_cells.emplace_back();
    cells.low = read_cell(fields, "low");
    cells.high = read_cell(fields, "high");
    if ((cells.high.array() < cells.low.array()).any())
      throw SceneError(fields.location("high"), fields.what() + " ends before it begins: high is below low");
    fields.colour("colour", cells.colour).finish();
  }
}

std::optional<Face2d> read_face(FieldReader& body) {
  const Value* value = body.field("face");
  if (value == nullptr) return std::nullopt;
  constexpr Range kIndex{.low = -kMaxCellIndex, .high = kMaxCellIndex}, kSize{.low = 0.5, .high = 256};
  Face2d face;
  FieldReader(*value, "the face of " + body.what())
      .vector<2>("centre", face.centre, kIndex, Need::kRequired)
      .number("size", face.size, kSize)
      .finish();
  return face;
}

/// Refuses a face that lies far from all cells, because it would swing about.
void check_face(const FieldReader& fields, const SoftBody2dPlacement& body) {
  if (!body.face) return;
  const bool on_cell = std::ranges::any_of(body.cells, [&](const Eigen::Vector2i& cell) {
    const Vector2f from = body.face->centre - cell.cast<float>();
    return from.minCoeff() >= 0 && from.maxCoeff() <= 1;
  });
  if (!on_cell)
    throw SceneError(fields.location("face"),
                     fmt::format("the face of {} has its centre on none of its cells", fields.what()));
}

/// @param picture  the user's own; null: there is none, or it has replaced another body
/// @return  whether it replaces this body
bool read_soft_body(const Value& value, std::size_t index, LatticeFiles& lattices, const Materials& materials,
                    const OwnPicture* picture, Scene2d& scene) {
  constexpr Range kContactRadius{.low = 0.01, .high = 1};
  FieldReader fields(value, item_name("soft body", index, stated_name(value)));
  SoftBody2dPlacement& body = scene.soft_bodies.emplace_back();
  std::optional<float> own_image_side;
  body.name = "body " + std::to_string(index + 1);
  body.described = fields.described();
  fields.text("name", body.name)
      .colour("colour", body.colour)
      .vector<2>("position", body.position, kCoordinate)
      .number("contact_radius", body.contact_radius, kContactRadius)
      .number("own_image_side", own_image_side, kLength);
  read_cell_colours(fields, body);
  body.face = read_face(fields);
  read_strengths<2>(fields, body.strengths);
  check_name(fields, scene);
  const bool replaced = picture != nullptr && own_image_side;
  Material material =
      materials.read(fields, replaced || fields.has("image") ? Need::kOptional : Need::kRequired);
  body.settings.cell_size = material.settings.cell_size;
  read_lattice_2d(fields, lattices,
                  {.picture = replaced ? picture : nullptr, .longest_side = own_image_side.value_or(0)},
                  body);
  material.settings.cell_size = body.settings.cell_size;
  if (body.settings.cell_size < static_cast<float>(kLeastCellSize)) {
    throw SceneError(fields.location("longest_side"),
                     fmt::format("the cells of {} would be {:.3g} m large; they may be no smaller than {}",
                                 fields.what(), body.settings.cell_size, kLeastCellSize));
  }
  body.settings = material.settings_for(step_of(scene));
  if (!replaced && body.picture && !body.coloured_cells.empty())
    throw SceneError(fields.location("cell_colours"),
                     fields.what() + " has an image and cell_colours; give one of them");
  if (replaced) {
    body.face.reset();
    body.coloured_cells.clear();
  }
  check_face(fields, body);
  return replaced;
}

/// @return the number of particles in each body
std::vector<std::size_t> read_soft_bodies(std::span<const Value> items, const SceneSource& source,
                                          const Materials& materials,
                                          const std::optional<OwnPicture>& picture, Scene2d& scene) {
  LatticeFiles lattices(source);
  std::vector<std::size_t> of_each;
  std::size_t particles = 0;
  bool place_taken = false;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const OwnPicture* own = picture && !place_taken ? &*picture : nullptr;
    place_taken = read_soft_body(items[i], i, lattices, materials, own, scene) || place_taken;
    try {
      of_each.push_back(scene.soft_bodies.back().lattice().particles.size());
      particles += of_each.back();
    } catch (const std::runtime_error& error) {
      throw SceneError(items[i].location, error.what());
    }
    check_particles(particles, items[i].location);
  }
  if (picture && !place_taken) {
    throw NoPlaceForModel("--image cannot be used with scene " + scene.name +
                          ": it has no body with own_image_side");
  }
  return of_each;
}

void read_attachments(std::span<const Value> items, Scene2d& scene) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    FieldReader fields(items[i], item_name("attach", i));
    AttachmentPlacement<2>& attachment = scene.attachments.emplace_back();
    attachment.described = fields.described();
    std::string rigid;
    fields.text("rigid", rigid);
    if (fields.has("rigid")) attachment.rigid = find_rigid_body(rigid, fields.location("rigid"), scene);
    read_attachment(fields, scene, attachment);
  }
}

}  // namespace

void read_another_body(const Value& item, const SceneSource& source, Scene2d& scene) {
  LatticeFiles lattices(source);
  read_soft_body(item, scene.soft_bodies.size(), lattices, Materials(nullptr), nullptr, scene);
  std::size_t particles = 0;
  for (const SoftBody2dPlacement& body : scene.soft_bodies) particles += body.lattice().particles.size();
  check_added_particles(particles, item.location);
}

Scene2d read_scene_2d(FieldReader& root, const SceneSource& source,
                      const std::optional<OwnPicture>& picture) {
  Scene2d scene;
  scene.name = source.name();
  read_world(root, scene);
  const Value* framework = root.field("framework");
  const Value* camera = root.field("camera");
  const Value* begin = root.field("begin");
  const Materials materials(root.field("materials"));
  if (framework != nullptr) read_framework(*framework, scene);
  read_rigid_bodies(root, scene);
  const std::vector<std::size_t> particles =
      read_soft_bodies(root.items("soft_body", kMaxSoftBodies), source, materials, picture, scene);
  read_attachments(root.items("attach", kMaxAttachments), scene);
  scene.begin = read_begin<2>(begin, source, particles, scene);
  read_script<2>(root, scene);
  read_cuts<2>(root.items("cut", kMaxEvents), scene);
  if (camera != nullptr) {
    FieldReader(*camera, "camera")
        .vector<2>("centre", scene.camera.centre, kCoordinate)
        .number("height", scene.camera.height, kLength)
        .finish();
  }
  root.finish();
  return scene;
}

}  // namespace softcell::demos
