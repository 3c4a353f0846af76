#pragma once
// Work for the kernel attach, for measuring its stack and its time.

#include <cmath>
#include <cstdint>

#include "attach_job.h"
#include "body_samples.h"
#include "ppu/spe_bodies/contact_records.h"

namespace softcell::tool {

/// Attachments of one kind in a body of some particles.
class AttachSample {
 public:
  AttachSample(dma::AddressSpace& memory, std::uint32_t particles)
      : particles_(particles),
        changes_(ppu::contact_buffer<spu::SolveVelocity>(memory, "changes", spu::solve_slots(particles))),
        runs_(ppu::contact_buffer<spu::AttachRun>(memory, "run", 1)),
        links_(ppu::contact_buffer<spu::AttachLink>(memory, "links", spu::kAttachMaxLinks)),
        points_(ppu::contact_buffer<spu::AttachPoint>(memory, "points", spu::kAttachMaxPoints)),
        rows_(ppu::contact_buffer<spu::AttachRow>(memory, "rows", spu::kAttachMaxRows)),
        entries_(ppu::contact_buffer<spu::AttachEntry>(memory, "entries", spu::kAttachMaxEntries)),
        rigid_(ppu::contact_buffer<spu::SolveRigid>(memory, "rigid body", 1)),
        rigids_(ppu::contact_buffer<spu::AttachRigid>(memory, "rigid bodies", 1)),
        job_(ppu::contact_buffer<spu::AttachJob>(memory, "job", 1)) {
    rigid_[0].inverse_mass = 0.1f;
    for (int d = 0; d < 3; ++d) rigid_[0].inverse_inertia[d][d] = 1;
    rigids_[0].rigid_ea = rigid_.ea().value;
    runs_[0] = {changes_.ea().value, (particles + 1) * 16, particles};
    job_[0].runs_ea = runs_.ea().value;
    job_[0].links_ea = links_.ea().value;
    job_[0].points_ea = points_.ea().value;
    job_[0].rows_ea = rows_.ea().value;
    job_[0].entries_ea = entries_.ea().value;
    job_[0].rigids_ea = rigids_.ea().value;
    job_[0].run_count = job_[0].rigid_count = job_[0].pushes = job_[0].ends = 1;
    job_[0].iterations = 4;
  }

  /// Adds an attachment of all particles. @param breaks  under almost no impulse   @param once  as for AttachLink::once
  void add(spu::AttachKind kind, bool to_rigid, bool breaks, bool once = false) {
    spu::AttachJob& job = job_[0];
    spu::AttachLink& link = links_[job.link_count++];
    link.kind = kind;
    link.rigid = to_rigid ? 0 : spu::kAttachNoRigid;
    link.pushes = 1;
    link.breaks = breaks ? 1 : 0;
    link.once = once ? 1 : 0;
    link.most_impulse = 1e-4f;
    link.most_push[0] = link.most_push[1] = 0.5f;
    link.inverse_sum = 0.05f;
    for (int k = 0; k < 4; ++k) link.inverse[k][k] = link.inverse_of_pushes[k][k] = 0.5f;
    for (int d = 0; d < 3; ++d) link.inverse_inertia[d][d] = 0.2f;
    if (kind == spu::kAttachPoints) {
      link.points = particles_;
      for (std::uint32_t i = 0; i < particles_; ++i) {
        spu::AttachPoint& point = points_[job.point_count++];
        point.carried[1] = point.error[1] = 1;
        point.arm[0] = 0.1f * static_cast<float>(i);
        point.mass = point.push_mass = point.weight = 1;
        point.slot = i;
      }
      return;
    }
    link.rows = kind == spu::kAttachPlaces ? 4 : kind == spu::kAttachHinge ? 2 : 1;
    link.entries[0] = particles_;
    for (std::uint32_t k = 0; k < link.rows; ++k) {
      spu::AttachRow& row = rows_[job.row_count++];
      row.carried[1] = row.error[1] = row.along[1] = 1;
      row.most = row.push_most = -1;
      row.mass = row.push_mass = 1;
      for (int d = 0; d < 3; ++d) row.inverse[d][d] = 0.5f;
    }
    for (std::uint32_t i = 0; i < particles_; ++i) {
      spu::AttachEntry& entry = entries_[job.entry_count++];
      for (std::uint32_t k = 0; k < link.rows; ++k)
        entry.weight[k] = 1 / std::sqrt(static_cast<float>(particles_ + k));
      entry.root = 1;
      entry.slot = i;
    }
  }

  dma::EffectiveAddress job() const { return job_.ea(); }

 private:
  std::uint32_t particles_;
  dma::Buffer<spu::SolveVelocity> changes_;
  dma::Buffer<spu::AttachRun> runs_;
  dma::Buffer<spu::AttachLink> links_;
  dma::Buffer<spu::AttachPoint> points_;
  dma::Buffer<spu::AttachRow> rows_;
  dma::Buffer<spu::AttachEntry> entries_;
  dma::Buffer<spu::SolveRigid> rigid_;
  dma::Buffer<spu::AttachRigid> rigids_;
  dma::Buffer<spu::AttachJob> job_;
};

/// Runs all kinds, also with attachments that break; then the timed work, a weld of 20 particles to a rigid body.
inline void run_attach(SampleRun& sample) {
  AttachSample all(sample.memory(), 20), weld(sample.memory(), 20);
  for (const spu::AttachKind kind :
       {spu::kAttachPoints, spu::kAttachPlaces, spu::kAttachHinge, spu::kAttachRope})
    for (const bool breaks : {false, true}) all.add(kind, kind != spu::kAttachPlaces, breaks);
  weld.add(spu::kAttachPoints, true, false, true);
  sample.run(all.job());
  sample.begin_timing();
  sample.run(weld.job(), 20);
}

}  // namespace softcell::tool
