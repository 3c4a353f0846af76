#include "ppu/contacts/entered_face.h"

#include <Eigen/Geometry>

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kDeepAtRest = 0.1f;   // cells: what is not so deep leaves by the nearest face
constexpr int kMostStepsAtRest = 16;  // of a way
constexpr float kOneFace = 0.5f;      // cosine between normals of what counts as one face

bool are_alike(const Vector3f& a, const Vector3f& b) { return a.dot(b) > kOneFace * a.norm() * b.norm(); }

/// The field of the face that a way through a body at rest meets, at the place where the way begins: as if the face were plane, and nothing
/// else there. Steps are nearly as long as the surface is far: at the lattice's boundary they end within.
/// @param direction  of unit length, in cells
/// @return  none: the way meets nothing
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
