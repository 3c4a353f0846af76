#pragma once
// Attachments on SPEs: writes the records of a substep to main memory, with a job of the kernel `attach` for each unit.

#include <cstdint>
#include <functional>
#include <span>

#include "attach_job.h"
#include "ppu/attachments/attach_unit.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more attachments than ever before.
class SpeAttachments {
 public:
  /// Where the velocities and pushes of a body lie.
  struct Place {
    dma::EffectiveAddress velocities;  ///< of its first particle
    std::uint32_t particles = 0;
  };

  /// `memory`, `jobs` and the kernel's image must outlive this object.
  SpeAttachments(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& attach)
      : memory_(memory), attach_(jobs.load(attach)) {}

  /// Writes what the jobs need. @param place_of  the place of a body   @param address_of  the address of a rigid body
  void hold(std::span<const AttachUnit> units, std::uint32_t iterations,
            const std::function<Place(std::uint32_t)>& place_of,
            const std::function<dma::EffectiveAddress(const spu::SolveRigid*)>& address_of);
  /// @param ends  whether the job is the unit's last one in this substep
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
  dma::Buffer<spu::AttachJob> jobs_;  // two of each unit: one, and its last one
};

}  // namespace softcell::ppu
