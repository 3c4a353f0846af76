#pragma once
// SPE programs in the memory of the PPU program.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "libspe2-types.h"
#include "softcell/ls_sim/image.h"

namespace softcell::libspe2 {

/// A handle as softcell makes it, with what the documented one has no room for. `base.handle_size` says how much of
/// it there is.
struct ProgramHandle {
  spe_program_handle_t base;
  const void* checked_elf_image;  ///< the same program, with calls for its loads and stores; null: none
  const char* name;
};
static_assert(sizeof(ProgramHandle) == 40, "as softcell_embed_spu_program writes it");

/// The program whose ELF file begins there: the plain image or the checked one, as the settings ask: the checked one lies at
/// `checked_elf`, or in the file itself as softcell-spu-gcc puts it there.
/// @param name  for messages, if the file has none.
/// @param checked_elf  null: there is none besides.
/// @throws std::runtime_error  it cannot be loaded, or has no checked image.
std::shared_ptr<const ls_sim::KernelImage> program_in_memory(std::string_view name, const void* elf,
                                                             const void* checked_elf);

/// Loads the program in a file, from `offset` on; the checked image may lie in a file beside it.
/// @return  null with errno set: it cannot be read.
std::shared_ptr<const ls_sim::KernelImage> program_in_file(const std::string& path, std::uint64_t offset);

}  // namespace softcell::libspe2
