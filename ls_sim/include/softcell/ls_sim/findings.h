#pragma once
// Findings: the mistakes of checked kernels, each once, with its count.

#include <cstdint>
#include <mutex>
#include <vector>

#include "softcell/dma/fault.h"

namespace softcell::ls_sim {

/// Whether both break the same rule in the same kernel at the same place; SPE, addresses and details may
/// differ.
bool is_same_mistake(const dma::Fault& a, const dma::Fault& b);

/// A mistake that the checker has found, once for each rule, kernel and source line.
struct Finding {
  dma::Fault fault;         ///< of its first occurrence
  std::uint64_t count = 0;  ///< occurrences with the same rule, kernel and source line, on any SPE
};

/// Collects findings. Thread safe.
class Findings {
 public:
  /// Counts an occurrence.
  void add(const dma::Fault& fault);

  /// All findings, sorted by rule, kernel and source line, so that the list does not depend on the order of
  /// threads.
  std::vector<Finding> list() const;
  bool empty() const;
  /// The number of findings in list().
  std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Finding> findings_;
};

}  // namespace softcell::ls_sim
