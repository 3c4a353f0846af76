#pragma once
// The records of a job of the kernel `attach`, before they are in a worker's memory.

#include <cstdint>
#include <vector>

#include "attach_job.h"

namespace softcell::ppu {

/// What attachments write into. Slots are numbers of particles until AttachUnits has given them slots.
struct AttachUnit {
  /// Particles of a body beside each other.
  struct Run {
    std::uint32_t body = 0, first = 0, count = 0;
  };
  std::vector<Run> runs;
  std::vector<spu::AttachLink> links;
  std::vector<spu::AttachPoint> points;
  std::vector<spu::AttachRow> rows;
  std::vector<spu::AttachEntry> entries;
  std::vector<const spu::SolveRigid*>
      rigids;               ///< in the worker's memory (RigidSets): those to which links are
  std::uint32_t slots = 0;  ///< of all runs
  bool pushes = false;      ///< one of the links does

  void clear() {
    runs.clear(), links.clear(), points.clear(), rows.clear(), entries.clear(), rigids.clear();
    slots = 0;
    pushes = false;
  }
};

}  // namespace softcell::ppu
