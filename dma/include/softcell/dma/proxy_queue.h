#pragma once
// The proxy command queue: DMA that the PPU side issues to an SPE's MFC.
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

/// Accepts the commands that an Mfc accepts, except lists and the line commands that answer at a channel (getllar, putllc, putlluc). It
/// also accepts puts and gets with start, which start the SPU when their bytes have moved. It has its own tag groups: its commands are not
/// ordered with those of the SPU's queue.
///
/// Any thread may call it, also the SPE's. As in an Mfc there is no clock: commands move at the calls below, as the schedule decides, and
/// stay queued for at most Mfc::kMostVisits calls. While the PPU waits for something that may need these commands, somebody must call
/// visit() or advance().
///
/// [CBEA, MFC proxy command queue] documented
class ProxyQueue : private MfcObserver {
 public:
  static constexpr int kSlots = 8;

  /// @param spe            the SPE whose local store is used; must outlive the queue, as must `space`.
  /// @param stream_number  a different number for each queue, so that their random schedules differ.
  /// @param start_spu      called without a lock by the thread that has moved the last byte of a command with
  ///                       start. Must have no effect on an SPU that runs. Not empty.
  /// @throws std::runtime_error, std::invalid_argument  as Mfc.
  ProxyQueue(LocalStorePort& spe, AddressSpace& space, Schedule schedule, std::uint64_t stream_number,
             std::function<void()> start_spu);
  ProxyQueue(const ProxyQueue&) = delete;
  ProxyQueue& operator=(const ProxyQueue&) = delete;

  /// Queues a command. If all slots are occupied, completes one first.
  /// @return  nothing, or the rule that the command breaks, one of Mfc::issue() or not-on-proxy-queue; then
  ///          it is not queued.
  std::optional<Fault> issue(const MfcCommand& command);

  /// Declares the byte order of the local store: see StoragePort.
  void set_big_endian(bool is_big_endian);

  /// The tags of `tag_mask` without a queued command (Prxy_TagStatus). Time passes.
  std::uint32_t complete_tags(std::uint32_t tag_mask);

  /// Completes the commands of all, or of at least one, of the tags. @return  as complete_tags().
  std::uint32_t wait_all(std::uint32_t tag_mask);
  std::uint32_t wait_any(std::uint32_t tag_mask);

  /// The fault of a queued command, if a host program has unmapped its bytes since it was issued. All commands queued at that time are
  /// dropped, and count as complete.
  std::optional<Fault> poll_fault();

  /// Number of commands that can be queued without waiting, 0..8 (MFC_QStatus). Time passes.
  int free_slots();

  /// Lets time pass. Costs one atomic load if nothing is queued.
  void visit();

  /// Moves some bytes. @return  false if nothing is queued.
  bool advance();

 private:
  enum class Condition : std::uint32_t { kImmediate = 0, kAny = 1, kAll = 2 };

  // Called by the MFC, with the mutex held.
  void on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) override;
  void on_complete(std::uint64_t number) override;
  void on_reservation_lost(std::uint64_t number) override;

  template <class Step>
  auto with_mfc(Step&& step) -> decltype(step());
  void drop_all(Fault&& why);
  std::uint32_t tag_status(std::uint32_t tag_mask, Condition condition);

  LocalStorePort& spe_;
  std::function<void()> start_spu_;

  std::mutex mutex_;  // guards all below
  Mfc mfc_;
  std::atomic<int> queued_{0};  // also read without the mutex
  bool issuing_start_ = false;
  std::vector<std::uint64_t> starting_;  // the numbers of the queued commands with start
  int starts_due_ = 0;
  std::optional<Fault> failure_;
};

}  // namespace softcell::dma
