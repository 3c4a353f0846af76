#include "ppu/contacts/entered_face.h"

#include <Eigen/Geometry>
#include <cmath>

namespace softcell::ppu {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kDeepAtRest = 0.1f;  // cells: less deep points leave through the nearest face
constexpr int kHalvings = 3;         // of a point's way through the body at rest
// A face that the line to the inside of a point's own body meets counts up to this many times as far as the nearest face.
constexpr float kNotFar = 2;
constexpr int kMostStepsAtRest = 16;  // along a line

/// A point's way through a body at rest, in cells.
class WayAtRest {
 public:
  /// @param begin, inverse  as way_out_of() has them  @param deep  cells
  WayAtRest(const ContactModel& model, const DeformedPlace& end, const Matrix3f& inverse,
            const Vector3f& begin, float deep)
      : model_(model), inverse_(inverse), begin_(low(end.cell) + begin), way_(end.xi - begin), deep_(deep) {}

  /// The field, at the way's end, of the face by which the point has come in, as if the face were plane and alone.
  /// @param along  as way_out_of() has it
  /// @return  none: the point is not deep, or only at the very end
  std::optional<FieldValue> field_of_entered_face(const Vector3f& along) const {
    if (const auto field = field_at(begin_); field && field->distance < -deep_)
      return at_end(field_of_face_at_beginning(*field, along), 0);
    float outside = 0, inside = 1;
    std::optional<FieldValue> entered;
    for (int i = 0; i < kHalvings; ++i) {
      const float middle = 0.5f * (outside + inside);
      const auto field = field_at(begin_ + middle * way_);
      if (field && field->distance < -deep_)
        inside = middle, entered = at_end(*field, middle);
      else
        outside = middle;
    }
    return entered;
  }

 private:
  Vector3f low(std::uint32_t cell) const { return model_.lattice().cells[cell].cast<float>(); }

  std::optional<FieldValue> field_at(const Vector3f& place) const {
    const auto cell = model_.cell_at(place);
    if (!cell) return {};
    return model_.surface.field(*cell, place - low(*cell));
  }

  FieldValue at_end(const FieldValue& field, float share) const {
    return {field.distance + (1 - share) * field.gradient.dot(way_), field.gradient};
  }

  /// Metres, in the deformed body.
  float depth(const FieldValue& field) const {
    return -field.distance / (inverse_.transpose() * field.gradient).norm();
  }

  FieldValue field_of_face_at_beginning(const FieldValue& nearest, const Vector3f& along) const {
    const Vector3f outwards = inverse_.transpose() * nearest.gradient;
    if (outwards.dot(along) >= kAlike * outwards.norm() * along.norm()) return nearest;
    const auto met = field_of_met_face(nearest, (inverse_ * along).normalized());
    return met && depth(*met) < kNotFar * depth(nearest) ? *met : nearest;
  }

  /// Follows a line from the beginning to the face that it meets, and returns the field of this face at the beginning. Each step is nearly
  /// as long as the distance to the surface, so steps end within the lattice's boundary.
  /// @param direction  of unit length
  /// @return  none: the line meets no face
  std::optional<FieldValue> field_of_met_face(FieldValue field, const Vector3f& direction) const {
    Vector3f way = Vector3f::Zero();
    for (int step = 0; field.distance < -kDeepAtRest; ++step) {
      way -= (field.distance + kDeepAtRest / 2) * direction;
      const auto there = field_at(begin_ + way);
      if (!there || step == kMostStepsAtRest) return {};
      field = *there;
    }
    return FieldValue{field.distance - field.gradient.dot(way), field.gradient};
  }

  const ContactModel& model_;
  const Matrix3f& inverse_;
  Vector3f begin_, way_;
  float deep_;
};

FieldValue field_of_entered_face(const ContactBody& body, const DeformedPlace& place, const Matrix3f& inverse,
                                 float allowance, const Vector3f& along, const Vector3f& begin) {
  const FieldValue nearest = body.model->surface.field(place.cell, place.xi);
  if (nearest.distance >= -kDeepAtRest) return nearest;
  const WayAtRest way(*body.model, place, inverse, begin, kDeepAtRest + allowance / body.spacing());
  return way.field_of_entered_face(along).value_or(nearest);
}

}  // namespace

std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place, float allowance,
                                 const Vector3f& along, const Vector3f& begin) {
  const Matrix3f inverse = place.jacobian.inverse();
  return way_out_by(field_of_entered_face(body, place, inverse, allowance, along, begin), inverse, allowance,
                    body.spacing());
}

}  // namespace softcell::ppu
