#pragma once
// The records of a job of the kernel `attach`, before they are copied to a worker's memory.

#include <cstdint>
#include <vector>

#include "attach_job.h"

namespace softcell::ppu {

/// Records that attachments append. Slots hold particle numbers until AttachUnits replaces them by slots.
struct AttachUnit {
  /// Successive particles of a body.
  struct Run {
    std::uint32_t body = 0, first = 0, count = 0;
  };
  std::vector<Run> runs;
  std::vector<spu::AttachLink> links;
  std::vector<spu::AttachPoint> points;
  std::vector<spu::AttachRow> rows;
  std::vector<spu::AttachEntry> entries;
  /// In the worker's memory (RigidSets): those that links refer to.
  std::vector<const spu::SolveRigid*> rigids;
  std::uint32_t slots = 0;  ///< number of slots in all runs
  bool pushes = false;      ///< at least one link pushes

  void clear() {
    runs.clear(), links.clear(), points.clear(), rows.clear(), entries.clear(), rigids.clear();
    slots = 0;
    pushes = false;
  }
};

}  // namespace softcell::ppu
