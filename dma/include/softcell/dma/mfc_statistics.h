#pragma once
// What one MFC has done, counted by kind of command.

#include <cstdint>

namespace softcell::dma {

/// Sums since construction or the last clear_statistics(). Refused commands are not counted.
struct MfcStatistics {
  struct Traffic {
    std::uint64_t commands = 0;
    std::uint64_t bytes = 0;
  };
  struct ListTraffic {
    std::uint64_t commands = 0;
    std::uint64_t elements = 0;  ///< executed so far, those of size 0 too
    std::uint64_t bytes = 0;     ///< of these elements
    std::uint64_t stalls = 0;    ///< elements that stalled and notified
  };

  Traffic get;  ///< in all forms but lists
  Traffic put;  ///< puts and putr, in all forms but lists
  ListTraffic get_list;
  ListTraffic put_list;

  std::uint64_t getllar = 0;
  std::uint64_t putllc = 0;
  std::uint64_t putllc_failed = 0;  ///< of these, how many found their reservation lost
  std::uint64_t putlluc = 0;
  std::uint64_t putqlluc = 0;

  std::uint64_t signals = 0;   ///< sndsig and its forms
  std::uint64_t ordering = 0;  ///< barrier, mfceieio, mfcsync
  std::uint64_t hints = 0;     ///< sdcrt, sdcrtst, sdcrz, sdcrst, sdcrf

  std::uint64_t tag_waits = 0;          ///< status reads that found their condition not met yet
  std::uint64_t queue_full_stalls = 0;  ///< commands that found no free slot

  std::uint64_t queued_commands = 0;  ///< that went through the queue: all but getllar, putllc and putlluc
  std::uint64_t occupancy_sum = 0;    ///< over the queued commands: slots taken once each was in
  int highest_queue_occupancy = 0;    ///< commands, 0..16

  /// Slots taken once a command was in the queue, on average: 0, or 1..16.
  double mean_queue_occupancy() const {
    return queued_commands == 0 ? 0.0
                                : static_cast<double>(occupancy_sum) / static_cast<double>(queued_commands);
  }

  std::uint64_t atomics() const { return getllar + putllc + putlluc + putqlluc; }
  std::uint64_t commands() const {
    return get.commands + put.commands + get_list.commands + put_list.commands + atomics() + signals +
           ordering + hints;
  }
  /// Bytes that crossed between local store and main storage: those of gets, puts and lists, a line for each
  /// atomic command but a putllc that failed, and 4 for each signal.
  std::uint64_t bytes() const {
    return get.bytes + put.bytes + get_list.bytes + put_list.bytes +
           kAtomicBytes * (atomics() - putllc_failed) + kSignalBytes * signals;
  }

 private:
  static constexpr std::uint64_t kAtomicBytes = 128;
  static constexpr std::uint64_t kSignalBytes = 4;
};

}  // namespace softcell::dma
