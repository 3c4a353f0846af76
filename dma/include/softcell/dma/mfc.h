#pragma once
// The memory flow controller of one SPE: it takes the SPU's DMA commands, keeps their order, moves their
// bytes when its schedule says so, and answers for tag groups.
//
//   issue() --> rules --> translation --> queue of 16 --> local store <-> main storage
//                              |             |
//                              |             +--> read_tag_status(), read_list_stall_status(), take_events()
//                              |
//                              +--> getllar, putllc, putlluc at once --> read_atomic_status()
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
#include "softcell/dma/list_transfer.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/mfc_observer.h"
#include "softcell/dma/mfc_queue.h"
#include "softcell/dma/mfc_statistics.h"
#include "softcell/dma/random_stream.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/schedule.h"
#include "softcell/dma/storage_port.h"
#include "softcell/dma/transfer.h"

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

  /// Where gets bring instructions, as StoragePort has it; anywhere, if these are not called. The second may
  /// be called by any thread.
  void confine_code(LocalStoreAddress end) { port_.confine_code(end); }
  void expect_code_below(LocalStoreAddress end) { port_.expect_code_below(end); }
  void expect_code_everywhere() { port_.expect_code_everywhere(); }
  LocalStoreAddress code_end() const { return port_.code_end(); }

  /// State as after reset: empty queue and tag mask, no status request, no reservation. What is still queued
  /// is dropped, as after a fault, and its observer hears no more of it; call drain() at the end of a job
  /// that ended well. Random decisions from here on depend on the schedule's seed and on `job_id`, not on the
  /// SPE. Statistics go on.
  void begin_job(std::uint64_t job_id);

  /// Queues one DMA command (a write to MFC_Cmd). Its bytes may move at any time until its tag is waited for.
  /// @param command  lsa, ea and size in bytes, as its kind asks for: see check_command() in mfc_rules.h.
  /// @return  nothing, or the rule that the command breaks; then nothing is queued.
  /// @note    A full queue is no error: time passes until a slot is free, and the stall is counted. But the
  ///          fault list-stalled-for-ever is one, when all that is queued waits for a list that has stalled.
  /// @note    getllar, putllc and putlluc are done at once and wait for nothing that is queued.
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
  /// @return  nothing, or a fault: tag-update-condition (another value), or tag-update-pending (1 or 2 while
  ///          a request is open).
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

  /// MFC_RdAtomicStat: what the last getllar, putllc or putlluc has done: 4 a getllar, 2 a putlluc, 1 a
  /// putllc that failed, 0 one that stored. That of a command before it, not read until then, is lost.
  /// @return  the status; or the fault atomic-status-not-expected, where the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_atomic_status();

  /// 1 when read_atomic_status() would not wait, else 0. Asking takes time.
  int atomic_status_count();

  /// The SPU has been at a channel that is not the MFC's: time passes here as well. Under the lazy and random
  /// schedules no command stays queued for more than kMostVisits visits, calls of this class included, so
  /// that a kernel that polls memory comes to see its own puts leave. (Stalled lists, and what waits for
  /// them, stay.)
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

  /// The fault of a list element, which is found while its command executes and suspends the queue until
  /// begin_job(). Every call that may return a fault returns this one first; after one that cannot, ask here.
  /// Gives it once, whoever asked first.
  std::optional<Fault> take_fault();

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

  /// What a slot of the queue holds beside its place in the order.
  struct QueuedCommand {
    Transfer transfer;         // of all but lists
    std::uint64_t number = 0;  // as the observer counts
    std::uint64_t due = 0;     // the visit by which it is done
    bool started = false;      // under the random schedule: whether its destination is poisoned by now
  };

  // Of issue():
  std::variant<Transfer, Fault> transfer_of(const MfcCommand& command, CommandKind kind);
  std::optional<Fault> execute_line_command(const MfcCommand& command);
  std::optional<Fault> enqueue(const MfcCommand& command, CommandKind kind, const Transfer& transfer);
  std::optional<Fault> transfer_at_once(const MfcCommand& command);
  void begin_at_once(const MfcCommand& command);
  void count(const MfcCommand& command, CommandKind kind);
  void tell_issue(const MfcCommand& command);

  bool is_met(const StatusRequest& request) const;
  void tell_if_met();
  std::uint32_t complete_tags(std::uint32_t mask) const { return mask & ~queue_.busy_tags(); }

  // Time passing: as much as the SPU's visit takes; what is overdue; while the SPU polls.
  void pass_a_moment();
  void complete_overdue();
  void answer_poll(SlotSet wanted);

  // Moving on until one of `wanted`, or one tag, or the whole mask is done. False when nothing that these
  // need can move.
  bool progress(SlotSet wanted);
  bool progress_any_tag(std::uint32_t mask);

  /// Those of `slots` that neither wait for another nor for an acknowledgement.
  SlotSet movable(SlotSet slots) const {
    return suspended_by_ ? SlotSet{0} : static_cast<SlotSet>(queue_.ready(slots) & ~stalled_);
  }
  void run_all_that_can();
  void finish(int slot);
  void finish_list(int slot);
  void random_step(SlotSet moving);
  void random_list_step(int slot);
  bool open_next_element(int slot);
  void stall_or_complete(int slot);
  void complete(int slot);

  void suspend(Fault fault);
  Fault suspension();
  Fault stuck(SlotSet wanted);

  std::span<std::byte> local_store_;
  StoragePort port_;
  Schedule schedule_;
  RandomStream random_;

  MfcQueue queue_;
  std::array<QueuedCommand, MfcQueue::kSlots> commands_;
  std::array<ListTransfer, MfcQueue::kSlots> list_transfers_;
  SlotSet lists_ = 0;    // slots that hold a list
  SlotSet stalled_ = 0;  // of these, those that wait for an acknowledgement

  std::uint64_t visits_ = 0;    // while anything was queued
  std::uint64_t next_due_ = 0;  // no command is due before this visit

  std::uint32_t tag_mask_ = 0;
  std::optional<StatusRequest> request_;
  bool request_told_ = false;
  std::uint32_t stall_status_ = 0;
  std::optional<std::uint32_t> atomic_status_;

  std::uint32_t events_ = 0;
  std::optional<Fault> suspended_by_;
  bool suspension_told_ = false;

  MfcStatistics statistics_;
  MfcObserver* observer_ = nullptr;
  std::uint64_t commands_issued_ = 0;
};

}  // namespace softcell::dma
