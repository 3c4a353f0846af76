#include "ppu/contacts/entered_face.h"

#include <Eigen/Geometry>

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kDeepAtRest = 0.1f;   // cells: less deep points leave through the nearest face
constexpr int kMostStepsAtRest = 16;  // along a line
constexpr float kOneFace = 0.5f;      // cosine between normals that count as one face

bool are_alike(const Vector3f& a, const Vector3f& b) { return a.dot(b) > kOneFace * a.norm() * b.norm(); }

/// Follows a line through the body at rest to the face that it meets, and returns the field of this face at the line's begin, as if the
/// face were plane and alone. Each step is nearly as long as the distance to the surface, so steps end within the lattice's boundary.
/// @param direction  of unit length, in cells
/// @return  none: the line meets no face
std::optional<FieldValue> field_of_face(const ContactModel& model, const DeformedPlace& place,
                                        FieldValue field, const Vector3f& direction) {
  const auto low = [&](std::uint32_t cell) { return Vector3f(model.lattice().cells[cell].cast<float>()); };
  const Vector3f begin = low(place.cell) + place.xi;
  Vector3f way = Vector3f::Zero();
  for (int step = 0; field.distance < -kDeepAtRest; ++step) {
    way -= (field.distance + kDeepAtRest / 2) * direction;
    const auto cell = model.cell_at(begin + way);
    if (!cell || step == kMostStepsAtRest) return {};
    field = model.surface.field(*cell, begin + way - low(*cell));
  }
  return FieldValue{field.distance - field.gradient.dot(way), field.gradient};
}

FieldValue field_of_entered_face(const ContactModel& model, const DeformedPlace& place,
                                 const Eigen::Matrix3f& inverse, const Vector3f& along) {
  const FieldValue nearest = model.surface.field(place.cell, place.xi);
  if (nearest.distance >= -kDeepAtRest || along.isZero(0)) return nearest;
  const Vector3f outwards = inverse.transpose() * nearest.gradient;
  if (are_alike(outwards, along)) return nearest;
  const auto field = field_of_face(model, place, nearest, (inverse * along).normalized());
  if (!field || are_alike(outwards, inverse.transpose() * field->gradient)) return nearest;
  return *field;
}

}  // namespace

std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place, float allowance,
                                 const Vector3f& along) {
  const Eigen::Matrix3f inverse = place.jacobian.inverse();
  return way_out_by(field_of_entered_face(*body.model, place, inverse, along), inverse, allowance,
                    body.spacing());
}

}  // namespace softcell::ppu
