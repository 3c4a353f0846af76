#pragma once
// The memory flow controller of one SPE: it queues the SPU's DMA commands, keeps their order, moves their
// bytes when the schedule says so, and reports the status of tag groups.
//
//   issue() --> rules --> translation --> queue of 16 --> local store <-> main storage
//                              |             |
//                              |             +--> read_tag_status(), read_list_stall_status(), poll_events()
//                              |
//                              +--> getllar, putllc, putlluc at once --> read_atomic_status()
//
// There is no clock: time passes at each call below, and the schedule decides how many bytes move then.

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

/// Only the thread that runs its SPE may call it, unless a function says otherwise. Allocates memory only for the text of faults.
class Mfc {
 public:
  /// @param local_store    kLocalStoreBytes long; must outlive the MFC, as must `space`.
  /// @param stream_number  the SPE's number, so that MFCs that never begin a job have different random
  ///                       schedules.
  /// @param listener       called when this MFC loses its reservation, by the thread that writes to the line;
  ///                       may be null.
  /// @throws std::invalid_argument  a local store of another size.
  /// @throws std::runtime_error     Reservations::kMaxHolders MFCs, job chains and Atomics use the address space already.
  Mfc(std::span<std::byte> local_store, AddressSpace& space, Schedule schedule,
      std::uint64_t stream_number = 0, ReservationListener* listener = nullptr);

  /// Calls `observer` for every command from now on; null: nobody. It must outlive the MFC or be replaced.
  void set_observer(MfcObserver* observer) { observer_ = observer; }

  /// Sets which part of the local store may hold instructions: see StoragePort. Without these calls, any part. Any thread may call
  /// expect_code_below().
  void confine_code(LocalStoreAddress end) { port_.confine_code(end); }
  void expect_code_below(LocalStoreAddress end) { port_.expect_code_below(end); }
  void expect_code_everywhere() { port_.expect_code_everywhere(); }
  LocalStoreAddress code_end() const { return port_.code_end(); }

  /// Sets the window through which this SPE reaches the threads of its own group (AddressWindow); without this call it has none.
  void set_window(AddressWindow window) { port_.set_window(std::move(window)); }

  /// Declares the byte order of the local store: see StoragePort. Little-endian without this call.
  void set_big_endian(bool is_big_endian) { port_.set_big_endian(is_big_endian); }
  bool is_big_endian() const { return port_.is_big_endian(); }

  /// Resets the MFC: empty queue and tag mask, no status request, no reservation. Commands that are still
  /// queued are dropped without a call of the observer; call drain() first if the last job ended without a
  /// fault. From here on, random decisions depend on the schedule's seed and on `job_id`, not on the SPE.
  /// Statistics are kept.
  void begin_job(std::uint64_t job_id);

  /// Queues one DMA command (a write to MFC_Cmd). Its bytes may move at any time until its tag is waited for.
  /// @param command  lsa, ea and size in bytes, as the rules require for its kind (docs/reference/rules.md).
  /// @return  nothing, or the rule that the command breaks; then it is not queued.
  /// @note    A full queue is no error: time passes until a slot is free, and the stall is counted. If all
  ///          queued commands wait for a list that has stalled, the fault is list-stalled-for-ever.
  /// @note    getllar, putllc and putlluc execute at once and do not wait for queued commands.
  /// @note    The buffer must stay allocated until the command is complete.
  /// @source  [CBEA, MFC commands] documented
  std::optional<Fault> issue(const MfcCommand& command);

  /// Free slots of the queue, 0..16 (the channel count of MFC_Cmd). Time passes, so that a loop that polls it
  /// ends.
  int free_slots();

  /// MFC_WrTagMask and MFC_RdTagMask: bit t is tag t.
  void write_tag_mask(std::uint32_t mask) { tag_mask_ = mask; }
  std::uint32_t tag_mask() const { return tag_mask_; }

  /// MFC_WrTagUpdate: requests the status of the tags that are in the mask now.
  /// @param condition  0 immediate, which also cancels an open request; 1 any tag complete; 2 all complete.
  /// @return  nothing, or a fault: tag-update-condition (another value), or tag-update-pending (1 or 2 while
  ///          a request is open).
  std::optional<Fault> write_tag_update(std::uint32_t condition);

  /// MFC_RdTagStat: completes transfers until the requested condition holds, and ends the request.
  /// @return  the requested tags that are complete; or the fault tag-status-not-requested or tag-mask-empty,
  ///          if the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_tag_status();

  /// 1 if read_tag_status() would not wait, else 0 (the channel count of MFC_RdTagStat). Time passes.
  int tag_status_count();

  /// MFC_RdListStallStat: completes transfers until a list has stalled, and clears the status.
  /// @return  bit t for each tag t with a list that has stalled since the last read; or the fault
  ///          list-stall-not-expected, if the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_list_stall_status();

  /// 1 if read_list_stall_status() would not wait, else 0. Time passes.
  int list_stall_count();

  /// MFC_WrListStallAck: acknowledges the stalled lists of this tag, which then continue.
  /// @return  nothing, or the fault list-stall-ack-tag if no list of this tag has stalled.
  std::optional<Fault> write_list_stall_ack(std::uint32_t tag);

  /// MFC_RdAtomicStat: the status of the last getllar, putllc or putlluc: 4 for getllar, 2 for putlluc, 1 for
  /// a putllc that failed, 0 for one that stored. A status that is not read before the next of these commands
  /// is lost.
  /// @return  the status; or the fault atomic-status-not-expected, if the hardware would wait for ever.
  std::variant<std::uint32_t, Fault> read_atomic_status();

  /// 1 if read_atomic_status() would not wait, else 0. Time passes.
  int atomic_status_count();

  /// Lets time pass: the SPU has accessed a channel of another unit. Under the lazy and random schedules a
  /// command stays queued for at most kMostVisits calls of this function and the others here, so that a
  /// kernel that polls memory sees its own puts complete. (Stalled lists, and commands that wait for them,
  /// stay queued.)
  void visit() { pass_a_moment(); }
  static constexpr std::uint64_t kMostVisits = 256;

  /// Moves some bytes of any command that can go on. Before the SPU sleeps at a channel, call this until it
  /// returns false: the hardware's transfers do not need the SPU.
  /// @return  false if nothing can move: the queue is empty, or all its commands have stalled.
  bool advance();

  /// Events since the last call, as bits of SPU_RdEventStat.
  std::uint32_t poll_events() { return std::exchange(events_, 0); }
  static constexpr std::uint32_t kTagStatusEvent = 0x1;  ///< TG: an open tag-status request became true
  static constexpr std::uint32_t kListStallEvent = 0x2;  ///< SN: a list has stalled
  static constexpr std::uint32_t kQueueSlotEvent = 0x8;  ///< QV: a slot became free in a full queue

  /// The fault of a list element, if there is one that no other call has returned. Such a fault occurs while
  /// the command executes, and suspends the queue until begin_job(). Every call that can return a fault
  /// returns this one first; call poll_fault() after one that cannot.
  std::optional<Fault> poll_fault();

  /// Completes every queued command, in an order that fences and barriers allow.
  /// @return  nothing, or the fault that prevents it: an element's, or list-stalled-for-ever.
  std::optional<Fault> drain();

  /// Checks whether threads of a host program have stored to the line that this MFC has reserved, which the hardware would notice. If they
  /// have, the reservation ends and its listener is called.
  void look_for_host_stores() { port_.look_for_host_stores(); }
  /// Whether this MFC has a reserved line that such stores may change.
  bool may_miss_host_stores() const { return port_.may_miss_host_stores(); }

  const MfcStatistics& statistics() const { return statistics_; }

 private:
  enum class Condition : std::uint32_t { kImmediate = 0, kAny = 1, kAll = 2 };
  struct StatusRequest {
    Condition condition;
    std::uint32_t mask;
  };

  /// The command in a slot of the queue; MfcQueue holds the order.
  struct QueuedCommand {
    Transfer transfer;         // of all commands but lists
    std::uint64_t number = 0;  // as passed to the observer
    std::uint64_t due = 0;     // the visit by which it must be complete
    bool started = false;      // under the random schedule: whether its destination has been poisoned
  };

  // Parts of issue():
  std::variant<Transfer, Fault> transfer_of(const MfcCommand& command, CommandKind kind);
  std::optional<Fault> execute_line_command(const MfcCommand& command);
  std::optional<Fault> enqueue(const MfcCommand& command, CommandKind kind, const Transfer& transfer);
  std::optional<Fault> transfer_at_once(const MfcCommand& command);
  void begin_at_once(const MfcCommand& command);
  void count(const MfcCommand& command, CommandKind kind);
  void notify_issue(const MfcCommand& command);

  bool is_met(const StatusRequest& request) const;
  void raise_if_met();
  std::uint32_t complete_tags(std::uint32_t mask) const { return mask & ~queue_.busy_tags(); }

  // These let time pass: for one visit of the SPU; for overdue commands; while the SPU polls.
  void pass_a_moment();
  void complete_overdue();
  void answer_poll(SlotSet wanted);

  // Moves bytes until one of `wanted`, or one tag of the mask, is complete. False if nothing that these need
  // can move.
  bool progress(SlotSet wanted);
  bool progress_any_tag(std::uint32_t mask);

  /// The slots in `slots` that wait neither for another command nor for an acknowledgement.
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
