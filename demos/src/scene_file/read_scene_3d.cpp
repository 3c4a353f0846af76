#include "read_scene.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "own_model.h"
#include "read_attachment.h"
#include "read_begin.h"
#include "read_breaking.h"
#include "read_common.h"
#include "read_material.h"
#include "read_mesh.h"
#include "read_rigid_body.h"
#include "scene/scene_camera.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/tessellate.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

constexpr std::array<std::string_view, 2> kPatterns{"plain", "tiles"};
constexpr Range kTessellation{.low = double{kLeastTessellation}, .high = double{kMostTessellation}};
constexpr Range kTwist{.low = -1000, .high = 1000};  // rad/s
constexpr Range kOwnModelSide{.low = kLeastCellSize * ppu::kMaxLatticeCellsPerAxis, .high = kFar};

/// Reads a floor whose upper side is at y = 0, and four walls on it. The wall towards +z, where cameras are, may be glass.
void read_framework(const Value& value, Scene& scene) {
  float half_width = 4.5f, height = 0.9f, thickness = 0.3f, front_opacity = 1;
  auto floor_colour = render::srgb(0xB9B4A7), wall_colour = render::srgb(0x9AA7B5);
  std::size_t pattern = 1;
  FieldReader(value, "framework")
      .number("half_width", half_width, kLength)
      .number("height", height, kLength)
      .number("thickness", thickness, kLength)
      .number("front_opacity", front_opacity, kShare)
      .colour("floor_colour", floor_colour)
      .colour("wall_colour", wall_colour)
      .choice("pattern", pattern, kPatterns)
      .finish();
  const float outer = 2 * half_width + 2 * thickness, middle = half_width + thickness / 2;
  scene.boxes.push_back({.size = {outer, 1, outer},
                         .position = {0, -0.5f, 0},
                         .colour = floor_colour,
                         .pattern = static_cast<render::Pattern>(pattern)});
  for (const float side : {-1.0f, 1.0f}) {
    scene.boxes.push_back({.size = {thickness, height, outer},
                           .position = {side * middle, height / 2, 0},
                           .colour = wall_colour,
                           .wall = true});
    scene.boxes.push_back({.size = {2 * half_width, height, thickness},
                           .position = {0, height / 2, side * middle},
                           .colour = wall_colour,
                           .opacity = side > 0 ? front_opacity : 1.0f,
                           .wall = true});
  }
}

RigidBox read_box(const Value& value, std::size_t index) {
  RigidBox box;
  std::size_t pattern = 0;
  FieldReader fields(value, item_name("box", index));
  read_mass(fields, box.mass);
  box.rotation = read_rotation(fields);
  fields.vector<3>("size", box.size, kLength, Need::kRequired)
      .vector<3>("position", box.position, kCoordinate)
      .colour("colour", box.colour)
      .number("opacity", box.opacity, kShare)
      .choice("pattern", pattern, kPatterns)
      .finish();
  box.pattern = static_cast<render::Pattern>(pattern);
  return box;
}

/// Counts the vertices of a scene's meshes, so that a scene with more than a picture can show is refused before it costs anything else.
class VertexCount {
 public:
  void add(const ppu::TriangleMesh& mesh, const Location& location) {
    vertices_ += mesh.positions.size();
    if (vertices_ > kMaxVerticesOfScene) {
      throw SceneError(location,
                       fmt::format("the scene's meshes have {} vertices or more; it may have at most {}",
                                   vertices_, kMaxVerticesOfScene));
    }
  }

 private:
  std::size_t vertices_ = 0;
};

Obstacle read_obstacle(const Value& value, std::size_t index, MeshFiles& files) {
  FieldReader fields(value, item_name("obstacle", index));
  Obstacle obstacle;
  fields.vector<3>("position", obstacle.position, kCoordinate).colour("colour", obstacle.colour);
  const Eigen::Quaternionf rotation = read_rotation(fields);
  obstacle.own_materials = !fields.has("colour");
  obstacle.mesh = read_mesh(fields, files);
  rotate(obstacle.mesh, rotation);
  return obstacle;
}

/// Replaces the body's own mesh by the user's model.
void replace_mesh(SoftBodyPlacement& body, const OwnModel& model, float longest_side) {
  const ppu::Bounds<3> box = ppu::bounds(model.mesh);
  SC_ASSERT((box.high - box.low).maxCoeff() > 0 && longest_side > 0, "a model {} long is made {} m long",
            (box.high - box.low).maxCoeff(), longest_side);
  const float scale = longest_side / (box.high - box.low).maxCoeff();
  body.mesh = model.mesh;
  ppu::fit(body.mesh, longest_side);
  body.settings.cell_size = model.cell_size * scale;
}

/// The number of particles in the lattice that the mesh will get. A scene with too many is refused here, where its file and line are known.
std::size_t count_particles(const SoftBodyPlacement& body, const Location& location) {
  try {
    ppu::validate(body.settings);
    return ppu::voxelize(body.mesh, body.settings.cell_size).particles.size();
  } catch (const std::runtime_error& error) {
    throw SceneError(location, error.what());
  }
}

/// Adds the material with which pieces of the mesh draw their cut faces. The rest of a body of one colour keeps its colour.
void add_cut_material(const Vector3f& colour, SoftBodyPlacement& body) {
  ppu::TriangleMesh& mesh = body.mesh;
  if (!body.own_materials) {
    mesh.materials.clear(), mesh.parts.clear(), mesh.colours.clear(), mesh.texture_coordinates.clear();
    body.own_materials = true;
  }
  ppu::MeshMaterial& cut = mesh.materials.emplace_back();
  cut.name = "cut";
  cut.base_colour = Eigen::Vector4f(colour.x(), colour.y(), colour.z(), 1);
}

/// Splits the mesh's edges so that it bends with the lattice. @param longest_edge  metres
void tessellate_mesh(float longest_edge, const Location& location, ppu::TriangleMesh& mesh) {
  try {
    mesh = ppu::tessellate(mesh, longest_edge);
  } catch (const std::invalid_argument& error) {
    throw SceneError(location, error.what());
  }
}

/// @return whether the model has replaced the body.
bool read_soft_body(const Value& value, std::size_t index, MeshFiles& files, const Materials& materials,
                    const OwnModel* model, Scene& scene) {
  FieldReader fields(value, item_name("soft body", index, stated_name(value)));
  SoftBodyPlacement& body = scene.soft_bodies.emplace_back();
  std::optional<float> own_model_side, above, tessellation;
  std::optional<Vector3f> cut_colour;
  bool contacts = true;
  body.name = "body " + std::to_string(index + 1);
  body.described = fields.described();
  fields.text("name", body.name)
      .colour("colour", body.colour)
      .painted_colour("cut_colour", cut_colour)
      .vector<3>("position", body.position, kCoordinate)
      .number("above", above, kCoordinate)
      .number("own_model_side", own_model_side, kOwnModelSide)
      .number("twist", body.twist, kTwist)
      .number("tessellate", tessellation, kTessellation)
      .flag("contacts", contacts);
  read_strengths<3>(fields, body.strengths);
  check_name(fields, scene);
  const bool replaced = model != nullptr && own_model_side;
  Material material = materials.read(fields, replaced ? Need::kOptional : Need::kRequired);
  const Eigen::Quaternionf rotation = read_rotation(fields);
  body.own_materials = replaced || !fields.has("colour");
  body.mesh = read_mesh(fields, files);
  if (replaced) {
    replace_mesh(body, *model, model->longest_side.value_or(*own_model_side));
    material.settings.cell_size = body.settings.cell_size;
    tessellation = model->tessellation;
  }
  rotate(body.mesh, rotation);
  if (tessellation) tessellate_mesh(*tessellation * material.settings.cell_size, value.location, body.mesh);
  if (cut_colour) add_cut_material(*cut_colour, body);
  body.settings = material.settings_for(step_of(scene));
  body.settings.contacts = contacts;
  if (above) body.position.y() = *above - ppu::bounds(body.mesh).low.y();
  return replaced;
}

/// @return the number of particles in each body
std::vector<std::size_t> read_soft_bodies(std::span<const Value> items, MeshFiles& files,
                                          const Materials& materials, const std::optional<OwnModel>& model,
                                          VertexCount& vertices, Scene& scene) {
  bool place_taken = false;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const OwnModel* own = model && !place_taken ? &*model : nullptr;
    place_taken = read_soft_body(items[i], i, files, materials, own, scene) || place_taken;
    vertices.add(scene.soft_bodies.back().mesh, items[i].location);
  }
  std::vector<std::size_t> of_each;
  std::size_t particles = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    of_each.push_back(count_particles(scene.soft_bodies[i], items[i].location));
    particles += of_each.back();
    check_particles(particles, items[i].location);
  }
  if (model && !place_taken) {
    throw NoPlaceForModel("--mesh cannot be used with scene " + scene.name +
                          ": it has no body with own_model_side");
  }
  return of_each;
}

/// @param first_box  index of the scene's own first box among all boxes
void read_attachments(std::span<const Value> items, std::size_t first_box, Scene& scene) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    FieldReader fields(items[i], item_name("attach", i));
    AttachmentPlacement<3>& attachment = scene.attachments.emplace_back();
    attachment.described = fields.described();
    std::string rigid;
    int box = 0;
    fields.text("rigid", rigid)
        .integer("box", box, 1, static_cast<int>(std::max<std::size_t>(scene.boxes.size() - first_box, 1)));
    if (fields.has("rigid")) attachment.rigid = find_rigid_body(rigid, fields.location("rigid"), scene);
    if (fields.has("box")) {
      if (first_box == scene.boxes.size())
        throw SceneError(fields.location("box"), fields.what() + " names a box; the scene has none");
      attachment.box = first_box + static_cast<std::size_t>(box) - 1;
    }
    read_attachment(fields, scene, attachment);
  }
}

void read_camera(const Value& value, render::Camera& camera) {
  constexpr Range kAngle{.low = 0.01, .high = 10};
  FieldReader fields(value, "camera");
  fields.vector<3>("eye", camera.eye, kCoordinate)
      .vector<3>("target", camera.target, kCoordinate)
      .vector<3>("up", camera.up, kCoordinate)
      .number("tan_half_fov_y", camera.tan_half_fov_y, kAngle)
      .number("near", camera.near_plane, kLength)
      .number("far", camera.far_plane, kLength)
      .finish();
  if (camera.far_plane <= camera.near_plane) {
    throw SceneError(fields.location("far"), "far of camera must be larger than near");
  }
  const Vector3f sight = camera.target - camera.eye;
  if (sight.cross(camera.up).norm() <= 1e-4f * sight.norm() * camera.up.norm()) {
    throw SceneError(fields.location("target"),
                     "the camera's eye and target must differ, and up must not lie along the line of sight");
  }
}

void read_light(const Value& value, render::Light& light) {
  FieldReader fields(value, "light");
  fields.vector<3>("toward", light.toward, kCoordinate)
      .colour("colour", light.colour)
      .colour("sky", light.sky)
      .colour("ground", light.ground)
      .vector<3>("shadow_centre", light.shadow_centre, kCoordinate)
      .number("shadow_radius", light.shadow_radius, kLength)
      .finish();
  if (light.toward.norm() < 1e-4f)
    throw SceneError(fields.location("toward"), "toward of light must not be 0");
}

void read_tilt(const Value& value, TiltScript& tilt) {
  constexpr Range kAngle{.low = -1.5, .high = 1.5}, kPeriod{.low = 0.01, .high = kMaxTime};
  FieldReader(value, "tilt")
      .number("amplitude_x", tilt.amplitude_x, kAngle)
      .number("amplitude_z", tilt.amplitude_z, kAngle)
      .number("period_x", tilt.period_x, kPeriod)
      .number("period_z", tilt.period_z, kPeriod)
      .number("begin", tilt.begin, kTime)
      .finish();
}

}  // namespace

void read_another_body(const Value& item, const SceneSource& source, Scene& scene) {
  VertexCount vertices;
  std::size_t particles = 0;
  for (const SoftBodyPlacement& body : scene.soft_bodies) {
    vertices.add(body.mesh, item.location);
    particles += count_particles(body, item.location);
  }
  MeshFiles files(source);
  read_soft_body(item, scene.soft_bodies.size(), files, Materials(nullptr), nullptr, scene);
  vertices.add(scene.soft_bodies.back().mesh, item.location);
  particles += count_particles(scene.soft_bodies.back(), item.location);
  check_added_particles(particles, item.location);
  scene.notes.insert(scene.notes.end(), files.notes().begin(), files.notes().end());
}

Scene read_scene_3d(FieldReader& root, const SceneSource& source, const std::optional<OwnModel>& model) {
  Scene scene;
  scene.name = source.name();
  read_world(root, scene);
  const Value* framework = root.field("framework");
  const Value* camera = root.field("camera");
  const Value* light = root.field("light");
  const Value* tilt = root.field("tilt");
  const Value* begin = root.field("begin");
  const Materials materials(root.field("materials"));
  const auto boxes = root.items("box", kMaxRigidBodies);
  const auto obstacles = root.items("obstacle", kMaxRigidBodies);
  const auto soft_bodies = root.items("soft_body", kMaxSoftBodies);
  const auto attachments = root.items("attach", kMaxAttachments);
  const auto cuts = root.items("cut", kMaxEvents);
  const auto rigid_bodies = root.items("rigid_body", kMaxRigidBodies);
  const auto joints = root.items("joint", kMaxRigidBodies);
  if (framework != nullptr) read_framework(*framework, scene);
  const std::size_t first_box = scene.boxes.size();
  for (std::size_t i = 0; i < boxes.size(); ++i) scene.boxes.push_back(read_box(boxes[i], i));
  read_rigid_bodies(rigid_bodies, scene);
  read_joints(joints, scene);
  VertexCount vertices;
  MeshFiles files(source);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    scene.obstacles.push_back(read_obstacle(obstacles[i], i, files));
    vertices.add(scene.obstacles.back().mesh, obstacles[i].location);
  }
  const std::vector<std::size_t> particles =
      read_soft_bodies(soft_bodies, files, materials, model, vertices, scene);
  scene.begin = read_begin<3>(begin, source, particles, scene);
  scene.notes = files.notes();
  read_attachments(attachments, first_box, scene);
  read_script<3>(root, scene);
  read_cuts<3>(cuts, scene);
  if (camera != nullptr) read_camera(*camera, scene.camera);
  if (camera == nullptr) scene.camera.eye = {1.9f, 2.2f, 4.2f};  // frame_bodies() looks from this direction
  if (camera == nullptr || model) frame_bodies(scene);
  if (light != nullptr) read_light(*light, scene.light);
  if (tilt != nullptr) read_tilt(*tilt, scene.tilt);
  root.finish();
  return scene;
}

}  // namespace softcell::demos
