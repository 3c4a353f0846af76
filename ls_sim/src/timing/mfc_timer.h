#pragma once
// When the commands of one MFC are complete.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "element_interconnect.h"
#include "port_use.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::ls_sim {

/// Computes the end of each command at its issue. The MFC's schedule decides when bytes move, not this class.
/// Used by the thread that runs the SPE.
class MfcTimer {
 public:
  MfcTimer(int spe, ElementInterconnect& interconnect, PortUse& port, const TimingParameters& parameters)
      : spe_(spe), interconnect_(interconnect), port_(port), parameters_(parameters) {}

  /// The completion time of a command that waits for an acknowledgement.
  static constexpr std::uint64_t kNotYet = std::numeric_limits<std::uint64_t>::max();

  /// Begins a run, with nothing queued, as Mfc::begin_job() does.
  void begin_run();

  /// When there is room for another command. @param now  of the SPE
  std::uint64_t slot_free(std::uint64_t now) const;

  /// A legal command enters the queue at `now`.
  /// @param local_store  holds the list of a list command. @param is_big_endian  its byte order.
  /// @return  its end, or kNotYet.
  std::uint64_t issue(const dma::MfcCommand& command, std::uint64_t now,
                      std::span<const std::byte> local_store, bool is_big_endian);

  /// MFC_WrListStallAck: lists of this tag that have stalled go on.
  void acknowledge(std::uint32_t tag, std::uint64_t now, std::span<const std::byte> local_store,
                   bool is_big_endian);

  /// When all commands of these tags, or of the first of them to be so, are complete. 0: they are; never kNotYet.
  std::uint64_t all_complete(std::uint32_t tags) const;
  std::uint64_t any_complete(std::uint32_t tags) const;
  /// When lists of these tags have stalled, all of those that have.
  std::uint64_t lists_stalled(std::uint32_t tags) const;
  /// The end of the last getllar, putllc or putlluc.
  std::uint64_t atomic_complete() const { return atomic_; }

  const TransferCounts& counts() const { return counts_; }

 private:
  struct Entry {
    std::uint32_t tag;
    std::uint64_t issued, complete;
    bool is_barrier;
  };
  struct StalledList {
    dma::MfcCommand command;
    std::uint32_t next;     ///< element
    std::uint64_t stalled;  ///< when
    std::uint64_t issued;
  };
  /// Lines that are requested one after the other. Times are in cycles.
  struct Stream {
    std::uint64_t request;       ///< the earliest time of the next request
    std::uint64_t complete = 0;  ///< when the last line so far is complete
    std::uint64_t first = 0;     ///< when the first line is complete
    std::uint64_t lines = 0;
  };

  std::uint64_t start_of(const dma::MfcCommand& command, std::uint64_t now) const;
  std::uint64_t run(const dma::MfcCommand& command, std::uint64_t now, std::span<const std::byte> local_store,
                    bool is_big_endian);
  void move(Stream& stream, bool is_get, dma::EffectiveAddress ea, std::uint32_t bytes);
  /// @return  the end, or kNotYet if an element stalls.
  std::uint64_t run_list(const dma::MfcCommand& command, std::uint32_t from, Stream& stream,
                         std::uint64_t issued, std::span<const std::byte> local_store, bool is_big_endian);
  void use_port(const Stream& stream);

  const int spe_;
  ElementInterconnect& interconnect_;
  PortUse& port_;
  const TimingParameters& parameters_;

  std::vector<Entry> queue_;  ///< also commands that are complete, until the next look
  std::vector<StalledList> stalled_;
  std::uint64_t queue_barrier_ = 0;  ///< later commands start then, at the earliest
  std::array<std::uint64_t, dma::kTagCount> list_stalls_{};
  std::array<std::uint64_t, 64> lines_{};  ///< ends of the last lines, in a ring
  std::uint64_t lines_asked_ = 0;
  std::uint64_t atomic_ = 0;
  TransferCounts counts_;
};

}  // namespace softcell::ls_sim
