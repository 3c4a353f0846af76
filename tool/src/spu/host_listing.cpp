#include "host_listing.h"

#include <capstone/capstone.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "softcell/base/assert.h"

namespace softcell::tool {

std::vector<CoveredInstruction> list_host_instructions(const ls_sim::KernelImage& image,
                                                       dma::LocalStoreAddress begin,
                                                       dma::LocalStoreAddress end) {
  SC_ASSERT(image.machine == ls_sim::Machine::kHost, "{} is built for the SPU", image.name);
  SC_ASSERT(
      image.begin <= begin.value && begin.value <= end.value && end.value <= image.begin + image.bytes.size(),
      "instructions of {} from {} to {}", image.name, begin, end);
  csh disassembler = 0;
  const auto check = [&](cs_err error) {
    if (error == CS_ERR_OK) return;
    throw std::runtime_error("the instructions of " + image.name + " cannot be read: " + cs_strerror(error));
  };
  check(cs_open(CS_ARCH_X86, CS_MODE_64, &disassembler));
  const auto close = [](csh* opened) { cs_close(opened); };
  const std::unique_ptr<csh, decltype(close)> opened(&disassembler, close);
  check(cs_option(disassembler, CS_OPT_SKIPDATA, CS_OPT_ON));  // goes byte by byte over other data
  const auto release = [](cs_insn* room) { cs_free(room, 1); };
  const std::unique_ptr<cs_insn, decltype(release)> instruction(cs_malloc(disassembler), release);
  if (instruction == nullptr) check(CS_ERR_MEM);

  std::vector<CoveredInstruction> listed;
  const auto* code = reinterpret_cast<const std::uint8_t*>(image.bytes.data()) + (begin.value - image.begin);
  std::size_t left = end.value - begin.value;
  std::uint64_t address = begin.value;
  while (cs_disasm_iter(disassembler, &code, &left, &address, instruction.get())) {
    const std::string_view mnemonic = instruction->mnemonic;
    listed.push_back({.address = {static_cast<std::uint32_t>(instruction->address)},
                      .is_conditional = mnemonic.starts_with("j") && mnemonic != "jmp"});
  }
  return listed;
}

}  // namespace softcell::tool
