#pragma once
// The memory flow controller of one SPE: it takes the SPU's DMA commands, keeps their order, moves their
// bytes when its schedule says so, and answers for tag groups.
//
//   issue() --> rules --> translation --> queue of 16 --> local store <-> main storage
//                                            |
//   write_tag_mask(), write_tag_update() --> read_tag_status()
//
// There is no clock: time passes where the SPU meets the MFC, at each call below, and as much of it as the
// schedule decides.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "softcell/dma/address_space.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/mfc_observer.h"
#include "softcell/dma/mfc_queue.h"
#include "softcell/dma/mfc_statistics.h"
#include "softcell/dma/random_stream.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/schedule.h"
#include "softcell/dma/transfer.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

/// Called by the thread that runs its SPE, and by no other. Allocates nothing but the text of faults.
class Mfc {
 public:
  /// @param local_store    kLocalStoreBytes long; must outlive the MFC, as must `space`.
  /// @param stream_number  the SPE's number: tells apart the random schedules of MFCs that never begin a job.
  /// @param listener       told when this MFC's reservation is lost, by the thread that writes; may be null.
  /// @throws std::invalid_argument  a local store of another size.
  Mfc(std::span<std::byte> local_store, AddressSpace& space, Schedule schedule,
      std::uint64_t stream_number = 0, ReservationListener* listener = nullptr);

  /// Tells `observer` of every command from now on; null: nobody. It must outlive the MFC or be replaced.
  void set_observer(MfcObserver* observer) { observer_ = observer; }

  /// State as after reset: empty queue and tag mask, no status request. What is still queued is dropped, as
  /// after a fault; call drain() at the end of a job that ended well. Random decisions from here on depend on
  /// the schedule's seed and on `job_id`, not on the SPE. Statistics go on.
  void begin_job(std::uint64_t job_id);

  /// Queues one DMA command (a write to MFC_Cmd). Its bytes may move at any time until its tag is waited for.
  /// @param command  lsa and ea in bytes; size 1, 2, 4, 8 or a multiple of 16 up to 16384 bytes; tag 0..31.
  /// @return  nothing, or the rule that the command breaks; then nothing is queued.
  /// @note    A full queue is no error: time passes until a slot is free, and the stall is counted.
  /// @note    The buffer must stay allocated until the command is complete.
  /// @source  [CBEA, MFC commands] documented
  std::optional<Fault> issue(const MfcCommand& command);

  /// Free slots of the queue, 0..16 (the channel count of MFC_Cmd). Asking takes time, so a loop
  /// that asks comes to an end.
  int free_slots();

  /// MFC_WrTagMask and MFC_RdTagMask: bit t is tag t.
  void write_tag_mask(std::uint32_t mask) { tag_mask_ = mask; }
  std::uint32_t tag_mask() const { return tag_mask_; }

  /// MFC_WrTagUpdate: asks for the status of the tags that are in the mask now.
  /// @param condition  0 immediate, which also cancels an open request; 1 any tag complete; 2 all complete.
  /// @return  nothing, or the fault tag-update-condition (another value) or tag-update-pending (1 or 2 while
  /// a
  ///          request is open).
  std::optional<Fault> write_tag_update(std::uint32_t condition);

  /// MFC_RdTagStat: completes transfers until the requested condition holds, and ends the request.
  /// @return  the requested tags that are complete; or the fault tag-status-not-requested or tag-mask-empty,
  ///          where the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_tag_status();

  /// 1 when read_tag_status() would not wait, else 0 (the channel count of MFC_RdTagStat). Asking takes time.
  int tag_status_count();

  /// MFC_RdListStallStat: completes transfers until a list has stalled, and clears the answer.
  /// @return  bit t for each tag t with a list that has stalled since the last read; or the fault
  ///          list-stall-not-expected, where the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_list_stall_status();

  /// 1 when read_list_stall_status() would not wait, else 0. Asking takes time.
  int list_stall_count();

  /// MFC_WrListStallAck: the stalled lists of this tag go on.
  /// @return  nothing, or the fault list-stall-ack-tag when no list of this tag has stalled.
  std::optional<Fault> write_list_stall_ack(std::uint32_t tag);

  /// MFC_RdAtomicStat: what the atomic commands since the last read have done: bit 4 getllar, bit 2 putlluc,
  /// bit 1 a putllc that failed; a single putllc that stored gives 0.
  /// @return  the bits; or the fault atomic-status-not-expected, where the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_atomic_status();

  /// 1 when read_atomic_status() would not wait, else 0. Asking takes time.
  int atomic_status_count();

  /// The SPU has been at a channel that is not the MFC's: time passes here as well. Under the lazy and random
  /// schedules no command stays queued for more than kMostVisits visits, calls of this class included, so
  /// that a kernel that polls memory comes to see its own puts leave.
  void visit() { pass_a_moment(); }
  static constexpr std::uint64_t kMostVisits = 256;

  /// Moves something that can move, of whatever command. To be called until it is false before the SPU sleeps
  /// at a channel: the hardware's transfers do not need the SPU.
  /// @return  false when nothing can move: the queue is empty, or all that is in it has stalled.
  bool advance();

  /// Events since the last call, as bits of SPU_RdEventStat.
  std::uint32_t take_events() { return std::exchange(events_, 0); }
  static constexpr std::uint32_t kTagStatusEvent = 0x1;  ///< TG: an open tag-status request became true
  static constexpr std::uint32_t kListStallEvent = 0x2;  ///< SN: a list has stalled
  static constexpr std::uint32_t kQueueSlotEvent = 0x8;  ///< QV: a slot became free in a full queue

  /// The fault of a list element, which is found while its command executes and suspends the queue. Every
  /// call that may return a fault returns this one first; after one that cannot, ask here. Gives it once.
  std::optional<Fault> take_fault() { return std::exchange(fault_, std::nullopt); }

  /// Completes every queued command, in an order that fences and barriers allow.
  /// @return  nothing, or why that cannot be: an element's fault, or list-stalled-for-ever.
  std::optional<Fault> drain();

  const MfcStatistics& statistics() const { return statistics_; }
  void clear_statistics() { statistics_ = {}; }

 private:
  enum class Condition : std::uint32_t { kImmediate = 0, kAny = 1, kAll = 2 };
  struct StatusRequest {
    Condition condition;
    std::uint32_t mask;
  };

  void count(const MfcCommand& command);
  bool is_met(const StatusRequest& request) const;
  std::uint32_t complete_tags(std::uint32_t mask) const { return mask & ~queue_.busy_tags(); }

  // Time passing: as much as the SPU's visit takes; until a slot of `wanted` is empty; while the SPU polls.
  void pass_a_moment();
  void complete_one_of(SlotSet wanted);
  void answer_poll(SlotSet wanted);

  void random_step(SlotSet moving);

  std::span<std::byte> local_store_;
  TranslationCache translation_;
  Schedule schedule_;
  RandomStream random_;

  MfcQueue queue_;
  std::array<Transfer, MfcQueue::kSlots> transfers_;

  std::uint32_t tag_mask_ = 0;
  std::optional<StatusRequest> request_;
  MfcStatistics statistics_;

  MfcObserver* observer_ = nullptr;
  std::uint32_t events_ = 0;
  std::optional<Fault> fault_;
};

}  // namespace softcell::dma
