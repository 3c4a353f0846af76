#pragma once
// Follows what a checked kernel does and reports what the hardware would keep silent about.
//
//   engine --loads, stores--> Checker --findings--> Findings
//   engine --channels-------> Checker ------------> the SPU's channels
//
// It keeps the architectural state, which is what a program may rely on, and not the emulator's: under any
// schedule it finds the same.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands_in_flight.h"
#include "image/object_map.h"
#include "image/object_padding.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/source_lines.h"
#include "unsynced_bytes.h"
#include "written_bytes.h"

namespace softcell::ls_sim {

class SpeTrace;

/// One for each SPE. Used by the thread that runs the SPE, except for on_external_write().
///
/// It sees no instruction fetches. That code was written and no sync followed, it finds at the first load,
/// store or channel operation of that code, or where a resident kernel calls a job that it has fetched.
class Checker final : public ChannelPort, public AccessObserver {
 public:
  /// What it stands between; all of it outlives the checker.
  struct Surroundings {
    int spe;
    std::span<const std::byte> local_store;
    ChannelPort& channels;
    const Engine& engine;  ///< knows where the kernel is
    Findings& findings;
    SpeTrace* trace = nullptr;  ///< told of each occurrence; null: nobody
  };

  explicit Checker(const Surroundings& surroundings) : to_(surroundings) {}

  /// An image was made resident, and overwrote what was there.
  void on_load() { written_.clear(); }

  /// The SPE starts: it executes what its local store holds.
  void on_start() { unsynced_.clear(); }

  /// The kernel that runs is not a checked one and fetches what may be a job's image.
  void on_unchecked_issue(const dma::MfcCommand& command);

  /// @param stack  of the image alone; within another kernel's run what is left of that one's.
  void begin_run(const KernelImage& image, const StackRange& stack);

  /// After a run that no fault has ended.
  void end_run();

  /// Any thread.
  void on_external_write(dma::LocalStoreAddress lsa, std::uint32_t bytes) {
    written_.mark_external(lsa.value, bytes);
    unsynced_.mark(lsa.value, bytes, UnsyncedBytes::kOutside);
  }

  ChannelReply read(std::uint32_t channel) override;
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override;
  ChannelReply count(std::uint32_t channel) override;
  ChannelReply issue(const dma::MfcCommand& command) override;
  void sync() override {
    unsynced_.clear();
    to_.channels.sync();
  }
  void on_access(const Access& access) override;

 private:
  using Address = dma::LocalStoreAddress;

  /// A line command whose status was not read yet, or a getllar of which nothing has come yet.
  struct LineCommand {
    dma::MfcCommand command;
    Address issued_at;
    bool line_changed = false;
  };

  void check_code(Address instruction);
  void check_fetched_code();
  void mark_unsynced(const MovedRange& range, Address writer);
  void check_store(const Access& access);
  void check_load(const Access& access);
  void check_ranges(CommandInFlight& command);
  void check_line_command(const dma::MfcCommand& command);
  void check_local_range(const dma::MfcCommand& command, const MovedRange& range, bool is_get);
  void end_reservation(const dma::MfcCommand& by);
  void complete(std::uint32_t tags);
  void on_tag_update(std::uint32_t condition);
  void on_list_stall(std::uint32_t tags);
  void on_list_acknowledged(std::uint32_t tag);

  void report(dma::Rule rule, Address place, std::string detail,
              const std::optional<dma::MfcCommand>& command = std::nullopt);
  std::string describe(const Access& access) const;
  std::string describe(const CommandInFlight& command) const;
  std::string place_of(Address instruction) const { return lines_->place_of(instruction); }

  Surroundings to_;
  const KernelImage* image_ = nullptr;
  std::unique_ptr<SourceLines> lines_;  ///< of image_
  std::optional<ObjectMap> objects_;
  std::vector<PaddingRange> padding_;

  WrittenBytes written_;
  UnsyncedBytes unsynced_;
  CommandsInFlight in_flight_;
  std::uint32_t tag_mask_ = 0;
  std::uint32_t tags_issued_ = 0;  ///< since each was last waited for
  bool is_waiting_ = false;        ///< the open tag-status request is one that waits
  std::uint64_t asked_at_ = 0;     ///< number of the last command when the request was made
  std::optional<LineCommand> status_unread_;
  std::optional<LineCommand> reservation_;
};

}  // namespace softcell::ls_sim
