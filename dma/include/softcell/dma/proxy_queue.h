#pragma once
// DMA that the PPU side has an SPE's MFC do: the second, smaller command queue.
//
//   PPU   issue(gets, tag 3) --> queue of 8 --> local store <-> main storage --> start_spu()
//         wait_all(1 << 3)  <-- complete

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "softcell/dma/fault.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/dma/mfc.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/schedule.h"

namespace softcell::dma {

/// Takes everything that an Mfc takes but lists and the line commands that answer at a channel (getllar,
/// putllc, putlluc), and puts and gets with start, which lets the SPU run once their bytes have moved. Its
/// tag groups are its own: no order reaches from here to the SPU's queue.
///
/// Any thread, the SPE's too. As in an Mfc there is no clock: commands move at the calls below, as the
/// schedule decides, and none stays queued for more than Mfc::kMostVisits of them. Somebody must call visit()
/// or advance() as long as the PPU waits for something else, which may need these commands.
///
/// [CBEA, MFC proxy command queue] documented
class ProxyQueue : private MfcObserver {
 public:
  static constexpr int kSlots = 8;

  /// @param spe            whose local store it is; must outlive the queue, as must `space`.
  /// @param stream_number  tells apart the random schedules of several queues.
  /// @param start_spu      called, with no lock held, by the thread that has moved the last byte of a command
  ///                       with start; to have no effect on an SPU that runs.
  /// @throws std::runtime_error, std::invalid_argument  as Mfc.
  ProxyQueue(LocalStorePort& spe, AddressSpace& space, Schedule schedule, std::uint64_t stream_number,
             std::function<void()> start_spu);
  ProxyQueue(const ProxyQueue&) = delete;
  ProxyQueue& operator=(const ProxyQueue&) = delete;

  /// Queues a command. With all slots taken, completes one first.
  /// @return  nothing, or the rule that it breaks, and then nothing is queued: those of Mfc::issue(), or
  ///          not-on-proxy-queue.
  std::optional<Fault> issue(const MfcCommand& command);

  /// Those of these tags that have no command queued (Prxy_TagStatus). Asking takes time.
  std::uint32_t complete_tags(std::uint32_t tag_mask);

  /// Completes the commands of all, or of at least one, of these tags. @return  as complete_tags().
  std::uint32_t wait_all(std::uint32_t tag_mask);
  std::uint32_t wait_any(std::uint32_t tag_mask);

  /// Room for this many commands, 0..8 (MFC_QStatus). Asking takes time.
  int free_slots();

  /// Time passes. Costs one atomic load when nothing is queued.
  void visit();

  /// Moves something. @return  false when nothing is queued.
  bool advance();

 private:
  enum class Condition : std::uint32_t { kImmediate = 0, kAny = 1, kAll = 2 };

  // Called by the MFC, with the mutex held.
  void on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) override;
  void on_complete(std::uint64_t number) override;
  void on_reservation_lost(std::uint64_t number) override;

  template <class Step>
  auto with_mfc(Step&& step);
  std::uint32_t tag_status(std::uint32_t tag_mask, Condition condition);

  LocalStorePort& spe_;
  std::function<void()> start_spu_;

  std::mutex mutex_;  // guards all below
  Mfc mfc_;
  std::atomic<int> queued_{0};  // read without the mutex too
  bool issuing_start_ = false;
  std::vector<std::uint64_t> starting_;  // the numbers of the queued commands with start
  int starts_due_ = 0;
};

}  // namespace softcell::dma
