// Fuzz target: an SPU program of the input's words, executed by the interpreter and by the model. They must
// agree after each instruction, and nothing outside the emulated local store may be touched.
//
// The first 64 bytes are four registers, which all registers repeat; the rest is code, from address 0 on,
// again and again until the local store is full.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "spu_model/operands.h"
#include "spu_model/twins.h"

namespace softcell::spu_model {
namespace {

constexpr int kInstructions = 500;
constexpr std::size_t kRegisters = 4;

void require_nothing(const std::string& difference) {
  if (difference.empty()) return;
  std::fprintf(stderr, "%s\n", difference.c_str());
  std::abort();
}

void run(std::span<const std::uint8_t> input) {
  static Twins twins;
  std::array<Quadword, kRegisters> registers;
  for (std::size_t i = 0; i < kRegisters * 16; ++i)
    registers[i / 16].bytes[i % 16] = i < input.size() ? input[i] : 0;
  for (std::uint32_t number = 0; number < 128; ++number)
    twins.set_register(number, registers[number % kRegisters]);

  const auto code = input.subspan(std::min(input.size(), kRegisters * 16));
  std::vector<std::uint8_t> local_store(kLocalStoreLimit + 1);
  // Whole words, so that the code's words repeat as such; each copy doubles what is there.
  std::size_t filled = code.size() & ~std::size_t{3};
  std::copy_n(code.begin(), filled, local_store.begin());
  while (filled != 0 && filled < local_store.size()) {
    const std::size_t more = std::min(filled, local_store.size() - filled);
    std::memcpy(local_store.data() + filled, local_store.data(), more);
    filled += more;
  }
  twins.set_memory(0, local_store);
  twins.set_pc(0);
  twins.set_srr0(0);
  twins.set_interrupts(false);
  twins.set_fpscr({});

  for (int i = 0; i < kInstructions; ++i) {
    const std::uint32_t pc = twins.model().pc;
    if (is_undefined(twins.model().fetch(pc))) {
      twins.set_pc(pc + 4);
      continue;
    }
    require_nothing(twins.step());
    if (twins.model().pc == pc) twins.set_pc(pc + 4);  // an invalid word, or a branch to itself
  }
  require_nothing(twins.difference());
}

}  // namespace
}  // namespace softcell::spu_model

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  softcell::spu_model::run({data, size});
  return 0;
}
