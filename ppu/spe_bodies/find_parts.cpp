#include "ppu/spe_bodies/find_parts.h"

#include <algorithm>

#include "ppu/spe_bodies/contact_records.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::uint16_t kNone = 0xFFFF;
const Bounds<3> kNowhere{Eigen::Vector3f::Constant(1e30f), Eigen::Vector3f::Constant(-1e30f)};

Bounds<3> box_of(const spu::FindBoxes* boxes, std::size_t cell) {
  const spu::FindBoxes& four = boxes[cell / 4];
  const std::size_t lane = cell % 4;
  return {{four.low_x[lane], four.low_y[lane], four.low_z[lane]},
          {four.high_x[lane], four.high_y[lane], four.high_z[lane]}};
}

/// The cells whose boxes have a point in common with `box`, ascending.
void find_near(const FindParts::Body& body, const Bounds<3>& box, std::vector<std::uint16_t>& near) {
  using Four = Eigen::Map<const Eigen::Array4f>;
  near.clear();
  for (std::size_t first = 0; first < body.cells.size(); first += 4) {
    const spu::FindBoxes& four = body.boxes[first / 4];
    const Eigen::Array4f apart = (Four(four.low_x) - box.high.x())
                                     .max(box.low.x() - Four(four.high_x))
                                     .max(Four(four.low_y) - box.high.y())
                                     .max(box.low.y() - Four(four.high_y))
                                     .max(Four(four.low_z) - box.high.z())
                                     .max(box.low.z() - Four(four.high_z));
    if (apart.minCoeff() > 0) continue;
    const std::size_t count = std::min<std::size_t>(4, body.cells.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (apart[static_cast<Eigen::Index>(lane)] <= 0)
        near.push_back(static_cast<std::uint16_t>(first + lane));
  }
}

Bounds<3> box_around(const FindParts::Body& body, std::span<const std::uint16_t> cells) {
  Bounds<3> around = box_of(body.boxes, cells[0]);
  for (const std::uint16_t cell : cells.subspan(1)) {
    const Bounds<3> box = box_of(body.boxes, cell);
    around.low = around.low.cwiseMin(box.low);
    around.high = around.high.cwiseMax(box.high);
  }
  return around;
}

Bounds<3> in_common(const Bounds<3>& a, const Bounds<3>& b) {
  return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}

std::size_t points_of(const FindParts::Body& body, std::uint16_t cell) {
  std::size_t points = 0;
  for (const spu::FindGroup& group :
       body.groups.subspan(body.cells[cell].first_group, body.cells[cell].group_count))
    for (const float allowance : group.allowance) points += allowance < spu::kFindNoPoint / 2 ? 1 : 0;
  return points;
}

/// How many of these cells, from the first on, have no more points in all than a part may have, as each point makes at most one contact.
std::size_t first_ones(const FindParts::Body& body, std::span<const std::uint16_t> cells) {
  std::size_t count = 0, points = 0;
  for (; count < cells.size() && count < spu::kFindMaxNear; ++count) {
    points += points_of(body, cells[count]);
    if (points > spu::kFindMaxContacts) break;
  }
  return count;
}

}  // namespace

void FindParts::clear() {
  parts_.clear();
  cells_.clear();
  particles_.clear();
}

bool FindParts::add(const Body& a, const Body& b, const Bounds<3>& common) {
  const std::size_t parts = parts_.size(), cells = cells_.size(), particles = particles_.size();
  if (add_points_of(a, b, true, common) && add_points_of(b, a, false, common)) return true;
  parts_.resize(parts);
  cells_.resize(cells);
  particles_.resize(particles);
  return false;
}

bool FindParts::add_points_of(const Body& mine, const Body& other, bool mine_is_a, const Bounds<3>& common) {
  find_near(other, common, near_);
  if (near_.empty()) return true;
  find_near(mine, in_common(common, box_around(other, near_)), mine_);
  std::erase_if(mine_, [&](std::uint16_t cell) { return mine.cells[cell].group_count == 0; });
  std::span<const std::uint16_t> left = mine_;
  while (!left.empty()) {
    std::size_t count = first_ones(mine, left);
    const std::size_t cells = cells_.size(), particles = particles_.size();
    for (;; count /= 2) {
      if (count == 0) return false;
      find_near(other, box_around(mine, left.first(count)), near_);
      if (near_.empty()) break;
      if (near_.size() > spu::kFindMaxNear) continue;
      const Selection points = select_points(mine, left.first(count));
      Selection others = select_near(other, near_);
      if (bytes_of(points) + bytes_of(others) <= spu::kFindMaxBytes) {
        add_rest(others, spu::kFindMaxBytes - bytes_of(points));
        parts_.push_back(mine_is_a ? Part{points, others} : Part{others, points});
        break;
      }
      cells_.resize(cells);
      particles_.resize(particles);
    }
    left = left.subspan(count);
  }
  return true;
}

FindParts::Selection FindParts::select_points(const Body& body, std::span<const std::uint16_t> cells) {
  Selection selection = select_cells(body, cells);
  selection.with_points = true;
  mark_cells(selection);
  for (const std::uint16_t cell : cells) {
    selection.group_count += body.cells[cell].group_count;
    const std::uint16_t inner = body.cells[cell].inner_cell;
    if (cell_number_[inner] != spu::kFindNoCell) continue;
    cell_number_[inner] = 0;
    cells_.push_back(inner);
  }
  selection.cell_count = cells_.size() - selection.first_cell;
  select_particles(selection);
  return selection;
}

FindParts::Selection FindParts::select_near(const Body& body, std::span<const std::uint16_t> cells) {
  Selection selection = select_cells(body, cells);
  select_particles(selection);
  return selection;
}

FindParts::Selection FindParts::select_cells(const Body& body, std::span<const std::uint16_t> cells) {
  Selection selection;
  selection.body = body;
  selection.first_cell = cells_.size();
  selection.cell_count = selection.near_count = cells.size();
  selection.first_particle = particles_.size();
  cells_.insert(cells_.end(), cells.begin(), cells.end());
  return selection;
}

void FindParts::select_particles(Selection& selection) {
  SC_ASSERT(selection.first_cell + selection.cell_count == cells_.size(),
            "cells {} to {} of {} are not those of the last selection", selection.first_cell,
            selection.first_cell + selection.cell_count, cells_.size());
  number_.assign(selection.body.ends.size(), kNone);
  for (const std::uint16_t cell : cells_of(selection)) {
    for (const std::uint16_t particle : selection.body.cells[cell].corner) {
      if (number_[particle] != kNone) continue;
      number_[particle] = 0;
      particles_.push_back(particle);
    }
  }
  selection.particle_count = particles_.size() - selection.first_particle;
}

void FindParts::add_rest(Selection& selection, std::size_t most_bytes) {
  SC_ASSERT(selection.first_cell + selection.cell_count == cells_.size(),
            "cells {} to {} of {} are not those of the last selection", selection.first_cell,
            selection.first_cell + selection.cell_count, cells_.size());
  const std::size_t cell_count = selection.cell_count;
  mark_cells(selection);
  for (std::size_t cell = 0; cell < selection.body.cells.size(); ++cell)
    if (cell_number_[cell] == spu::kFindNoCell) cells_.push_back(static_cast<std::uint16_t>(cell));
  selection.cell_count = cells_.size() - selection.first_cell;
  if (bytes_of(selection) <= most_bytes) return;
  selection.cell_count = cell_count;
  cells_.resize(selection.first_cell + cell_count);
}

std::span<const std::uint16_t> FindParts::cells_of(const Selection& selection) const {
  return std::span(cells_).subspan(selection.first_cell, selection.cell_count);
}

void FindParts::mark_cells(const Selection& selection) {
  cell_number_.assign(selection.body.cells.size(), spu::kFindNoCell);
  std::uint16_t number = 0;
  for (const std::uint16_t cell : cells_of(selection)) cell_number_[cell] = number++;
}

void FindParts::set_counts(const Selection& selection, spu::FindBody& body) {
  body.cell_count = static_cast<std::uint32_t>(selection.cell_count);
  body.group_count = static_cast<std::uint32_t>(selection.group_count);
  body.particle_count = static_cast<std::uint32_t>(selection.particle_count);
}

std::uint32_t FindParts::bytes_of_state(const Selection& selection) {
  spu::FindBody body{};
  set_counts(selection, body);
  return spu::find_state_bytes(body);
}

std::uint32_t FindParts::bytes_of(const Selection& selection) {
  spu::FindBody body{};
  set_counts(selection, body);
  return spu::find_model_bytes(body) + spu::find_state_bytes(body);
}

void FindParts::write() {
  std::size_t cells = 0, groups = 0, state = 0;
  for (Part& part : parts_) {
    for (Selection* const selection : {&part.a, &part.b}) {
      selection->cells_at = cells;
      selection->groups_at = groups;
      selection->state_at = state;
      cells += selection->cell_count;
      groups += selection->group_count;
      state += bytes_of_state(*selection) / sizeof(spu::FindEnd);
    }
  }
  make_room(memory_, "cells of parts in contact", part_cells_, cells);
  make_room(memory_, "points of parts in contact", part_groups_, groups);
  make_room(memory_, "parts in contact", part_state_, state);
  for (const Part& part : parts_) write(part.a), write(part.b);
}

void FindParts::write(const Selection& selection) {
  const Body& body = selection.body;
  number_.assign(body.ends.size(), kNone);
  const std::size_t groups_of_boxes = (selection.cell_count + 3) / 4;
  auto* const boxes = reinterpret_cast<spu::FindBoxes*>(part_state_.data() + selection.state_at);
  auto* const ends = reinterpret_cast<spu::FindEnd*>(boxes + groups_of_boxes);
  auto* const begins = reinterpret_cast<spu::FindBegin*>(ends + selection.particle_count);
  for (std::size_t p = 0; p < selection.particle_count; ++p) {
    const std::uint16_t particle = particles_[selection.first_particle + p];
    number_[particle] = static_cast<std::uint16_t>(p);
    ends[p] = body.ends[particle];
    begins[p] = body.begins[particle];
  }
  mark_cells(selection);
  const std::span<const std::uint16_t> numbers = cells_of(selection);
  spu::FindGroup* group = part_groups_.data() + selection.groups_at;
  std::size_t groups = 0;
  for (std::size_t c = 0; c < 4 * groups_of_boxes; ++c) {
    const std::size_t last_one = std::min(c, numbers.size() - 1);
    const bool is_near = last_one < selection.near_count;
    const Bounds<3> box = is_near ? box_of(body.boxes, numbers[last_one]) : kNowhere;
    set_box(boxes[c / 4], c % 4, box.low, box.high);
    if (c >= numbers.size()) continue;
    spu::FindCell& cell = part_cells_[selection.cells_at + c];
    cell = body.cells[numbers[c]];
    for (std::uint16_t& corner : cell.corner) corner = number_[corner];
    cell.inner_cell = cell_number_[cell.inner_cell];
    const std::uint16_t first = cell.first_group;
    cell.first_group = static_cast<std::uint16_t>(groups);
    if (!selection.with_points || !is_near) cell.group_count = 0;
    group = std::copy_n(body.groups.begin() + first, cell.group_count, group);
    groups += cell.group_count;
  }
}

void FindParts::describe(const Selection& selection, spu::FindBody& body) const {
  body.cells_ea = part_cells_.ea(selection.cells_at).value;
  body.groups_ea = selection.group_count == 0 ? 0 : part_groups_.ea(selection.groups_at).value;
  body.state_ea = part_state_.ea(selection.state_at).value;
  set_counts(selection, body);
}

void FindParts::describe(std::size_t part, spu::FindBody& a, spu::FindBody& b) const {
  SC_ASSERT(part < parts_.size(), "part {} of {}", part, parts_.size());
  describe(parts_[part].a, a);
  describe(parts_[part].b, b);
}

void FindParts::restore(std::size_t part, spu::SolveContact& contact) const {
  SC_ASSERT(part < parts_.size(), "a contact of part {} of {}", part, parts_.size());
  const auto restore_side = [&](const Selection& selection, spu::SolveAnchor& anchor, std::uint16_t& cell) {
    // The slot of zeros follows all particles.
    for (std::uint16_t& particle : anchor.particle)
      particle = particle < selection.particle_count ? particles_[selection.first_particle + particle]
                                                     : static_cast<std::uint16_t>(selection.body.ends.size());
    if (cell != spu::kSolveNoCell) cell = cells_[selection.first_cell + cell];
  };
  restore_side(parts_[part].a, contact.a, contact.cell_a);
  restore_side(parts_[part].b, contact.b, contact.cell_b);
}

}  // namespace softcell::ppu
