#include "read_mesh.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

// Finer meshes cost time and look the same.
constexpr int kMaxSegments = 512, kMaxSubdivisions = 128, kMaxSquaresAlongEdge = 256;

ppu::TriangleMesh sphere(FieldReader& fields) {
  float radius = 0.5f;
  int subdivisions = 24;
  fields.number("radius", radius, kLength)
      .integer("subdivisions", subdivisions, 1, kMaxSubdivisions)
      .finish();
  return ppu::make_sphere(radius, subdivisions);
}

ppu::TriangleMesh torus(FieldReader& fields) {
  float major = 0.75f, minor = 0.3f;
  int ring = 96, tube = 40;
  fields.number("major", major, kLength)
      .number("minor", minor, kLength)
      .integer("ring_segments", ring, 3, kMaxSegments)
      .integer("tube_segments", tube, 3, kMaxSegments)
      .finish();
  return ppu::make_torus(major, minor, ring, tube);
}

ppu::TriangleMesh box(FieldReader& fields) {
  Eigen::Vector3f size{1, 1, 1};
  float step = 0.1f;
  fields.vector("size", size, kLength).number("step", step, kLength).finish();
  if (size.maxCoeff() > step * static_cast<float>(kMaxSquaresAlongEdge)) {
    throw SceneError(fields.location("step"),
                     fmt::format("step of {} is {}: its faces would have more than {} squares along an edge",
                                 fields.what(), step, kMaxSquaresAlongEdge));
  }
  return ppu::make_box(size, step);
}

ppu::TriangleMesh rounded_box(FieldReader& fields) {
  Eigen::Vector3f size{1, 1, 1};
  int subdivisions = 16;
  fields.vector("size", size, kLength).integer("subdivisions", subdivisions, 1, kMaxSubdivisions).finish();
  return ppu::make_rounded_box(size, subdivisions);
}

ppu::TriangleMesh car(FieldReader& fields) {
  float length = 1.7f;
  fields.number("length", length, kLength).finish();
  return ppu::make_car(length);
}

ppu::TriangleMesh penguin(FieldReader& fields) {
  float height = 1;
  fields.number("height", height, kLength).finish();
  return ppu::make_penguin(height);
}

template <ppu::TriangleMesh (*make)(float, float, int)>
ppu::TriangleMesh round(FieldReader& fields) {
  float radius = make == ppu::make_capsule ? 0.25f : 0.5f, height = 1;
  int segments = 48;
  fields.number("radius", radius, kLength)
      .number("height", height, kLength)
      .integer("segments", segments, 3, kMaxSegments)
      .finish();
  return make(radius, height, segments);
}

ppu::TriangleMesh vase(FieldReader& fields) {
  float height = 1;
  int segments = 48;
  fields.number("height", height, kLength).integer("segments", segments, 3, kMaxSegments).finish();
  return ppu::make_vase(height, segments);
}

ppu::TriangleMesh wedge(FieldReader& fields) {
  Eigen::Vector3f size{1, 1, 1};
  fields.vector("size", size, kLength).finish();
  return ppu::make_wedge(size);
}

ppu::TriangleMesh marked_cells(FieldReader& fields) {
  float size = 1;
  Eigen::Vector3f ball{0.5f, 0.5f, 0.5f};
  fields.number("size", size, kLength).vector("ball", ball, {.low = 0.1, .high = 0.9}).finish();
  return ppu::make_marked_cells(size, ball);
}

constexpr std::array<std::string_view, 2> kAxes{"y", "z"};
constexpr std::array<std::string_view, 12> kMeshKinds{"box",      "capsule",      "car",     "cone",
                                                      "cylinder", "marked_cells", "penguin", "rounded_box",
                                                      "sphere",   "torus",        "vase",    "wedge"};
constexpr std::array<ppu::TriangleMesh (*)(FieldReader&), 12> kMeshMakers{box,
                                                                          round<ppu::make_capsule>,
                                                                          car,
                                                                          round<ppu::make_cone>,
                                                                          round<ppu::make_cylinder>,
                                                                          marked_cells,
                                                                          penguin,
                                                                          rounded_box,
                                                                          sphere,
                                                                          torus,
                                                                          vase,
                                                                          wedge};

ppu::TriangleMesh primitive(const Value& value, const std::string& owner) {
  FieldReader fields(value, "the shape of " + owner);
  std::size_t kind = kMeshKinds.size();
  fields.choice("kind", kind, kMeshKinds, Need::kRequired);
  if (kind == kMeshKinds.size()) throw SceneError(value.location, fields.what() + " needs the field 'kind'");
  return kMeshMakers[kind](fields);
}

}  // namespace

Eigen::Quaternionf read_rotation(FieldReader& body) {
  constexpr Range kTurn{.low = -3600, .high = 3600};
  const Value* const value = body.field("rotation");
  if (value == nullptr) return Eigen::Quaternionf::Identity();
  Eigen::Vector3f axis{0, 1, 0};
  float degrees = 0;
  FieldReader fields(*value, "the rotation of " + body.what());
  fields.vector("axis", axis, kCoordinate).number("degrees", degrees, kTurn, Need::kRequired).finish();
  if (axis.norm() < 1e-4f)
    throw SceneError(fields.location("axis"), "axis of " + fields.what() + " must not be 0");
  const double half = double{degrees} * ppu::kPi / 360;
  const Eigen::Vector3d turn = ppu::sine(half) * axis.cast<double>().normalized();
  return {static_cast<float>(ppu::cosine(half)), static_cast<float>(turn.x()), static_cast<float>(turn.y()),
          static_cast<float>(turn.z())};
}

ppu::TriangleMesh read_mesh(FieldReader& body, MeshFiles& files) {
  const Value* shape = body.field("shape");
  std::string file;
  std::optional<float> longest_side, scale;
  std::size_t up = 0;
  body.text("mesh", file)
      .choice("up", up, kAxes)
      .number("scale", scale, kLength)
      .number("longest_side", longest_side, kLength)
      .finish();
  if ((shape != nullptr) == body.has("mesh")) {
    throw SceneError(body.location(),
                     body.what() + (shape == nullptr ? " needs a shape or a mesh"
                                                     : " has a shape and a mesh; it may have one of them"));
  }
  for (const char* const field : {"up", "scale"}) {
    if (shape != nullptr && body.has(field))
      throw SceneError(
          body.location(field),
          fmt::format("{} of {} is for a mesh from a file, not for a shape", field, body.what()));
  }
  if (scale && longest_side)
    throw SceneError(body.location("scale"),
                     body.what() + " has both scale and longest_side; give one of them");
  const Location& location = body.location(shape != nullptr ? "shape" : "mesh");
  ppu::TriangleMesh mesh;
  try {
    mesh = shape != nullptr ? primitive(*shape, body.what()) : files.mesh(file, location);
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(location, error.what());
  }
  if (up == 1) ppu::turn_z_up(mesh);
  if (scale) {
    ppu::scale(mesh, *scale);
    const ppu::Bounds<3> box = ppu::bounds(mesh);
    if (!((box.high - box.low).maxCoeff() <= static_cast<float>(kFar)))
      throw SceneError(
          body.location("scale"),
          fmt::format("scale of {} is {}, which makes it larger than {} m", body.what(), *scale, kFar));
  }
  if (longest_side) ppu::fit(mesh, *longest_side);
  return mesh;
}

void rotate(ppu::TriangleMesh& mesh, const Eigen::Quaternionf& rotation) {
  if (rotation.vec().isZero(0)) return;  // so that not a bit of the mesh changes
  ppu::rotate(mesh, rotation.toRotationMatrix());
}

}  // namespace softcell::demos
