#pragma once
// What the plans of the kernels match and match_2d share.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/element_layout.h"

namespace softcell::ppu {

/// A line of main storage. Plans occupy whole lines, which a get moves fastest.  [CBEA, MFC commands] documented
inline constexpr std::size_t kPlanLineBytes = dma::kLineBytes;

/// The plan and state of one body need more local store than the kernel has; the message states both sizes.
class BodyTooLarge : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A plan in whole lines, ready to be copied to main memory: a `Header` and what it points to.
/// Immutable, the same bytes on every host.
template <typename Header>
class KernelPlan {
 public:
  /// Running sums start anew at every kRestart-th place of the lattice. So rounding errors are no larger than those of a short row, and a
  /// tile of a large lattice that begins at such a place gives the same bits.
  static constexpr int kRestart = 16;

  const Header& header() const {
    SC_ASSERT(!lines_.empty(), "a plan without a header");
    return *reinterpret_cast<const Header*>(lines_.data());
  }
  std::span<const std::byte> bytes() const {  ///< header() first; whole lines
    return std::as_bytes(std::span(lines_));
  }

  /// The widths of the numbers in bytes(), all of them.
  std::span<const dma::ElementRun> record() const { return record_; }

  /// Particle -> the place of its region in the plan: group number / 4, lane number % 4.
  std::span<const std::uint32_t> region_of() const { return region_of_; }

  /// How many slots are added or subtracted to compute all sums once.
  std::size_t additions() const { return additions_; }

 protected:
  void assign(const std::vector<std::byte>& bytes, std::vector<dma::ElementRun> record) {
    SC_ASSERT(bytes.size() >= sizeof(Header), "a plan of {} bytes has no room for its header", bytes.size());
    lines_.resize((bytes.size() + sizeof(Line) - 1) / sizeof(Line));
    std::memcpy(lines_.data(), bytes.data(), bytes.size());
    record_ = std::move(record);
  }

  std::vector<std::uint32_t> region_of_;
  std::size_t additions_ = 0;

 private:
  struct alignas(kPlanLineBytes) Line {
    std::byte bytes[kPlanLineBytes];
  };
  std::vector<Line> lines_;
  std::vector<dma::ElementRun> record_;
};

}  // namespace softcell::ppu
