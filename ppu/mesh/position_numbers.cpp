#include "ppu/mesh/position_numbers.h"

#include <array>
#include <bit>
#include <unordered_map>

#include "ppu/numbers/hash_of_numbers.h"

namespace softcell::ppu {

std::vector<std::uint32_t> number_positions(std::span<const Eigen::Vector3f> positions) {
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, HashOfNumbers> known;
  std::vector<std::uint32_t> numbers;
  for (const Eigen::Vector3f& p : positions) {
    std::array<std::uint32_t, 3> bits;  // + 0 makes -0 and 0 the same
    for (int d = 0; d < 3; ++d) bits[static_cast<std::size_t>(d)] = std::bit_cast<std::uint32_t>(p[d] + 0.0f);
    numbers.push_back(known.try_emplace(bits, static_cast<std::uint32_t>(known.size())).first->second);
  }
  return numbers;
}

}  // namespace softcell::ppu
