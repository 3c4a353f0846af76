#include "ppu/contacts/contact_body.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ppu/surfaces/crack_sides.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// For each particle: the first cell that has it, and the corner as xi.
std::vector<std::pair<std::uint32_t, Eigen::Vector3f>> homes_of_particles(const Lattice<3>& lattice) {
  std::vector<std::pair<std::uint32_t, Eigen::Vector3f>> homes(lattice.particles.size());
  for (std::uint32_t cell = static_cast<std::uint32_t>(lattice.cells.size()); cell-- > 0;)
    for (unsigned k = 0; k < 8; ++k)
      homes[lattice.corners[cell][k]] = {cell, Eigen::Vector3i(k & 1u, k >> 1 & 1u, k >> 2).cast<float>()};
  return homes;
}

/// Does not count as a holder of the model.
std::shared_ptr<const Lattice<3>> part_of(const SoftBodyModel<3>& model) {
  return {std::shared_ptr<const void>(), &model.lattice()};
}

}  // namespace

ContactModel::ContactModel(std::shared_ptr<const SoftBodyModel<3>> shared)
    : surface((SC_ASSERT(shared != nullptr, "contacts of a body without a model"), shared->mesh()),
              shared->lattice()),
      model_(std::move(shared)),
      lattice_(part_of(*model_)),
      masses_(model_->masses()),
      own_count_(lattice_->cells.size()) {
  weigh();
  place_touch_points();
  inner_places = find_inner_places(surface, lattice());
}

ContactModel::ContactModel(std::shared_ptr<const SoftBodyModel<3>> piece, const ContactModel& whole)
    : surface(whole.surface, piece->lattice(), piece->mesh(), piece->cracks()),
      model_(std::move(piece)),
      lattice_(part_of(*model_)),
      masses_(model_->masses()),
      own_count_(lattice_->cells.size()) {
  SC_ASSERT(model_->whole() == whole.model(), "a piece of {} particles of another body of {}",
            model_->particles(), whole.masses().size());
  weigh();
  place_touch_points();
  inner_places = find_inner_places(surface, lattice());
  crack_sides = ppu::crack_sides(lattice(), model_->cracks());
}

ContactModel::ContactModel(const FlatLayer& layer)
    : surface(layer.surface()),
      crack_sides(layer.crack_sides().begin(), layer.crack_sides().end()),
      lattice_(layer.lattice()),
      own_masses_(layer.masses().begin(), layer.masses().end()),
      masses_(own_masses_),
      margin_cells_(layer.margin_cells().begin(), layer.margin_cells().end()),
      own_count_(layer.own_cells()) {
  weigh();
  place_touch_points();
  inner_places = find_inner_places(layer);
}

/// Impulses never act on a particle without a mass, so any number will do for it.
void ContactModel::weigh() {
  double sum = 0;
  for (const float mass : masses_) {
    sum += double{mass};
    inverse_masses.push_back(mass > 0 ? 1 / mass : 1);
    root_masses.push_back(mass > 0 ? std::sqrt(mass) : 1);
  }
  mass_ = model_ != nullptr ? model_->mass() : static_cast<float>(sum);
  measure_thickness();
}

void ContactModel::measure_thickness() {
  Eigen::Array3i low = lattice().cells[0].array(), high = low;
  for (const Eigen::Vector3i& cell : lattice().cells) {
    low = low.min(cell.array());
    high = high.max(cell.array());
  }
  const Eigen::Array3i cells = high - low + 1;
  thickness_ =
      lattice().spacing * static_cast<float>(is_flat() ? cells.head<2>().minCoeff() : cells.minCoeff());
}

Anchor ContactModel::held(const Anchor& anchor) const {
  if (anchor.cell == Anchor::kNoCell || !is_margin(anchor.cell)) return anchor;
  Eigen::Vector3f xi = margin_cells_[anchor.cell].off;
  for (unsigned k = 0; k < 8; ++k)
    for (unsigned d = 0; d < 3; ++d)
      if ((k >> d & 1u) != 0) xi[d] += anchor.share[k];
  return anchor_in_cell(lattice(), margin_cells_[anchor.cell].beside, xi);
}

std::optional<std::uint32_t> ContactModel::cell_at(const Eigen::Vector3f& place) const {
  // Both parts of the list ascend.
  const std::span<const Eigen::Vector3i> cells(lattice().cells);
  if (const auto own = ppu::cell_at(cells.first(own_count_), place)) return own;
  const auto margin = ppu::cell_at(cells.subspan(own_count_), place);
  return margin ? std::optional(static_cast<std::uint32_t>(*margin + own_count_)) : std::nullopt;
}

/// In each cell, points of the surface come before particles.
void ContactModel::place_touch_points() {
  const auto homes = homes_of_particles(lattice());
  first_of_cell.assign(lattice().cells.size() + 1, 0);
  for (const SurfacePointAtRest& point : surface.points()) ++first_of_cell[point.cell + 1];
  for (const TouchingParticle& touching : surface.particles())
    ++first_of_cell[homes[touching.particle].first + 1];
  for (std::size_t i = 1; i < first_of_cell.size(); ++i) first_of_cell[i] += first_of_cell[i - 1];
  touch_points.resize(first_of_cell.back());
  std::vector<std::uint32_t> next(first_of_cell.begin(), first_of_cell.end() - 1);
  for (const SurfacePointAtRest& point : surface.points())
    touch_points[next[point.cell]++] = {anchor_in_cell(lattice(), point.cell, point.xi), point.xi, 0};
  first_particle_of_cell = next;
  for (const TouchingParticle& touching : surface.particles()) {
    const auto& [cell, xi] = homes[touching.particle];
    touch_points[next[cell]++] = {anchor_in_cell(lattice(), cell, xi), xi,
                                  touching.allowance * lattice().spacing};
  }
}

Anchor anchor_in_cell(const Lattice<3>& lattice, std::uint32_t cell, const Eigen::Vector3f& xi) {
  Anchor anchor;
  anchor.cell = cell;
  anchor.particle = lattice.corners[cell];
  for (unsigned k = 0; k < 8; ++k) {
    float share = 1;
    for (unsigned d = 0; d < 3; ++d) share *= ((k >> d) & 1u) != 0 ? xi[d] : 1 - xi[d];
    anchor.share[k] = share;
  }
  return anchor;
}

/// Uses the rotation to which the cells' edges point on average. Any rotation would prove it.
bool may_be_folded(const ContactBody& body, float most) {
  using Eigen::Vector3f;
  const Lattice<3>& lattice = body.lattice();
  Vector3f x = Vector3f::Zero(), y = Vector3f::Zero(), centre = Vector3f::Zero(), rest = Vector3f::Zero();
  for (const auto& corner : lattice.corners) {
    x += body.ends[corner[1]] - body.ends[corner[0]] + body.ends[corner[7]] - body.ends[corner[6]];
    y += body.ends[corner[2]] - body.ends[corner[0]] + body.ends[corner[7]] - body.ends[corner[5]];
  }
  for (std::size_t i = 0; i < body.ends.size(); ++i) {
    centre += body.ends[i];
    rest += lattice.rest_position(i);
  }
  centre /= static_cast<float>(body.ends.size());
  rest /= static_cast<float>(body.ends.size());
  const Vector3f z = x.cross(y);
  if (!(z.norm() > 0)) return true;
  Eigen::Matrix3f turn;
  turn.col(0) = x.normalized();
  turn.col(2) = z.normalized();
  turn.col(1) = turn.col(2).cross(turn.col(0));
  for (std::size_t i = 0; i < body.ends.size(); ++i) {
    const Vector3f off = body.ends[i] - centre - turn * (lattice.rest_position(i) - rest);
    if (off.squaredNorm() > most * most) return true;
  }
  return false;
}

void stiffen(ContactBody& body, std::uint32_t cell, float share) {
  using Eigen::Vector3f;
  const auto& corners = body.lattice().corners[cell];
  const std::span<const float> masses = body.model->masses();
  float mass = 0;
  for (const std::uint32_t k : corners) mass += masses[k];
  // Lengths in cells and masses as shares give the same numbers at every scale. Places and velocities are taken relative to the first
  // corner: sums of large numbers would lose digits.
  const Vector3f first = body.positions[corners[0]], carried = body.velocities[corners[0]];
  const auto from_first = [&](std::uint32_t k) -> Vector3f {
    return (body.positions[k] - first) / body.spacing();
  };
  Vector3f centre = Vector3f::Zero(), velocity = Vector3f::Zero();
  for (const std::uint32_t k : corners) {
    centre += masses[k] / mass * from_first(k);
    velocity += masses[k] / mass * (body.velocities[k] - carried);
  }
  const auto arm = [&](std::uint32_t k) -> Vector3f { return from_first(k) - centre; };
  Eigen::Matrix3f inertia = Eigen::Matrix3f::Zero();
  Vector3f spin = Vector3f::Zero();
  for (const std::uint32_t k : corners) {
    const Vector3f r = arm(k);
    spin += masses[k] / mass * r.cross(body.velocities[k] - carried);
    inertia += masses[k] / mass * (r.squaredNorm() * Eigen::Matrix3f::Identity() - r * r.transpose());
  }
  // A cell that is pressed to a line cannot turn about it, so a little is added to its inertia. The turn that this takes away is given
  // back, so that the missing spin is of second order.
  constexpr float kLittle = 0x1.0p-13f;
  inertia.diagonal().array() += kLittle;
  const Eigen::Matrix3f inverse = inertia.inverse();
  const Vector3f omega = inverse * (spin + kLittle * (inverse * spin));
  if (!omega.allFinite()) return;  // stretched to over 10^6 of its size: the determinant overflows
  for (const std::uint32_t k : corners) {
    body.velocities[k] += share * (velocity + omega.cross(arm(k)) - (body.velocities[k] - carried));
  }
}

Eigen::Vector3f inner_place(const ContactModel& model, std::uint32_t cell,
                            std::span<const Eigen::Vector3f> positions) {
  const CellPlace& inner = model.inner_places[cell];
  return anchor_in_cell(model.lattice(), inner.cell, inner.xi).of(positions);
}

void ContactBody::hold(std::uint32_t particle, const Eigen::Vector3f& velocity, float most_impulse) {
  SC_ASSERT(!asleep && particle < positions.size(), "particle {} of {} is held, of a body that sleeps or not",
            particle, positions.size());
  if (inverse_masses_if_held.empty())
    inverse_masses_if_held.assign(inverse_masses.begin(), inverse_masses.end());
  held_velocities.resize(positions.size());
  held_impulses.resize(positions.size());
  held_impulses[particle] = holds(particle) ? std::max(held_impulses[particle], most_impulse) : most_impulse;
  inverse_masses_if_held[particle] = 0;
  held_velocities[particle] = velocity;
}

bool ContactBody::holds(const Anchor& anchor) const {
  if (inverse_masses_if_held.empty()) return false;
  for (std::size_t k = 0; k < 8; ++k)
    if (anchor.share[k] != 0 && holds(anchor.particle[k])) return true;
  return false;
}

float ContactBody::most_impulse_if_held(const Anchor& anchor) const {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < 8; ++k)
    if (anchor.share[k] != 0 && holds(anchor.particle[k]))
      least = std::min(least, held_impulses[anchor.particle[k]]);
  return least;
}

Eigen::Vector3f ContactBody::velocity_if_held(const Anchor& anchor) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 8; ++k) {
    const std::uint32_t particle = anchor.particle[k];
    sum += anchor.share[k] * (holds(particle) ? held_velocities : velocities)[particle];
  }
  return sum;
}

}  // namespace softcell::ppu
