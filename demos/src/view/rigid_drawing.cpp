#include "rigid_drawing.h"

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

constexpr float kWholeFaces = 100;  // metres: each face is one square
constexpr int kRoundSegments = 64;  // of round shapes

ppu::TriangleMesh mesh_of_rigid(const ppu::RigidShape& shape) {
  switch (shape.kind) {
    case ppu::RigidShapeKind::kBox:
      return ppu::make_box(shape.size, kWholeFaces);
    case ppu::RigidShapeKind::kSphere:
      return ppu::make_sphere(shape.radius, kRoundSegments / 4);
    case ppu::RigidShapeKind::kCylinder:
      return ppu::make_cylinder(shape.radius, shape.height, kRoundSegments);
    case ppu::RigidShapeKind::kCapsule:
      return ppu::make_capsule(shape.radius, shape.height, kRoundSegments);
    case ppu::RigidShapeKind::kCone:
      return ppu::make_cone(shape.radius, shape.height, kRoundSegments);
  }
  SC_ASSERT(false, "a rigid shape of kind {}", static_cast<int>(shape.kind));
  return {};
}

}  // namespace

std::vector<DrawnPart> add_parts(std::span<const RigidBody> bodies, const AddStatic& add_static,
                                 std::vector<render::StaticDraw>& statics) {
  std::vector<DrawnPart> parts;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const RigidPart& part : bodies[b].parts) {
      parts.push_back({.body = b, .draw = statics.size(), .pose_in_body = part.pose()});
      statics.push_back({.mesh = add_static(mesh_of_rigid(part.shape)),
                         .colour = part.colour,
                         .opacity = bodies[b].opacity});
    }
  }
  return parts;
}

}  // namespace softcell::demos
