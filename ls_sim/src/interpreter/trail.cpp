#include <algorithm>
#include <vector>

#include "run_loop.h"

namespace softcell::ls_sim::interpreter {

std::vector<std::uint32_t> Trail::last(std::uint32_t pc) const {
  std::vector<std::uint32_t> addresses;  // the latest first
  std::uint64_t jump = jumps_;
  const std::uint64_t oldest_jump = jumps_ - std::min<std::uint64_t>(jumps_, kInstructions);
  std::uint32_t at = pc;
  while (addresses.size() < kInstructions) {
    addresses.push_back(at);
    if (jump > oldest_jump && jump_[(jump - 1) % kInstructions].to == at) {
      at = jump_[--jump % kInstructions].from;
    } else if ((jump == 0 && at == start_) || at == 0) {
      break;
    } else {
      at -= 4;  // nothing but a jump leads anywhere else
    }
  }
  std::ranges::reverse(addresses);
  return addresses;
}

}  // namespace softcell::ls_sim::interpreter
