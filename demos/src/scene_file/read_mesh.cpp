#include "read_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "softcell/mesh_import/mesh_import.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

// Finer ones cost time and show nothing.
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
    throw SceneError(fields.place("step"),
                     fmt::format("step of {} is {}: its faces would have more than {} squares along an edge",
                                 fields.what(), step, kMaxSquaresAlongEdge));
  }
  return ppu::make_box(size, step);
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
  float radius = 0.5f, height = 1;
  int segments = 48;
  fields.number("radius", radius, kLength)
      .number("height", height, kLength)
      .integer("segments", segments, 3, kMaxSegments)
      .finish();
  return make(radius, height, segments);
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

constexpr std::array<std::string_view, 9> kMeshKinds{"box",     "car",    "cone",  "cylinder", "marked_cells",
                                                     "penguin", "sphere", "torus", "wedge"};
constexpr std::array<ppu::TriangleMesh (*)(FieldReader&), 9> kMeshMakers{
    box, car, round<ppu::make_cone>, round<ppu::make_cylinder>, marked_cells, penguin, sphere, torus, wedge};

ppu::TriangleMesh primitive(const Value& value, const std::string& owner) {
  FieldReader fields(value, "the shape of " + owner);
  std::size_t kind = kMeshKinds.size();
  fields.choice("kind", kind, kMeshKinds, Need::kRequired);
  if (kind == kMeshKinds.size()) throw SceneError(value.place, fields.what() + " needs the field 'kind'");
  return kMeshMakers[kind](fields);
}

}  // namespace

ppu::TriangleMesh read_mesh(FieldReader& body, const SceneSource& source) {
  const Value* shape = body.field("shape");
  std::string file;
  std::optional<float> longest_side;
  body.text("mesh", file).number("longest_side", longest_side, kLength).finish();
  if ((shape != nullptr) == body.has("mesh")) {
    throw SceneError(body.place(), body.what() + " needs either a shape or a mesh");
  }
  const Place& place = body.place(shape != nullptr ? "shape" : "mesh");
  try {
    ppu::TriangleMesh mesh =
        shape != nullptr ? primitive(*shape, body.what()) : ppu::import_mesh(source.mesh(file, place));
    if (longest_side) ppu::fit(mesh, *longest_side);
    return mesh;
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(place, error.what());
  }
}

}  // namespace softcell::demos
