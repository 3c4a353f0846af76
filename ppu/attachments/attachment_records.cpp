#include "ppu/attachments/attachment_records.h"

#include <cmath>
#include <cstdint>
#include <span>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// How many particles of the kernel stand for one particle.
template <int kDimension>
constexpr std::uint32_t kColumn = kDimension == 2 ? 2 : 1;

template <typename Vector>
void lift(const Vector& v, float (&to)[3]) {
  for (int d = 0; d < 3; ++d) to[d] = d < v.size() ? v[d] : 0.0f;
}

/// @tparam Places  square, of up to four rows
template <typename Places>
void lift_places(const Places& from, float (&to)[4][4]) {
  for (Eigen::Index column = 0; column < from.cols(); ++column)
    for (Eigen::Index row = 0; row < from.rows(); ++row) to[column][row] = from(row, column);
}

template <int kDimension>
void lift_matrix(const Eigen::Matrix<float, kDimension, kDimension>& from, float (&to)[3][4]) {
  for (int column = 0; column < kDimension; ++column)
    for (int row = 0; row < kDimension; ++row) to[column][row] = from(row, column);
}

/// In two dimensions: about the axis perpendicular to the plane.
void lift_inertia(const Eigen::Matrix3f& from, float (&to)[3][4]) { lift_matrix<3>(from, to); }
void lift_inertia(const Eigen::Matrix<float, 1, 1>& from, float (&to)[3][4]) { to[2][2] = from(0, 0); }

float inverse_or_0(float x) { return x > 0 ? 1 / x : 0; }

}  // namespace

template <int kDimension>
bool AttachmentRecords<kDimension>::write(bool once, AttachUnit& unit) const {
  const bool is_weld_to_frame = rows_.settings_.kind == AttachmentKind::kWeld && rows_.sides_.b == nullptr;
  const bool moves = rows_.sides_.rigid != nullptr && rows_.sides_.rigid->inverse_mass > 0;
  if (is_weld_to_frame && moves && !rows_.with_rigid_at_once_) return false;  // the rigid body does not turn
  if (moves && !AttachedRigid<kDimension>::is_free(*rows_.sides_.rigid)) return false;
  spu::AttachLink link{};
  link.rigid = spu::kAttachNoRigid;
  link.once = once;
  link.pushes = rows_.pushes_;
  link.breaks = std::isfinite(rows_.settings_.break_force) && !rows_.carries_all();
  link.most_impulse = link.breaks != 0 ? rows_.settings_.break_force * rows_.step_ : 0;
  link.softness = rows_.softness_;
  link.most_push[0] = rows_.most_push(rows_.sides_.a);
  if (rows_.sides_.b != nullptr) link.most_push[1] = rows_.most_push(*rows_.sides_.b);
  if (is_weld_to_frame) {
    link.kind = spu::kAttachPoints;
    write_points(link, unit);
  } else {
    link.kind = rows_.settings_.kind == AttachmentKind::kRope ? spu::kAttachRope
                : rows_.places_at_once_                       ? spu::kAttachPlaces
                                                              : spu::kAttachHinge;
    write_rows(link, unit);
  }
  unit.links.push_back(link);
  unit.pushes = unit.pushes || rows_.pushes_;
  return true;
}

/// The particles of a column share their row's compliance: each of them alone gives way as far as the row.
template <int kDimension>
void AttachmentRecords<kDimension>::write_points(spu::AttachLink& link, AttachUnit& unit) const {
  constexpr auto kCopies = kColumn<kDimension>;
  constexpr float kPerCopy = 1.0f / kCopies;
  link.points = static_cast<std::uint32_t>(rows_.rows_.size()) * kCopies;
  link.softness *= kCopies;
  if (rows_.with_rigid_at_once_) {
    lift(rows_.sum_of_arms_, link.arms);
    link.inverse_sum = 1 / rows_.sum_;
    lift_inertia(rows_.inverse_inertia_, link.inverse_inertia);
  }
  for (const typename Rows::Row& row : rows_.rows_) {
    const std::uint32_t particle = rows_.a_.particle[row.a.first];
    spu::AttachPoint point{};
    lift(-rows_.relative_velocity(row), point.carried);
    lift(row.error, point.error);
    if (rows_.sides_.rigid != nullptr)
      lift(typename Rows::Vector(row.point - rows_.sides_.rigid->centre), point.arm);
    point.mass = kPerCopy * inverse_or_0(row.push_mobility + rows_.softness_);
    point.push_mass = kPerCopy * inverse_or_0(row.push_mobility);
    point.weight = std::sqrt(kCopies * rows_.sides_.a.inverse_masses[particle]);
    for (std::uint32_t copy = 0; copy < kCopies; ++copy) {
      point.slot = particle * kCopies + copy;
      unit.points.push_back(point);
    }
  }
}

template <int kDimension>
void AttachmentRecords<kDimension>::write_rows(spu::AttachLink& link, AttachUnit& unit) const {
  SC_ASSERT(rows_.rows_.size() <= 4, "{} places", rows_.rows_.size());
  link.rows = static_cast<std::uint32_t>(rows_.rows_.size());
  if (rows_.places_at_once_) {
    lift_places(rows_.inverse_of_places_, link.inverse);
    lift_places(rows_.inverse_of_pushes_, link.inverse_of_pushes);
  }
  for (const typename Rows::Row& from : rows_.rows_) {
    spu::AttachRow& row = unit.rows.emplace_back();
    row = {};
    lift(-rows_.relative_velocity(from), row.carried);
    lift(from.error, row.error);
    if (rows_.sides_.rigid != nullptr)
      lift(typename Rows::Vector(from.point - rows_.sides_.rigid->centre), row.arm);
    row.push_mass = inverse_or_0(from.push_mobility);
    if (rows_.settings_.kind == AttachmentKind::kRope) {
      lift(from.along, row.along);
      row.most = from.most;
      row.mass = inverse_or_0(from.mobility);
      row.push_most = from.push_mobility > 0 ? from.push_most : 0;
    } else if (!rows_.places_at_once_) {
      lift_matrix<kDimension>(from.inverse_mobility, row.inverse);
    }
  }
  write_entries(false, link, unit);
  if (rows_.sides_.b != nullptr) write_entries(true, link, unit);
}

/// All places of a side have the same particles in the same order.
template <int kDimension>
void AttachmentRecords<kDimension>::write_entries(bool of_b, spu::AttachLink& link, AttachUnit& unit) const {
  constexpr auto kCopies = kColumn<kDimension>;
  const typename Rows::Side& side = of_b ? rows_.b_ : rows_.a_;
  const AttachedBody<kDimension>& body = of_b ? *rows_.sides_.b : rows_.sides_.a;
  const auto place_of = [&](std::size_t k) { return of_b ? rows_.rows_[k].b : rows_.rows_[k].a; };
  const typename Rows::Place first = place_of(0);
  link.entries[of_b ? 1 : 0] = first.count * kCopies;
  for (std::uint32_t i = 0; i < first.count; ++i) {
    const std::uint32_t particle = side.particle[first.first + i];
    spu::AttachEntry entry{};
    entry.root = std::sqrt(kCopies * body.inverse_masses[particle]);
    for (std::size_t k = 0; k < rows_.rows_.size(); ++k)
      entry.weight[k] = side.share[place_of(k).first + i] * entry.root / kCopies;
    for (std::uint32_t copy = 0; copy < kCopies; ++copy) {
      entry.slot = particle * kCopies + copy;
      unit.entries.push_back(entry);
    }
  }
}

template <int kDimension>
void AttachmentRecords<kDimension>::read(const spu::AttachLink& link,
                                         std::span<const spu::AttachPoint> points,
                                         std::span<const spu::AttachRow> rows) {
  using Vector = typename Rows::Vector;
  SC_ASSERT(points.size() + rows.size() >= rows_.rows_.size(), "{} points and {} rows of {}", points.size(),
            rows.size(), rows_.rows_.size());
  for (typename Rows::Row& row : rows_.rows_) row.impulse.setZero();
  for (std::size_t i = 0; i < points.size(); ++i)
    rows_.rows_[i / kColumn<kDimension>].impulse += Vector::Map(points[i].impulse);
  for (std::size_t i = 0; i < rows.size(); ++i) rows_.rows_[i].impulse += Vector::Map(rows[i].impulse);
  rows_.state_.force = rows_.carried_impulse() / rows_.step_;
  rows_.broke_ = link.broke != 0;
  if (rows_.carries_all()) rows_.keep_below_break_force();
}

template class AttachmentRecords<2>;
template class AttachmentRecords<3>;

}  // namespace softcell::ppu
