#pragma once
// Lays out a plan for the kernels match and match_2d.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "ppu/plans/kernel_plan.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Makes room for a header, then appends parts, each at a multiple of 16 bytes.
class PlanWriter {
 public:
  /// The header must consist of words.
  explicit PlanWriter(std::size_t header_bytes) : bytes_(header_bytes) { extend_record(sizeof(float)); }

  /// Items must be halfwords, or structures of words.
  /// @return the part's offset
  template <typename T>
  std::uint32_t append(const std::vector<T>& items) {
    static_assert(sizeof(T) == 2 || sizeof(T) % 4 == 0);
    align();
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + items.size() * sizeof(T));
    std::memcpy(bytes_.data() + offset, items.data(), items.size() * sizeof(T));
    align();
    extend_record(sizeof(T) == 2 ? 2 : 4);
    return static_cast<std::uint32_t>(offset);
  }

  /// Bytes, in whole lines.
  std::uint32_t size() const {
    return static_cast<std::uint32_t>((bytes_.size() + kPlanLineBytes - 1) / kPlanLineBytes * kPlanLineBytes);
  }

  template <typename Header>
  const std::vector<std::byte>& finish(const Header& header) {
    SC_ASSERT(sizeof header <= bytes_.size(), "a header of {} bytes in a plan of {}", sizeof header,
              bytes_.size());
    std::memcpy(bytes_.data(), &header, sizeof header);
    return bytes_;
  }

  /// The widths of the numbers in size() bytes.
  std::vector<dma::ElementRun> record() const {
    std::vector<dma::ElementRun> record = record_;
    if (size() > bytes_.size())
      record.push_back({size() - static_cast<std::uint32_t>(bytes_.size()), sizeof(float)});
    return record;
  }

 private:
  void align() { bytes_.resize((bytes_.size() + 15) / 16 * 16); }
  /// Records what was appended since the last call.
  void extend_record(std::uint32_t element_bytes) {
    const auto bytes = static_cast<std::uint32_t>(bytes_.size() - known_);
    if (bytes != 0) record_.push_back({bytes, element_bytes});
    known_ = bytes_.size();
  }

  std::vector<std::byte> bytes_;
  std::vector<dma::ElementRun> record_;
  std::size_t known_ = 0;  ///< bytes that record_ covers
};

/// The power of two at or below the spacing: a body's origin is a multiple of it.
inline float origin_grid(float spacing) {
  SC_ASSERT(spacing > 0 && std::isfinite(spacing), "a grid of cells of {} m", spacing);
  int exponent = 0;
  std::frexp(spacing, &exponent);
  return std::ldexp(1.0f, exponent - 1);
}

/// 1 / kg of the whole body.
template <typename Particles>
float inverse_body_mass(const Particles& particles) {
  double mass = 0;
  for (const auto& particle : particles) mass += static_cast<double>(particle.mass);
  return static_cast<float>(1 / mass);
}

/// @throws BodyTooLarge  the body needs more local store than `kernel` has.
inline void check_fits(const char* kernel, std::size_t particles, std::uint64_t needed,
                       std::uint32_t there_are) {
  if (needed <= there_are) return;
  throw BodyTooLarge("a soft body of " + std::to_string(particles) + " particles needs " +
                     std::to_string(needed) + " bytes of local store; the kernel " + kernel + " has " +
                     std::to_string(there_are));
}

}  // namespace softcell::ppu
