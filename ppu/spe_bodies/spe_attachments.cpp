#include "ppu/spe_bodies/spe_attachments.h"

#include <algorithm>
#include <vector>

#include "ppu/spe_bodies/contact_records.h"

namespace softcell::ppu {
namespace {

/// The number of elements that this list has in all units together.
template <typename T>
std::size_t count_of(std::span<const AttachUnit> units, std::vector<T> AttachUnit::*list) {
  std::size_t count = 0;
  for (const AttachUnit& unit : units) count += (unit.*list).size();
  return count;
}

/// Appends to the buffer's content. @return  the address of the first appended element
template <typename T>
std::uint64_t append(dma::Buffer<T>& buffer, std::size_t& used, const std::vector<T>& items) {
  if (items.empty()) return 0;
  std::copy(items.begin(), items.end(), buffer.data() + used);
  const std::uint64_t address = buffer.ea(used).value;
  used += items.size();
  return address;
}

template <typename T>
std::uint32_t size_of(const std::vector<T>& items) {
  return static_cast<std::uint32_t>(items.size());
}

}  // namespace

void SpeAttachments::make_room(std::span<const AttachUnit> units) {
  ppu::make_room(memory_, "runs of attached particles", runs_, count_of(units, &AttachUnit::runs));
  ppu::make_room(memory_, "attachments", links_, count_of(units, &AttachUnit::links));
  ppu::make_room(memory_, "attached particles", points_, count_of(units, &AttachUnit::points));
  ppu::make_room(memory_, "attached places", rows_, count_of(units, &AttachUnit::rows));
  ppu::make_room(memory_, "particles of attached places", entries_, count_of(units, &AttachUnit::entries));
  ppu::make_room(memory_, "rigid bodies of attachments", rigids_, count_of(units, &AttachUnit::rigids));
  ppu::make_room(memory_, "jobs of attachments", jobs_, 2 * units.size());
}

void SpeAttachments::hold(std::span<const AttachUnit> units, std::uint32_t iterations,
                          const std::function<Place(std::uint32_t)>& place_of,
                          const std::function<dma::EffectiveAddress(const spu::SolveRigid*)>& address_of) {
  make_room(units);
  std::size_t runs = 0, links = 0, points = 0, rows = 0, entries = 0, rigids = 0;
  for (std::size_t u = 0; u < units.size(); ++u) {
    const AttachUnit& unit = units[u];
    spu::AttachJob job{};
    job.runs_ea = runs_.ea(runs).value;
    for (const AttachUnit::Run& run : unit.runs) {
      const Place place = place_of(run.body);
      runs_[runs++] = {place.velocities.value + run.first * sizeof(spu::SolveVelocity),
                       static_cast<std::uint32_t>((place.particles + 1) * sizeof(spu::SolveVelocity)),
                       run.count};
    }
    job.links_ea = append(links_, links, unit.links);
    job.points_ea = append(points_, points, unit.points);
    job.rows_ea = append(rows_, rows, unit.rows);
    job.entries_ea = append(entries_, entries, unit.entries);
    if (!unit.rigids.empty()) job.rigids_ea = rigids_.ea(rigids).value;
    for (const spu::SolveRigid* const rigid : unit.rigids) rigids_[rigids++] = {address_of(rigid).value, {}};
    job.run_count = size_of(unit.runs);
    job.link_count = size_of(unit.links);
    job.point_count = size_of(unit.points);
    job.row_count = size_of(unit.rows);
    job.entry_count = size_of(unit.entries);
    job.rigid_count = size_of(unit.rigids);
    job.iterations = iterations;
    job.pushes = unit.pushes ? 1 : 0;
    jobs_[2 * u] = job;
    job.ends = 1;
    jobs_[2 * u + 1] = job;
  }
}

Job SpeAttachments::job(std::uint32_t unit, bool ends) const {
  return {.image = attach_, .argp = jobs_.ea(2 * std::size_t{unit} + (ends ? 1 : 0))};
}

void SpeAttachments::read(std::span<AttachUnit> units) const {
  std::size_t links = 0, points = 0, rows = 0;
  const auto take = [](const auto& buffer, std::size_t& used, auto& items) {
    std::copy_n(buffer.data() + used, items.size(), items.begin());
    used += items.size();
  };
  for (AttachUnit& unit : units) {
    take(links_, links, unit.links);
    take(points_, points, unit.points);
    take(rows_, rows, unit.rows);
  }
}

}  // namespace softcell::ppu
