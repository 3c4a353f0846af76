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
#include <variant>

#include "softcell/dma/address_space.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/mfc_queue.h"
#include "softcell/dma/random_stream.h"
#include "softcell/dma/schedule.h"
#include "softcell/dma/transfer.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

/// Sums since construction or the last clear_statistics().
struct MfcStatistics {
  std::uint64_t get_commands = 0;
  std::uint64_t put_commands = 0;
  std::uint64_t get_bytes = 0;
  std::uint64_t put_bytes = 0;
  std::uint64_t queue_full_stalls = 0;  ///< commands that found no free slot
  std::uint64_t tag_waits = 0;          ///< status reads that found their condition not met yet
  int highest_queue_occupancy = 0;      ///< commands, 0..16

  std::uint64_t commands() const { return get_commands + put_commands; }
  std::uint64_t bytes() const { return get_bytes + put_bytes; }
};

/// Called by the thread that runs its SPE, and by no other. Allocates nothing but the text of faults.
class Mfc {
 public:
  /// @param local_store    kLocalStoreBytes long; must outlive the MFC, as must `space`.
  /// @param stream_number  the SPE's number: tells apart the random schedules of MFCs that never begin a job.
  /// @throws std::invalid_argument  a local store of another size.
  Mfc(std::span<std::byte> local_store, AddressSpace& space, Schedule schedule,
      std::uint64_t stream_number = 0);

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

  /// Completes every queued command, in an order that fences and barriers allow.
  void drain();

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
};

}  // namespace softcell::dma
