#pragma once
// The checker: observes a checked kernel and reports mistakes about which the hardware is silent.
//
//   engine --loads, stores--> Checker --findings--> Findings
//   engine --channels-------> Checker ------------> the SPU's channels
//
// It models the state that a program may rely on, not that of the emulator, so that it finds the same under
// every schedule.

#include <array>
#include <atomic>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "commands_in_flight.h"
#include "heap_blocks.h"
#include "image/object_map.h"
#include "program_places.h"
#include "softcell/base/assert.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/findings.h"
#include "unsynced_bytes.h"
#include "written_bytes.h"

namespace softcell::ls_sim {

class SpeTrace;

/// One for each SPE. Used by the thread that runs the SPE, except for on_external_write().
///
/// It sees each instruction of a program for the SPU, but not those of a kernel built for the host. There it detects code that was written
/// without a following sync at the first load, store or channel operation of that code, or when a resident kernel calls a job that it has
/// fetched.
class Checker final : public ChannelPort, public AccessObserver {
 public:
  /// What the checker observes and reports to; all of it outlives the checker.
  struct Surroundings {
    int spe;
    std::span<const std::byte> local_store;
    ChannelPort& channels;
    const Engine& engine;  ///< knows where the kernel is
    Findings& findings;
    SpeTrace* trace = nullptr;  ///< told of each occurrence; null: nobody
  };

  explicit Checker(const Surroundings& surroundings) : to_(surroundings), places_(surroundings.local_store) {
    SC_ASSERT(to_.local_store.size() == dma::kLocalStoreBytes, "SPE {} has a local store of {} bytes",
              to_.spe, to_.local_store.size());
  }

  /// An image was loaded, and overwrote the local store.
  void on_load() { written_.clear(); }

  /// The SPE starts: it executes what its local store contains.
  void on_start() { unsynced_.clear(); }

  /// A kernel that is not checked issues a command, which may fetch a job's image.
  void on_unchecked_issue(const dma::MfcCommand& command);

  /// @param stack  the image's stack; for a job, the part of the resident kernel's stack that is free, too.
  /// @param forgets  if true, everything that the last run wrote counts as unwritten; else only its stack.
  void begin_run(const KernelImage& image, const StackRange& stack, bool forgets = true);

  /// Call after a run that ended without a fault.
  void end_run();

  /// Any thread.
  void on_external_write(dma::LocalStoreAddress lsa, std::uint32_t bytes) {
    written_.mark_external(lsa.value, bytes);
    unsynced_.mark(lsa.value, bytes, UnsyncedBytes::kOutside);
  }

  /// The PPU side has a pointer to the local store, through which it may write unseen from now on. Any thread.
  void on_shared() { is_shared_.store(true, std::memory_order_relaxed); }

  ChannelReply read(std::uint32_t channel) override;
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override;
  ChannelReply count(std::uint32_t channel) override;
  ChannelReply issue(const dma::MfcCommand& command) override;
  void sync() override {
    unsynced_.clear();
    to_.channels.sync();
  }
  bool stop(std::uint32_t code, dma::LocalStoreAddress assist) override {
    return to_.channels.stop(code, assist);
  }
  void on_access(const Access& access) override;
  void on_heap_block(const Access& block, bool is_freed) override;
  void on_instruction(const ExecutedInstruction& instruction) override;
  UndefinedBits undefined_bits(dma::LocalStoreAddress quadword) override;
  void on_host_access(dma::LocalStoreAddress lsa, std::uint32_t bytes, bool is_store) override;

 private:
  using Address = dma::LocalStoreAddress;

  /// A line command whose status was not read yet, or a getllar that no putllc or putlluc has followed.
  struct LineCommand {
    dma::MfcCommand command;
    Address issued_at;
    bool line_changed = false;
    bool status_is_there = false;  ///< as its channel's count has said
  };

  /// A store of an SPU program, which writes a whole quadword: the bytes that were there.
  struct QuadwordStore {
    std::uint32_t lsa = 0;
    Address writer = {};
    std::array<std::byte, dma::kQuadwordBytes> before = {};
    std::uint16_t put_bytes = 0;  ///< bit b: byte b is on its way to main storage
    std::string put_detail = {};  ///< of the finding if such a byte changes
  };

  void begin_channel_operation();
  void check_code(Address instruction);
  void mark_changed_words();
  void check_fetched_code();
  void mark_unsynced(const MovedRange& range, Address writer);
  bool is_written(std::uint32_t lsa, std::uint32_t bytes);
  void find_unseen_writes(std::uint32_t lsa, std::uint32_t bytes);
  std::string trespass_of(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t stack_pointer) const;
  void check_store(const Access& access);
  const CommandInFlight* get_beside(const Access& access) const;
  bool is_put_of_a_part(const CommandInFlight& put, std::uint32_t quadword) const;
  void watch_bytes_of_put(const Access& store);
  void check_load(const Access& access);
  void report_undefined(const ExecutedInstruction& instruction);
  void check_ranges(CommandInFlight& command);
  void check_overlaps(const CommandInFlight& command);
  void check_line_command(const CommandInFlight& line);
  void check_local_range(const dma::MfcCommand& command, const MovedRange& range, bool is_get);
  void end_reservation(const dma::MfcCommand& by);
  void check_frames(Address here, std::uint32_t stack_pointer);
  void complete(std::uint32_t tags);
  void on_tag_update(std::uint32_t condition);
  void report_idle_waits();
  void on_tag_status();
  void on_list_stall(std::uint32_t tags);
  void on_list_acknowledged(std::uint32_t tag);

  void report(dma::Rule rule, Address place, std::string detail,
              const std::optional<dma::MfcCommand>& command = std::nullopt);
  bool check_load_in_flight(const Access& access);
  bool is_in_unread_line(const Access& access) const;
  std::string describe(const Access& access) const;
  std::string describe(const CommandInFlight& command) const;
  std::string describe(const LineCommand& line) const;
  bool runs_spu_program() const { return image_ != nullptr && image_->machine == Machine::kSpu; }

  Surroundings to_;
  const KernelImage* image_ = nullptr;
  ProgramPlaces places_;
  std::optional<ObjectMap> objects_;

  WrittenBytes written_;
  std::atomic<bool> is_shared_ = false;
  UnsyncedBytes unsynced_;
  HeapBlocks heap_;
  CommandsInFlight in_flight_;
  std::uint32_t tag_mask_ = 0;
  std::uint32_t tags_issued_ = 0;  ///< the tags of all commands of this run
  /// Waits for tags of which there was no command yet, by instruction and mask: the stack pointer of the first.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> idle_waits_;
  bool stack_is_in_flight_ = false;  ///< a command may move variables of functions
  bool stack_overflow_known_ = false;
  std::uint32_t stack_pointer_ = 0;  ///< of the access or channel operation that is being looked at
  bool is_waiting_ = false;          ///< the open tag-status request is one that waits
  std::uint32_t awaited_ = 0;   ///< the tags that it waits for, all of them; 0: it waits for any of several
  std::uint64_t asked_at_ = 0;  ///< number of the last command when the request was made
  std::optional<QuadwordStore> last_store_;  ///< not yet looked at
  std::optional<LineCommand> status_unread_;
  std::optional<LineCommand> reservation_;
};

}  // namespace softcell::ls_sim
