#include "ppu/contact_solver/attach_units.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace softcell::ppu {
namespace {

constexpr std::uint32_t kNoSide = AttachmentSides::kNone;

bool fits(const AttachUnit& unit) {
  return unit.runs.size() <= spu::kAttachMaxRuns && unit.slots <= spu::kAttachMaxSlots &&
         unit.links.size() <= spu::kAttachMaxLinks && unit.points.size() <= spu::kAttachMaxPoints &&
         unit.rows.size() <= spu::kAttachMaxRows && unit.entries.size() <= spu::kAttachMaxEntries &&
         unit.rigids.size() <= spu::kAttachMaxRigids;
}

/// The sizes of a unit's lists.
struct Extent {
  explicit Extent(const AttachUnit& unit)
      : runs(unit.runs.size()),
        links(unit.links.size()),
        points(unit.points.size()),
        rows(unit.rows.size()),
        entries(unit.entries.size()),
        rigids(unit.rigids.size()),
        slots(unit.slots),
        pushes(unit.pushes) {}
  void cut(AttachUnit& unit) const {
    unit.runs.resize(runs);
    unit.links.resize(links);
    unit.points.resize(points);
    unit.rows.resize(rows);
    unit.entries.resize(entries);
    unit.rigids.resize(rigids);
    unit.slots = slots;
    unit.pushes = pushes;
  }
  std::size_t runs, links, points, rows, entries, rigids;
  std::uint32_t slots;
  bool pushes;
};

std::uint32_t number_of(const spu::SolveRigid* rigid, AttachUnit& unit) {
  const auto found = std::ranges::find(unit.rigids, rigid);
  const auto number = static_cast<std::uint32_t>(found - unit.rigids.begin());
  if (found == unit.rigids.end()) unit.rigids.push_back(rigid);
  return number;
}

}  // namespace

void AttachUnits::begin(const AttachmentSolver<3>& attachments, RigidSets& sets) {
  for (std::size_t i = 0; i < attachments.solved(); ++i) {
    const std::uint32_t rigid = attachments.sides(i).rigid;
    if (rigid != kNoSide) sets.join(rigid, rigid);
  }
}

void AttachUnits::put_in_order(const AttachmentSolver<3>& attachments, std::size_t bodies,
                               std::size_t rigids) {
  together_.reset(bodies + rigids);
  for (std::size_t i = 0; i < attachments.solved(); ++i) {
    const AttachmentSides sides = attachments.sides(i);
    if (sides.b != kNoSide) together_.unite(sides.a, sides.b);
    if (sides.rigid != kNoSide) together_.unite(sides.a, static_cast<std::uint32_t>(bodies) + sides.rigid);
  }
  const auto set_of = [&](std::uint32_t i) { return together_.find(attachments.sides(i).a); };
  order_.resize(attachments.solved());
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::sort(order_, {}, [&](std::uint32_t i) { return std::pair(set_of(i), i); });
  first_.clear();
  for (std::uint32_t i = 0; i < order_.size(); ++i)
    if (i == 0 || set_of(order_[i]) != set_of(order_[i - 1])) first_.push_back(i);
  first_.push_back(static_cast<std::uint32_t>(order_.size()));
}

void AttachUnits::begin_unit(std::size_t first) {
  if (units_.size() == count_) units_.emplace_back();
  begins_.resize(units_.size());
  begins_[count_] = first;
  units_[count_++].clear();
}

/// Appends to the last unit. @return  false: there is no room, or the kernel cannot solve one of them; then a part of them has been
/// appended
bool AttachUnits::append(std::span<const std::uint32_t> together, const AttachmentSolver<3>& attachments,
                         const RigidSets& sets) {
  AttachUnit& unit = units_[count_ - 1];
  held_.clear();
  for (const std::uint32_t i : together) {
    const AttachmentSides sides = attachments.sides(i);
    auto point = static_cast<std::uint32_t>(unit.points.size()),
         entry = static_cast<std::uint32_t>(unit.entries.size());
    if (!attachments.write(i, unit)) return false;
    spu::AttachLink& link = unit.links.back();
    if (sides.rigid != kNoSide) {
      const std::uint32_t set = sets.set_of(sides.rigid);
      if (set == RigidSets::kNone) return false;
      link.rigid = number_of(&sets.of(set)[sets.number_in(set, sides.rigid)], unit);
    }
    for (; point < unit.points.size(); ++point)
      held_.push_back({sides.a, unit.points[point].slot, point, false});
    const std::uint32_t of_b = entry + link.entries[0];
    for (; entry < unit.entries.size(); ++entry)
      held_.push_back({entry < of_b ? sides.a : sides.b, unit.entries[entry].slot, entry, true});
    is_held_[sides.a] = true;
    if (sides.b != kNoSide) is_held_[sides.b] = true;
  }
  give_slots(unit);
  return fits(unit);
}

/// Makes runs of particles. A run also covers a few particles between the held ones.
void AttachUnits::give_slots(AttachUnit& unit) {
  constexpr std::uint32_t kFew = 12;
  std::ranges::sort(held_, {}, [](const HeldParticle& held) { return std::pair(held.body, held.particle); });
  const std::size_t runs = unit.runs.size();
  for (const HeldParticle& held : held_) {
    const bool is_near = unit.runs.size() > runs && unit.runs.back().body == held.body &&
                         held.particle < unit.runs.back().first + unit.runs.back().count + kFew;
    if (!is_near) unit.runs.push_back({held.body, held.particle, 0});
    AttachUnit::Run& run = unit.runs.back();
    const std::uint32_t longer = std::max(run.count, held.particle - run.first + 1);
    unit.slots += longer - run.count;
    run.count = longer;
    const std::uint32_t slot = unit.slots - run.count + (held.particle - run.first);
    (held.is_entry ? unit.entries[held.record].slot : unit.points[held.record].slot) = slot;
  }
}

/// Makes as few units as there is room for: starting a job takes longer than solving a few attachments.
bool AttachUnits::write(const AttachmentSolver<3>& attachments, std::size_t bodies, std::size_t rigids,
                        const RigidSets& sets) {
  count_ = 0;
  is_held_.assign(bodies, false);
  put_in_order(attachments, bodies, rigids);
  for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
    const auto together = std::span(order_).subspan(first_[s], first_[s + 1] - first_[s]);
    if (count_ == 0) begin_unit(0);
    const Extent before(units_[count_ - 1]);
    if (append(together, attachments, sets)) continue;
    before.cut(units_[count_ - 1]);
    begin_unit(first_[s]);
    if (!append(together, attachments, sets)) {
      count_ = 0;
      return false;
    }
  }
  return true;
}

void AttachUnits::read(AttachmentSolver<3>& attachments) const {
  for (std::size_t number = 0; number < count_; ++number) {
    const AttachUnit& unit = units_[number];
    std::size_t point = 0, row = 0, i = begins_[number];
    for (const spu::AttachLink& link : unit.links) {
      attachments.read(order_[i++], link, std::span(unit.points).subspan(point, link.points),
                       std::span(unit.rows).subspan(row, link.rows));
      point += link.points;
      row += link.rows;
    }
  }
}

}  // namespace softcell::ppu
