#include "mfc_timer.h"

#include <algorithm>

#include "softcell/base/assert.h"
#include "softcell/dma/list_transfer.h"
#include "softcell/dma/mfc_queue.h"

namespace softcell::ls_sim {
namespace {

/// The SPE whose local store or registers lie there.
int owner_of(dma::EffectiveAddress ea) {
  const std::uint64_t offset = ea.value - dma::kLocalStoresBase.value;
  if (ea.value < dma::kLocalStoresBase.value || offset >= dma::kSpeCount * dma::kLocalStoreStrideBytes)
    return ElementInterconnect::kMainMemory;
  return static_cast<int>(offset / dma::kLocalStoreStrideBytes);
}

constexpr bool has_tag(std::uint32_t tags, std::uint32_t tag) { return (tags >> tag & 1) != 0; }

}  // namespace

void MfcTimer::begin_run() {
  queue_.clear();
  stalled_.clear();
  queue_barrier_ = 0;
  list_stalls_ = {};
  atomic_ = 0;
}

std::uint64_t MfcTimer::slot_free(std::uint64_t now) const {
  int busy = 0;
  std::uint64_t earliest = kNotYet;
  for (const Entry& entry : queue_) {
    if (entry.complete <= now) continue;
    ++busy;
    earliest = std::min(earliest, entry.complete);
  }
  return busy < dma::MfcQueue::kSlots || earliest == kNotYet ? now : earliest;
}

std::uint64_t MfcTimer::issue(const dma::MfcCommand& command, std::uint64_t now,
                              std::span<const std::byte> local_store, bool is_big_endian) {
  ++counts_.commands;
  interconnect_.forget_before(now);
  if (command.kind() == dma::CommandKind::kLine) {
    ++counts_.lines;
    atomic_ = interconnect_.move_line(
        spe_, command.opcode() == dma::MfcOpcode::getllar, owner_of(command.ea),
        now + parameters_.atomic_latency - std::min(parameters_.atomic_latency, parameters_.line_cycles));
    counts_.latency += atomic_ - now;
    port_.add(atomic_, atomic_, 1);
    return atomic_;
  }
  std::erase_if(queue_, [&](const Entry& entry) { return entry.complete <= now; });
  const std::uint64_t complete = run(command, now, local_store, is_big_endian);
  if (complete != kNotYet) counts_.latency += complete - now;
  queue_.push_back({command.tag, now, complete, command.has_barrier()});
  if (command.is_queue_barrier()) queue_barrier_ = std::max(queue_barrier_, complete);
  return complete;
}

/// When a command may start, which fences and barriers may delay. A list that has stalled delays nothing here, because the program must
/// acknowledge it before the command can complete.
std::uint64_t MfcTimer::start_of(const dma::MfcCommand& command, std::uint64_t now) const {
  std::uint64_t start = std::max(now, queue_barrier_);
  for (const Entry& entry : queue_) {
    const bool holds_up =
        command.is_queue_barrier() ||
        (entry.tag == command.tag && (command.has_fence() || command.has_barrier() || entry.is_barrier));
    if (holds_up && entry.complete != kNotYet) start = std::max(start, entry.complete);
  }
  return start;
}

std::uint64_t MfcTimer::run(const dma::MfcCommand& command, std::uint64_t now,
                            std::span<const std::byte> local_store, bool is_big_endian) {
  const std::uint64_t start = start_of(command, now) + parameters_.mfc_start;
  Stream stream{.request = start, .complete = start};
  switch (command.kind()) {
    case dma::CommandKind::kList:
      return run_list(command, 0, stream, now, local_store, is_big_endian);
    case dma::CommandKind::kTransfer:
    case dma::CommandKind::kStart:
      move(stream, command.is_get(), command.ea, command.size);
      break;
    case dma::CommandKind::kQueuedLine:
      move(stream, false, command.ea, dma::kLineBytes);
      break;
    case dma::CommandKind::kSignal:
      move(stream, false, command.ea, dma::kSignalBytes);
      break;
    case dma::CommandKind::kCacheHint:
      if (command.opcode() == dma::MfcOpcode::sdcrz) move(stream, false, command.ea, command.size);
      break;
    default:
      break;
  }
  use_port(stream);
  return stream.complete;
}

/// Times the lines of one transfer. A line is requested after the one before it, and when fewer than outstanding_lines are under way.
void MfcTimer::move(Stream& stream, bool is_get, dma::EffectiveAddress ea, std::uint32_t bytes) {
  if (bytes == 0) return;
  const int other = owner_of(ea);
  const std::uint64_t latency = other == ElementInterconnect::kMainMemory ? parameters_.memory_latency
                                                                          : parameters_.local_store_latency;
  const std::uint64_t until_data = latency - std::min<std::uint64_t>(latency, parameters_.line_cycles);
  const std::uint64_t outstanding =
      std::clamp<std::uint64_t>(parameters_.outstanding_lines, 1, lines_.size());
  const auto offset = static_cast<std::uint32_t>(ea.value % dma::kLineBytes);
  const std::uint32_t lines = (offset + bytes + dma::kLineBytes - 1) / dma::kLineBytes;
  for (std::uint32_t i = 0; i < lines; ++i) {
    if (lines_asked_ >= outstanding)
      stream.request = std::max(stream.request, lines_[(lines_asked_ - outstanding) % lines_.size()]);
    const std::uint64_t complete = interconnect_.move_line(spe_, is_get, other, stream.request + until_data);
    lines_[lines_asked_++ % lines_.size()] = complete;
    if (stream.lines++ == 0) stream.first = complete;
    stream.complete = std::max(stream.complete, complete);
  }
  counts_.lines += lines;
}

std::uint64_t MfcTimer::run_list(const dma::MfcCommand& command, std::uint32_t from, Stream& stream,
                                 std::uint64_t issued, std::span<const std::byte> local_store,
                                 bool is_big_endian) {
  const std::uint32_t count = command.size / dma::kListElementBytes;
  for (std::uint32_t i = from; i < count; ++i) {
    const dma::ListElement element = dma::read_element(local_store, command, i, is_big_endian);
    stream.request += parameters_.list_element;
    stream.complete = std::max(stream.complete, stream.request);
    move(stream, command.is_get(), element.ea(command), element.size());
    if (!element.stalls() || i + 1 == count) continue;
    use_port(stream);
    stalled_.push_back({command, i + 1, stream.complete, issued});
    list_stalls_[command.tag] = stream.complete;
    return kNotYet;
  }
  use_port(stream);
  return stream.complete;
}

void MfcTimer::use_port(const Stream& stream) {
  if (stream.lines != 0) port_.add(stream.first, stream.complete, stream.lines);
}

void MfcTimer::acknowledge(std::uint32_t tag, std::uint64_t now, std::span<const std::byte> local_store,
                           bool is_big_endian) {
  const std::vector<StalledList> lists = stalled_;
  std::erase_if(stalled_, [tag](const StalledList& list) { return list.command.tag == tag; });
  for (const StalledList& list : lists) {
    if (list.command.tag != tag) continue;
    const std::uint64_t start = std::max(now, list.stalled) + parameters_.mfc_start;
    Stream stream{.request = start, .complete = start};
    const std::uint64_t complete =
        run_list(list.command, list.next, stream, list.issued, local_store, is_big_endian);
    const auto entry = std::ranges::find_if(queue_, [&](const Entry& each) {
      return each.tag == tag && each.complete == kNotYet && each.issued == list.issued;
    });
    if (entry == queue_.end() || complete == kNotYet) continue;
    entry->complete = complete;
    counts_.latency += complete - list.issued;
  }
}

std::uint64_t MfcTimer::all_complete(std::uint32_t tags) const {
  std::uint64_t latest = 0;
  for (const Entry& entry : queue_) {
    if (has_tag(tags, entry.tag) && entry.complete != kNotYet) latest = std::max(latest, entry.complete);
  }
  return latest;
}

std::uint64_t MfcTimer::any_complete(std::uint32_t tags) const {
  std::uint64_t earliest = kNotYet;
  for (std::uint32_t tag = 0; tag < dma::kTagCount; ++tag) {
    if (has_tag(tags, tag)) earliest = std::min(earliest, all_complete(1u << tag));
  }
  return earliest == kNotYet ? 0 : earliest;
}

std::uint64_t MfcTimer::lists_stalled(std::uint32_t tags) const {
  std::uint64_t latest = 0;
  for (std::uint32_t tag = 0; tag < dma::kTagCount; ++tag) {
    if (has_tag(tags, tag)) latest = std::max(latest, list_stalls_[tag]);
  }
  return latest;
}

}  // namespace softcell::ls_sim
