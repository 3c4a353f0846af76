#include "commands_in_flight.h"

#include <algorithm>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/list_transfer.h"

namespace softcell::ls_sim {
namespace {

template <typename Number>
bool overlap(Number a, std::uint32_t a_bytes, Number b, std::uint32_t b_bytes) {
  return a < b + b_bytes && b < a + a_bytes;
}

bool touches(const CommandInFlight& command, std::uint32_t lsa, std::uint32_t bytes) {
  return command.moves_local_store() &&
         std::any_of(command.ranges.begin(), command.ranges.end(),
                     [&](const MovedRange& range) { return overlap(range.lsa, range.bytes, lsa, bytes); });
}

/// Whether fences and barriers let `later` start only when `earlier` is complete.
bool is_ordered(const dma::MfcCommand& earlier, const dma::MfcCommand& later) {
  if (earlier.is_queue_barrier() || later.is_queue_barrier()) return true;
  return earlier.tag == later.tag && (later.has_fence() || later.has_barrier() || earlier.has_barrier());
}

/// A putqlluc that stores into a line, and a line command that looks at it again: who takes a lock that it has just given up begins
/// anew until it sees that.
bool gives_up_a_lock(const CommandInFlight& earlier, const CommandInFlight& later) {
  return earlier.command.kind() == dma::CommandKind::kQueuedLine &&
         later.command.kind() == dma::CommandKind::kLine;
}

bool contains(const std::vector<std::uint64_t>& sorted, std::uint64_t number) {
  return std::binary_search(sorted.begin(), sorted.end(), number);
}

}  // namespace

void add_ranges(CommandInFlight& in_flight, std::span<const std::byte> local_store, bool is_big_endian) {
  const dma::MfcCommand& command = in_flight.command;
  switch (command.kind()) {
    case dma::CommandKind::kTransfer:
      in_flight.ranges.push_back({command.lsa.value, command.ea.value, command.size});
      return;
    case dma::CommandKind::kLine:
    case dma::CommandKind::kQueuedLine:
      in_flight.ranges.push_back({command.lsa.value, command.ea.value, dma::kLineBytes});
      return;
    case dma::CommandKind::kSignal:
      in_flight.ranges.push_back({command.lsa.value, command.ea.value, dma::kSignalBytes});
      return;
    case dma::CommandKind::kCacheHint: {
      constexpr std::uint64_t kLineMask = dma::kLineBytes - 1;
      const std::uint64_t begin = command.ea.value & ~kLineMask;
      const std::uint64_t end = (command.ea.value + command.size + kLineMask) & ~kLineMask;
      in_flight.ranges.push_back({0, begin, static_cast<std::uint32_t>(end - begin)});
      return;
    }
    case dma::CommandKind::kList:
      break;
    default:
      return;
  }
  in_flight.first_element = in_flight.next_element;
  const std::uint32_t count = command.size / dma::kListElementBytes;
  SC_ASSERT(in_flight.next_element <= count, "element {} of a list of {}", in_flight.next_element, count);
  while (in_flight.next_element < count) {
    const std::uint32_t at = command.list_address().value + in_flight.next_element * dma::kListElementBytes;
    if (at + dma::kListElementBytes > local_store.size()) return;
    const dma::ListElement element =
        dma::read_element(local_store, command, in_flight.next_element, is_big_endian);
    if (element.size() != 0) {
      in_flight.ranges.push_back(
          {element.local_address(in_flight.cursor).value, element.ea(command).value, element.size()});
    }
    in_flight.cursor = element.next(in_flight.cursor);
    ++in_flight.next_element;
    if (element.stalls()) return;
  }
}

void CommandsInFlight::clear() {
  commands_.clear();
  last_number_ = 0;
}

CommandInFlight& CommandsInFlight::add(CommandInFlight command) {
  SC_ASSERT(command.number == 0, "command {} is added a second time", command.number);
  SC_ASSERT(command.command.tag < dma::kTagCount, "a command of tag {} is in flight", command.command.tag);
  command.number = ++last_number_;
  for (const CommandInFlight& earlier : commands_) {
    if (!is_ordered(earlier.command, command.command)) continue;
    command.behind.push_back(earlier.number);
    command.behind.insert(command.behind.end(), earlier.behind.begin(), earlier.behind.end());
  }
  std::sort(command.behind.begin(), command.behind.end());
  command.behind.erase(std::unique(command.behind.begin(), command.behind.end()), command.behind.end());
  return commands_.emplace_back(std::move(command));
}

void CommandsInFlight::complete(std::uint32_t tags, std::uint64_t up_to) {
  SC_ASSERT(up_to <= last_number_, "commands up to {} of {} are complete", up_to, last_number_);
  std::vector<std::uint64_t> done;
  for (const CommandInFlight& command : commands_) {
    if (command.number > up_to || (tags >> command.command.tag & 1u) == 0) continue;
    done.push_back(command.number);
    done.insert(done.end(), command.behind.begin(), command.behind.end());
  }
  std::sort(done.begin(), done.end());
  std::erase_if(commands_, [&](const CommandInFlight& command) { return contains(done, command.number); });
  // Commands that are complete, and barriers that wait for no command any more, no longer hold up others.
  for (CommandInFlight& command : commands_)
    std::erase_if(command.behind, [&](std::uint64_t number) { return contains(done, number); });
  std::erase_if(commands_, [](const CommandInFlight& command) {
    return command.command.kind() == dma::CommandKind::kOrdering && command.behind.empty();
  });
}

const CommandInFlight* CommandsInFlight::writing(std::uint32_t lsa, std::uint32_t bytes) const {
  for (const CommandInFlight& command : commands_) {
    if (command.writes_local_store && touches(command, lsa, bytes)) return &command;
  }
  return nullptr;
}

const CommandInFlight* CommandsInFlight::reading(std::uint32_t lsa, std::uint32_t bytes) const {
  for (const CommandInFlight& command : commands_) {
    if (!command.writes_local_store && touches(command, lsa, bytes)) return &command;
  }
  return nullptr;
}

const CommandInFlight* CommandsInFlight::listing(std::uint32_t lsa, std::uint32_t bytes) const {
  for (const CommandInFlight& command : commands_) {
    if (!command.is_list() || command.has_stalled) continue;
    const std::uint32_t begin = command.command.list_address().value;
    const std::uint32_t done = command.first_element * dma::kListElementBytes;
    SC_ASSERT(done <= command.command.size, "{} of the {} bytes of list {} are done", done,
              command.command.size, command.number);
    if (overlap(begin + done, command.command.size - done, lsa, bytes)) return &command;
  }
  return nullptr;
}

const CommandInFlight* CommandsInFlight::conflicting(const CommandInFlight& command) const {
  for (const CommandInFlight& other : commands_) {
    if (other.number == command.number || contains(command.behind, other.number)) continue;
    const bool local = (command.writes_local_store || other.writes_local_store) &&
                       command.moves_local_store() && other.moves_local_store();
    const bool main =
        (command.writes_main_storage || other.writes_main_storage) && !gives_up_a_lock(other, command);
    for (const MovedRange& a : command.ranges) {
      for (const MovedRange& b : other.ranges) {
        if ((local && overlap(a.lsa, a.bytes, b.lsa, b.bytes)) ||
            (main && overlap(a.ea, a.bytes, b.ea, b.bytes)))
          return &other;
      }
    }
  }
  return nullptr;
}

}  // namespace softcell::ls_sim
