#pragma once
// Converts a contact model to what the kernel contact_find reads.

#include <vector>

#include "contact_find_job.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

struct FindModel {
  explicit FindModel(const ContactModel& model);

  std::vector<spu::FindCell> cells;
  std::vector<spu::FindGroup> groups;
};

}  // namespace softcell::ppu
