#include "ppu/contacts/find_contacts.h"

#include <Eigen/Core>
#include <cstdint>

#include "ppu/contacts/contact_terms.h"
#include "ppu/contacts/entered_face.h"
#include "ppu/surfaces/crack_sides.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr int kApartAtRest = 3;  // a point never meets cells of its own body whose middles are nearer at rest

/// A cell reaches 0.9 cells from its middle.
bool is_folded(const ContactBody& body) {
  return may_be_folded(body, 0.5f * (kApartAtRest - 0.9f) * body.spacing());
}

}  // namespace

bool may_touch_itself(const ContactBody& body) { return !body.model->crack_sides.empty() || is_folded(body); }

void find_contacts(const ContactBody& a, EndCells& cells_of_a, const ContactBody& b, EndCells& cells_of_b,
                   float step, std::vector<SoftContact>& contacts) {
  const float friction = a.friction * b.friction;
  const Lattice<3>& lattice_b = b.lattice();
  const bool itself = &a == &b;
  const ContactModel& model = *a.model;
  const auto try_point = [&](std::uint32_t cell, const TouchPoint& point) {
    const Vector3f to = point.anchor.of(a.ends);
    if (!contains(b.box, to)) return;
    const auto is_apart = [&](std::uint32_t other) {
      if (!itself) return true;  // `cell` is one of a's, so b need not have it
      const Eigen::Vector3i off = lattice_b.cells[other] - lattice_b.cells[cell];
      return off.squaredNorm() > kApartAtRest * kApartAtRest ||
             are_parted(lattice_b, model.crack_sides, cell, other);
    };
    const auto place = cells_of_b.finder().find(to, is_apart);
    if (!place) return;
    const auto way_out =
        itself ? way_out_of(b, *place, point.allowance)
               : way_out_of(b, *place, point.allowance, inner_place(*a.model, cell, a.ends) - to);
    if (!way_out) return;
    SoftContact& contact = contacts.emplace_back();
    contact.a = model.held(point.anchor);
    contact.b = b.model->held(
        anchor_in_cell(lattice_b, place->cell, opposite(b, *place, point.anchor.of(a.positions))));
    contact.point = to;
    contact.normal = way_out->normal;
    const Vector3f v = contact.a.of(a.velocities) - contact.b.of(b.velocities);
    complete(contact, way_out->distance, contact.normal.dot(v), friction, step);
  };
  const bool only_at_cracks = itself && !model.crack_sides.empty() && !is_folded(a);
  cells_of_a.boxes().for_each_meeting(b.box, [&](std::uint32_t cell) {
    if (only_at_cracks && model.crack_sides[cell] == 0) return;
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i)
      try_point(cell, model.touch_points[i]);
  });
}

}  // namespace softcell::ppu
