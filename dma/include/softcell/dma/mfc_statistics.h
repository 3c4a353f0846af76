#pragma once
// Counters of one MFC by kind of command.

#include <cstdint>

#include "softcell/dma/addresses.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// Sums since construction. Commands that broke a rule do not count.
struct MfcStatistics {
  /// Commands of one kind.
  struct Traffic {
    std::uint64_t commands = 0;
    std::uint64_t bytes = 0;
  };
  /// List commands of one kind.
  struct ListTraffic {
    std::uint64_t commands = 0;
    std::uint64_t elements = 0;  ///< executed so far, including those of size 0
    std::uint64_t bytes = 0;     ///< of these elements
    std::uint64_t stalls = 0;    ///< elements that stalled and notified
  };

  Traffic get;  ///< in all forms but lists
  Traffic put;  ///< puts and putr, in all forms but lists
  ListTraffic get_list;
  ListTraffic put_list;

  std::uint64_t getllar = 0;
  std::uint64_t putllc = 0;
  std::uint64_t putllc_failed = 0;  ///< of these, those whose reservation was lost
  std::uint64_t putlluc = 0;
  std::uint64_t putqlluc = 0;

  std::uint64_t signals = 0;   ///< sndsig and its forms
  std::uint64_t ordering = 0;  ///< barrier, mfceieio, mfcsync
  std::uint64_t hints = 0;     ///< sdcrt, sdcrtst, sdcrz, sdcrst, sdcrf

  std::uint64_t tag_waits = 0;          ///< reads of the tag status that had to wait
  std::uint64_t queue_full_stalls = 0;  ///< commands that had to wait for a free slot

  std::uint64_t queued_commands = 0;  ///< all commands but getllar, putllc and putlluc
  std::uint64_t occupancy_sum = 0;    ///< sum over these commands: occupied slots after each was queued
  int highest_queue_occupancy = 0;    ///< commands, 0..16

  /// Occupied slots after a command was queued, on average: 1..16, or 0 without commands.
  double mean_queue_occupancy() const {
    return queued_commands == 0 ? 0.0
                                : static_cast<double>(occupancy_sum) / static_cast<double>(queued_commands);
  }

  std::uint64_t atomics() const { return getllar + putllc + putlluc + putqlluc; }
  std::uint64_t commands() const {
    return get.commands + put.commands + get_list.commands + put_list.commands + atomics() + signals +
           ordering + hints;
  }
  /// Bytes moved between local store and main storage: those of gets, puts and lists, one line for each
  /// atomic command except a putllc that failed, and 4 for each signal.
  std::uint64_t bytes() const {
    return get.bytes + put.bytes + get_list.bytes + put_list.bytes +
           kLineBytes * (atomics() - putllc_failed) + kSignalBytes * signals;
  }

 private:
};

}  // namespace softcell::dma
