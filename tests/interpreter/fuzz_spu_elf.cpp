// libFuzzer target: any bytes give a program that fits a local store, or one sentence of refusal; and whatever the
// program does, it stays within its local store, and its undefined bits are followed.

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "interpreter/execute.h"
#include "interpreter/undefined_values.h"
#include "ls_sim/image_invariants.h"
#include "softcell/ls_sim/image.h"

namespace {

using namespace softcell;

using ls_sim::require;

void check(const ls_sim::KernelImage& image) {
  ls_sim::require_sound(image);
  require(image.entry >= image.begin && image.entry < image.sizes.end && image.entry % 4 == 0);
}

bool is_load(const ls_sim::interpreter::Operation& operation) {
  using namespace ls_sim::interpreter;
  return operation.mnemonic != Mnemonic::invalid && info_of(operation.mnemonic).kind == Kind::kLoad;
}

void run_a_while(const ls_sim::KernelImage& image) {
  constexpr int kMostInstructions = 2000;
  std::vector<std::byte> local_store(dma::kLocalStoreBytes);
  std::memcpy(local_store.data() + image.begin, image.bytes.data(), image.bytes.size());
  ls_sim::interpreter::SpuState state;
  state.pc = image.entry;
  ls_sim::interpreter::UndefinedValues undefined(ls_sim::EntryState::kLibspe2);
  for (int i = 0; i < kMostInstructions; ++i) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, local_store.data() + state.pc, sizeof bytes);
    const auto operation = ls_sim::interpreter::decode(__builtin_bswap32(bytes));
    undefined.on_instruction(operation, state.pc, state);
    if (is_load(operation)) undefined.on_load(0, {0xFF, 0x0F, 0, static_cast<std::uint8_t>(bytes)});
    const auto step = ls_sim::interpreter::execute(
        state, std::span<std::byte, dma::kLocalStoreBytes>(local_store), __builtin_bswap32(bytes));
    require((state.pc & ~ls_sim::interpreter::kInstructionMask) == 0);
    if (step.ending != ls_sim::interpreter::Ending::kNone) return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const auto image = ls_sim::load_spu_program("fuzz", {reinterpret_cast<const std::byte*>(data), size});
    check(image);
    run_a_while(image);
  } catch (const std::runtime_error& refused) {
    require(std::string(refused.what()).starts_with("SPU program fuzz: "));
  }
  return 0;
}
