#pragma once

#include <memory>

#include "ppu/spe_bodies/spe_contacts.h"
#include "simulation_options.h"

namespace softcell::demos {

/// The images of the kernels with which SPEs find and solve contacts, in either dimension.
class ContactImages {
 public:
  explicit ContactImages(const SimulationOptions& options)
      : find_(options.kernel("contact_find")),
        solve_(options.kernel("contact_solve")),
        attach_(options.kernel("attach")) {}

  /// All three objects, this one too, must outlive the worker. @throws std::runtime_error  as SpeContacts
  std::shared_ptr<ppu::ContactWorker> make_worker(dma::AddressSpace& memory, ppu::JobSystem& jobs) const {
    return std::make_shared<ppu::SpeContacts>(memory, jobs, ppu::ContactKernels{find_, solve_, attach_});
  }

 private:
  ls_sim::KernelImage find_, solve_, attach_;
};

}  // namespace softcell::demos
