#pragma once
// The commands in flight: those of which a program cannot know that they are complete. It does not matter
// when the emulator moves their bytes. A command is in flight from its issue until the program reads a tag
// status that includes it, or that includes a command which fences or barriers order behind it.

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

  // Of a list command. Its elements that may move are those from first_element up to the next that stalls.
  std::uint32_t first_element = 0;
  std::uint32_t next_element = 0;      ///< the first element after these
  dma::LocalStoreAddress cursor = {};  ///< where the bytes of next_element lie
  bool has_stalled = false;            ///< the list waits for the program's acknowledgement

  bool frame_was_left = false;  ///< it moves a variable of a function that has returned

  /// Numbers of the commands that complete before this one starts.
  std::vector<std::uint64_t> behind = {};

  /// sdcrz writes main storage only.
  bool moves_local_store() const { return command.kind() != dma::CommandKind::kCacheHint; }
  bool is_list() const { return command.kind() == dma::CommandKind::kList; }
  /// Whether the list may stall before its end: it has elements after those that may move. The last element never stalls.
  bool can_stall() const { return is_list() && next_element < command.size / dma::kListElementBytes; }
};

/// Adds the ranges that a command moves; for a list, those of its elements up to the next stall. Reads the
/// list from the local store.
/// @param is_big_endian  the byte order of the local store, in which a list lies.
void add_ranges(CommandInFlight& command, std::span<const std::byte> local_store, bool is_big_endian);

class CommandsInFlight {
 public:
  void clear();

  /// Adds a command, and sets its number and the commands that it is ordered behind.
  /// @return  a reference that is valid until the next call.
  CommandInFlight& add(CommandInFlight command);

  /// Removes the commands of these tags up to number `up_to`: a tag status has reported them complete.
  /// @pre  up_to <= last_number()
  void complete(std::uint32_t tags, std::uint64_t up_to);

  std::uint64_t last_number() const { return last_number_; }
  std::vector<CommandInFlight>& all() { return commands_; }

  /// The first command whose destination (writing) or source (reading) includes such bytes of the local
  /// store, or null.
  const CommandInFlight* writing(std::uint32_t lsa, std::uint32_t bytes) const;
  const CommandInFlight* reading(std::uint32_t lsa, std::uint32_t bytes) const;
  /// The first list command whose list elements lie there and may still be read, or null.
  const CommandInFlight* listing(std::uint32_t lsa, std::uint32_t bytes) const;
  /// The first command that shares bytes with this one, of which at least one writes, and that nothing
  /// orders; or null. A line command, which is no command in flight, is ordered behind nothing.
  const CommandInFlight* conflicting(const CommandInFlight& command) const;

 private:
  std::vector<CommandInFlight> commands_;
  std::uint64_t last_number_ = 0;
};

}  // namespace softcell::ls_sim
