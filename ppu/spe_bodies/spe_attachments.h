#pragma once
// Attachments on SPEs, by the kernel `attach`: the records of a substep in main memory, and a job for each unit.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "attach_job.h"
#include "ppu/contacts/attach_unit.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more attachments than ever before.
class SpeAttachments {
 public:
  /// Where a body's velocities and pushes are.
  struct Place {
    dma::EffectiveAddress velocities;  ///< of its first particle
    std::uint32_t particles = 0;
  };

  /// `memory`, `jobs` and the kernel's image outlive this.
  SpeAttachments(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& attach)
      : memory_(memory), attach_(jobs.load(attach)) {}

  /// Writes what jobs need. @param place_of  of a body   @param address_of  of a rigid body
  void hold(std::span<const AttachUnit> units, std::uint32_t iterations,
            const std::function<Place(std::uint32_t)>& place_of,
            const std::function<dma::EffectiveAddress(const spu::SolveRigid*)>& address_of);
  /// @param ends  it is the unit's last one in this substep
  Job job(std::uint32_t unit, bool ends) const;
  void read(std::span<AttachUnit> units) const;

 private:
  void make_room(std::span<const AttachUnit> units);

  dma::AddressSpace& memory_;
  JobImage attach_;
  dma::Buffer<spu::AttachRun> runs_;
  dma::Buffer<spu::AttachLink> links_;
  dma::Buffer<spu::AttachPoint> points_;
  dma::Buffer<spu::AttachRow> rows_;
  dma::Buffer<spu::AttachEntry> entries_;
  dma::Buffer<spu::AttachRigid> rigids_;
  dma::Buffer<spu::AttachJob> jobs_;  // of each unit: one, and its last one
};

}  // namespace softcell::ppu
