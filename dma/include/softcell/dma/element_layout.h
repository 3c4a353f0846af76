#pragma once
// The widths of a buffer's numbers if they are not all the same: an SPE of the other byte order needs them.
//
//     constexpr dma::ElementRun kRecord[] = {{16, 8}, {112, 4}};  // two addresses, then 28 words; repeated
//     dma::Buffer<Job> jobs(memory, "jobs", 24, {.record = kRecord});

#include <cstdint>
#include <span>
#include <vector>

namespace softcell::dma {

/// Numbers of one width, one after the other.
struct ElementRun {
  std::uint32_t bytes = 0;          ///< of the run; a multiple of element_bytes
  std::uint32_t element_bytes = 0;  ///< 1, 2, 4 or 8
};

/// A record of runs, which repeats from a buffer's begin to its end. Immutable; any thread.
class ElementLayout {
 public:
  /// @throws std::invalid_argument  no run, a run of 0 bytes, another width than 1, 2, 4 and 8, a run that does not begin
  ///                                or end at a multiple of its width in every repetition, a record over 2 GB.
  explicit ElementLayout(std::span<const ElementRun> record);

  /// The run at `offset` bytes from the buffer's begin, and its length from there.
  ElementRun run_at(std::uint64_t offset) const;

 private:
  struct Run {
    std::uint32_t end, element_bytes;
  };
  std::vector<Run> runs_;
};

}  // namespace softcell::dma
