#pragma once
// The commands of which a program cannot know yet that they are complete. That is not when the emulator moves
// their bytes: a command is in flight from its issue until a tag status was read that includes it, or one
// that includes a command which fences or barriers order behind it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "softcell/dma/mfc_command.h"

namespace softcell::ls_sim {

/// Bytes that a command moves from one place to one other.
struct MovedRange {
  std::uint32_t lsa = 0;
  std::uint64_t ea = 0;
  std::uint32_t bytes = 0;
};

struct CommandInFlight {
  dma::MfcCommand command;
  dma::LocalStoreAddress issued_at = {};  ///< the instruction
  std::uint64_t number = 0;               ///< in order of issue, from 1 up

  bool writes_local_store = false;
  bool writes_main_storage = false;
  std::vector<MovedRange> ranges = {};  ///< of a list: those of the elements that may move now

  // Of a list command: its elements that may move from this one up to the next that stalls.
  std::uint32_t first_element = 0;
  std::uint32_t next_element = 0;      ///< behind these
  dma::LocalStoreAddress cursor = {};  ///< where the next one's bytes lie
  bool has_stalled = false;            ///< and waits for its acknowledgement

  std::vector<std::uint64_t> behind =
      {};  ///< numbers of the commands that are complete before this one starts

  bool is_list() const { return command.kind() == dma::CommandKind::kList; }
  /// Elements are left behind one that stalls; the last one never does.
  bool can_stall() const { return is_list() && next_element < command.size / dma::kListElementBytes; }
};

/// What a command moves, for as many elements of a list as go before the next stall. Reads the list from the
/// local store.
void add_ranges(CommandInFlight& command, std::span<const std::byte> local_store);

class CommandsInFlight {
 public:
  void clear();

  /// Fills in its number and what it is ordered behind.
  CommandInFlight& add(CommandInFlight command);

  /// A tag status said so: commands of these tags up to that number are complete.
  void complete(std::uint32_t tags, std::uint64_t up_to);

  std::uint64_t last_number() const { return last_number_; }
  std::vector<CommandInFlight>& all() { return commands_; }

  /// The first command that has such bytes of the local store for its destination or its source.
  const CommandInFlight* writing(std::uint32_t lsa, std::uint32_t bytes) const;
  const CommandInFlight* reading(std::uint32_t lsa, std::uint32_t bytes) const;
  /// The first list command whose elements, of those that may move, lie there.
  const CommandInFlight* listing(std::uint32_t lsa, std::uint32_t bytes) const;
  /// The first command that shares bytes with this one, at least one of the two writing them, and is not
  /// ordered.
  const CommandInFlight* conflicting(const CommandInFlight& command) const;

 private:
  std::vector<CommandInFlight> commands_;
  std::uint64_t last_number_ = 0;
};

}  // namespace softcell::ls_sim
