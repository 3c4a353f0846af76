#include "checker.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/mfc.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {
namespace {

using dma::CommandKind;
using dma::MfcOpcode;
using dma::Rule;

constexpr std::uint32_t kAllTags = 2;  // the condition of MFC_WrTagUpdate that waits for all tags of the mask

constexpr bool is(std::uint32_t number, Channel channel) {
  return number == static_cast<std::uint32_t>(channel);
}

std::string name_of(const dma::MfcCommand& command) { return std::string(dma::name(command.opcode())); }

bool same_line(dma::EffectiveAddress a, dma::EffectiveAddress b) {
  return a.value / dma::kLineBytes == b.value / dma::kLineBytes;
}

}  // namespace

void Checker::begin_run(const KernelImage& image, const StackRange& stack, bool forgets) {
  SC_ASSERT(image.checked, "image {} is not a checked one", image.name);
  SC_ASSERT(stack.begin <= stack.end && stack.end <= dma::kLocalStoreBytes, "the stack of {} is {} to {}",
            image.name, stack.begin, stack.end);
  image_ = &image;
  places_.begin_run(image, stack);
  objects_.emplace(image, stack);
  last_store_.reset();
  if (forgets) heap_.clear();
  written_.forget_the_last_program(forgets ? 0 : stack.begin, forgets ? dma::kLocalStoreBytes : stack.end);
  if (runs_spu_program() || image.program) {
    written_.mark(image.begin, image.sizes.end - image.begin);  // bss is zero in each run
  } else {
    written_.mark(kEnvironmentBytes, static_cast<std::uint32_t>(image.bytes.size()));
  }
  // The outermost frame is there before the program begins.
  if (runs_spu_program() && image.stack_top == dma::kLocalStoreBytes)
    written_.mark(dma::kLocalStoreBytes - dma::kQuadwordBytes, dma::kQuadwordBytes);
  stack_overflow_known_ = false;
  for (const PaddingRange& gap : places_.padding()) written_.mark(gap.lsa, gap.bytes);
  in_flight_.clear();
  tag_mask_ = tags_issued_ = 0;
  idle_waits_.clear();
  is_waiting_ = false;
  stack_is_in_flight_ = false;
  asked_at_ = 0;
  status_unread_.reset();
  reservation_.reset();
  check_fetched_code();
}

// ---- instructions

void Checker::check_code(Address instruction) {
  const std::uint32_t lsa = instruction.value;
  if (!unsynced_.contains(lsa)) return;
  const std::uint32_t writer = unsynced_.writer_of(lsa);
  const bool by_this_kernel = writer != UnsyncedBytes::kOutside;
  report(Rule::kCodeWithoutSync, by_this_kernel ? Address{writer} : instruction,
         std::string(by_this_kernel ? "this kernel" : "another SPE or the PPU") +
             " wrote the instruction at " + objects_->describe(lsa) + " (LSA " + base::hex(lsa, 5) + ")" +
             (by_this_kernel ? "" : ", and this kernel") +
             (by_this_kernel ? " and executed it" : " executed it") + " without a sync in between");
  unsynced_.clear();  // report it once
}

/// A kernel that writes to its image's own code has a finding of another rule for that. Programs for the SPU may write there.
void Checker::mark_unsynced(const MovedRange& range, Address writer) {
  if (runs_spu_program() || !objects_->in_code(range.lsa))
    unsynced_.mark(range.lsa, range.bytes, writer.value);
}

/// Looks at the last store of an SPU program, now that it has happened. The store writes a whole quadword, in which the program may have
/// changed some bytes only. Words that stay the same need no sync before the SPU executes them.
void Checker::mark_changed_words() {
  if (!last_store_) return;
  constexpr std::uint32_t kWordBytes = 4;
  const auto now = to_.local_store.subspan(last_store_->lsa, dma::kQuadwordBytes);
  const auto before = std::span(last_store_->before);
  for (std::uint32_t i = 0; i < dma::kQuadwordBytes; ++i) {
    if ((last_store_->put_bytes >> i & 1u) == 0 || now[i] == before[i]) continue;
    report(Rule::kStoreInFlight, last_store_->writer, last_store_->put_detail);
    break;
  }
  for (std::uint32_t at = 0; at < dma::kQuadwordBytes; at += kWordBytes) {
    if (std::ranges::equal(now.subspan(at, kWordBytes), before.subspan(at, kWordBytes))) continue;
    mark_unsynced({.lsa = last_store_->lsa + at, .bytes = kWordBytes}, last_store_->writer);
  }
  last_store_.reset();
}

/// Checks the code of a job's image, which the caller of the job has fetched.
void Checker::check_fetched_code() {
  SC_ASSERT(image_->begin <= image_->data_begin && image_->data_begin <= dma::kLocalStoreBytes,
            "code of {} from {} to {}", image_->name, image_->begin, image_->data_begin);
  const std::uint32_t lsa = unsynced_.first_in(image_->begin, image_->data_begin);
  if (lsa == image_->data_begin) return;
  report(Rule::kCodeWithoutSync, Address{image_->entry},
         "the calling kernel fetched these instructions, from LSA " + base::hex(lsa, 5) +
             " on, and did not execute a sync before the call");
  unsynced_.clear();
}

void Checker::on_unchecked_issue(const dma::MfcCommand& command) {
  if (!command.is_get()) return;
  CommandInFlight fetch{.command = command, .cursor = command.lsa};
  add_ranges(fetch, to_.local_store, false);
  for (const MovedRange& range : fetch.ranges)
    unsynced_.mark(range.lsa, range.bytes, UnsyncedBytes::kOutside);
}

void Checker::on_instruction(const ExecutedInstruction& instruction) {
  SC_ASSERT(image_ != nullptr, "an instruction at {} before a run", instruction.address);
  const std::uint32_t lsa = instruction.address.value;
  mark_changed_words();
  const bool is_code = lsa >= image_->text_begin && lsa < image_->text_end;
  if (!is_code && !is_written(lsa, 4)) {
    report(Rule::kJumpOutsideCode, instruction.address,
           "it executes LSA " + base::hex(lsa, 5) +
               ", which is no code of the program, nor has the program written it");
    written_.mark(lsa, 4);  // report it once
  }
  check_code(instruction.address);
  if (instruction.undefined) report_undefined(instruction);
  if (instruction.stack_pointer.value >= image_->sizes.end || stack_overflow_known_) return;
  stack_overflow_known_ = true;  // all that follows does the same
  report(Rule::kStackOverflow, instruction.address,
         "the stack pointer is " + base::hex(instruction.stack_pointer.value, 5) +
             ", and the program's variables end at " + base::hex(image_->sizes.end, 5));
}

void Checker::report_undefined(const ExecutedInstruction& instruction) {
  const UndefinedUse& use = *instruction.undefined;
  static constexpr const char* kUses[] = {"the address of this access", "whether this branch is taken",
                                          "where this branch goes", "whether this stops the SPU",
                                          "what is written to this channel"};
  std::string what = std::string(kUses[static_cast<std::size_t>(use.kind)]) + " depends on register $" +
                     std::to_string(use.reg) + " (LSA " + base::hex(instruction.address.value, 5) + ")";
  if (!use.from) {
    what += ", which the program has never written";
  } else {
    const std::string place = places_.of(use.from->instruction);
    // In a program with a heap, the border between heap and stack is not known.
    const bool is_free = image_->main == 0 && use.from->lsa.value >= image_->sizes.end;
    what += ", on bytes " + (is_free ? "of heap or stack" : "at " + objects_->describe(use.from->lsa.value)) +
            " (LSA " + base::hex(use.from->lsa.value, 5) + ") that nobody has written; they were loaded at " +
            (place.empty() ? "" : place + ", ") + "LSA " + base::hex(use.from->instruction.value, 5);
  }
  const bool is_address = use.kind == UndefinedUse::Kind::kAddress;
  report(is_address ? Rule::kUninitialisedAddress : Rule::kUninitialisedValue, instruction.address,
         std::move(what));
}

UndefinedBits Checker::undefined_bits(dma::LocalStoreAddress quadword) {
  UndefinedBits bits;
  if (is_shared_.load(std::memory_order_relaxed)) find_unseen_writes(quadword.value, dma::kQuadwordBytes);
  for (std::uint32_t i = 0; i < bits.size(); ++i) bits[i] = written_.undefined(quadword.value + i);
  return bits;
}

// ---- loads and stores

void Checker::on_access(const Access& access) {
  SC_ASSERT(objects_.has_value(), "a {} of {} bytes at {} before a run", access.is_store ? "store" : "load",
            access.bytes, access.lsa);
  stack_pointer_ = access.stack_pointer.value;
  check_code(access.instruction);
  check_frames(access.instruction, access.stack_pointer.value);
  // An SPU loads and stores the whole quadword in which a variable lies, and its neighbours with it.
  const std::string trespass =
      runs_spu_program() ? "" : trespass_of(access.lsa.value, access.bytes, access.stack_pointer.value);
  if (!trespass.empty()) {
    report(Rule::kOutsideObjects, access.instruction, describe(access) + ": " + trespass);
  } else if (access.is_store) {
    check_store(access);
  } else {
    check_load(access);
  }
  if (!access.is_store) return;
  if (runs_spu_program()) {
    SC_ASSERT(access.bytes == dma::kQuadwordBytes && access.lsa.value % dma::kQuadwordBytes == 0,
              "an SPU stores {} bytes at {}", access.bytes, access.lsa);
    last_store_ = QuadwordStore{.lsa = access.lsa.value, .writer = access.instruction};
    std::ranges::copy(to_.local_store.subspan(access.lsa.value, access.bytes), last_store_->before.begin());
    watch_bytes_of_put(access);
    for (std::uint32_t i = 0; i < access.bytes; ++i)
      written_.mark_but(access.lsa.value + i, access.undefined[i]);
    return;
  }
  written_.mark(access.lsa.value, access.bytes);
  mark_unsynced({.lsa = access.lsa.value, .bytes = access.bytes}, access.instruction);
}

std::string Checker::trespass_of(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t stack_pointer) const {
  std::string trespass = objects_->trespass(lsa, bytes, stack_pointer);
  return trespass.empty() && objects_->in_heap(lsa) ? heap_.trespass(lsa, bytes) : trespass;
}

void Checker::on_heap_block(const Access& block, bool is_freed) {
  SC_ASSERT(objects_.has_value(), "a block of {} bytes at {} before a run", block.bytes, block.lsa);
  stack_pointer_ = block.stack_pointer.value;
  if (!is_freed) return heap_.add(block.lsa.value, block.bytes);
  const std::uint32_t lsa = block.lsa.value, bytes = heap_.bytes_at(lsa);
  const auto freed = [&] {
    return "free of " + objects_->describe(lsa) + " (LSA " + base::hex(lsa, 5) + ")";
  };
  const std::string mistake = heap_.end(lsa);
  if (!mistake.empty()) return report(Rule::kOutsideObjects, block.instruction, freed() + ": " + mistake);
  const CommandInFlight* other = in_flight_.writing(lsa, bytes);
  if (other == nullptr) other = in_flight_.reading(lsa, bytes);
  if (other == nullptr) return;
  report(Rule::kStoreInFlight, block.instruction,
         freed() + ", and whoever gets these bytes next stores there; in flight: " + describe(*other));
}

/// Does not check that bytes which the host reads were written: fwrite() of a structure also reads its padding.
void Checker::on_host_access(dma::LocalStoreAddress lsa, std::uint32_t bytes, bool is_store) {
  const Access access{.lsa = lsa,
                      .bytes = bytes,
                      .is_store = is_store,
                      .instruction = to_.engine.position(),
                      .stack_pointer = to_.engine.stack_pointer()};
  stack_pointer_ = access.stack_pointer.value;
  if (is_store) {
    if (objects_.has_value()) check_store(access);  // a resident kernel has none before its first job
    written_.mark(lsa.value, bytes);
  } else {
    check_load_in_flight(access);
  }
}

bool Checker::is_written(std::uint32_t lsa, std::uint32_t bytes) {
  if (written_.any(lsa, bytes)) return true;
  if (!is_shared_.load(std::memory_order_relaxed)) return false;
  find_unseen_writes(lsa, bytes);
  return written_.any(lsa, bytes);
}

/// Marks quadwords that the PPU side has written through its pointer to the local store. Such a quadword has a byte that is not marked as
/// written and no longer has the fill pattern. (After a run such a byte may also be one of the last program's. Then a load of it is not
/// reported, and nothing is reported wrongly.)
void Checker::find_unseen_writes(std::uint32_t lsa, std::uint32_t bytes) {
  const std::uint32_t end = std::min(lsa + bytes, dma::kLocalStoreBytes);
  for (std::uint32_t begin = lsa / dma::kQuadwordBytes * dma::kQuadwordBytes; begin < end;
       begin += dma::kQuadwordBytes) {
    bool is_changed = false;
    for (std::uint32_t at = begin; at < begin + dma::kQuadwordBytes; ++at)
      is_changed = is_changed || (!written_.any(at, 1) && to_.local_store[at] != kFiller);
    if (!is_changed) continue;
    for (std::uint32_t at = begin; at < begin + dma::kQuadwordBytes; ++at) {
      if (!written_.any(at, 1)) written_.mark_external(at, 1);
    }
  }
}

void Checker::check_store(const Access& access) {
  const std::uint32_t lsa = access.lsa.value;
  if (reservation_ && lsa < reservation_->command.lsa.value + dma::kLineBytes &&
      reservation_->command.lsa.value < lsa + access.bytes) {
    reservation_->line_changed = true;
  }
  if (objects_->in_code(lsa) && !runs_spu_program()) {
    report(Rule::kWriteToCode, access.instruction, describe(access));
    return;
  }
  const CommandInFlight* other = in_flight_.listing(lsa, access.bytes);
  const Rule rule = other != nullptr ? Rule::kListInFlight : Rule::kStoreInFlight;
  if (other == nullptr) other = in_flight_.writing(lsa, access.bytes);
  if (other == nullptr) {
    other = in_flight_.reading(lsa, access.bytes);
    if (other != nullptr && is_put_of_a_part(*other, lsa)) other = nullptr;
  }
  if (other != nullptr) {
    report(rule, access.instruction, describe(access) + "; in flight: " + describe(*other));
  } else if (is_in_unread_line(access)) {
    report(rule, access.instruction, describe(access) + "; in flight: " + describe(*status_unread_));
  } else if (const CommandInFlight* const beside = get_beside(access)) {
    report(Rule::kStoreInFlight, access.instruction,
           describe(access) + ", and an SPU stores the whole quadword; in flight: " + describe(*beside));
  }
}

/// Returns a get in flight to other bytes of the same quadword and variable. An SPU stores whole quadwords, so it would overwrite these
/// bytes with what it loaded before the get. Other variables need no check, because a compiler for the SPU gives each a quadword of its
/// own. Null: there is no such get, or the access is to the stack, where the places of variables are not known.
const CommandInFlight* Checker::get_beside(const Access& access) const {
  const std::uint32_t lsa = access.lsa.value, quadword = lsa / dma::kQuadwordBytes * dma::kQuadwordBytes;
  if (runs_spu_program() || access.bytes >= dma::kQuadwordBytes) return nullptr;
  const LocalRange variable = objects_->variable_at(lsa);
  const std::uint32_t begin = std::max(quadword, variable.lsa),
                      end = std::min(quadword + dma::kQuadwordBytes, variable.lsa + variable.bytes);
  return begin < end ? in_flight_.writing(begin, end - begin) : nullptr;
}

/// Whether a put moves only some bytes of a quadword. Then an SPU program that stores the quadword may change only the others.
bool Checker::is_put_of_a_part(const CommandInFlight& put, std::uint32_t quadword) const {
  if (!runs_spu_program()) return false;
  return std::ranges::none_of(put.ranges, [&](const MovedRange& range) {
    return range.lsa <= quadword && quadword + dma::kQuadwordBytes <= range.lsa + range.bytes;
  });
}

/// Remembers which bytes of the quadword such a put moves. The store breaks the rule only if it changes one of them, which
/// mark_changed_words() finds out.
void Checker::watch_bytes_of_put(const Access& store) {
  const std::uint32_t quadword = store.lsa.value;
  const CommandInFlight* const put = in_flight_.reading(quadword, dma::kQuadwordBytes);
  if (put == nullptr || !is_put_of_a_part(*put, quadword)) return;
  for (std::uint32_t i = 0; i < dma::kQuadwordBytes; ++i) {
    for (const MovedRange& range : put->ranges) {
      if (quadword + i - range.lsa < range.bytes)
        last_store_->put_bytes |= static_cast<std::uint16_t>(1u << i);
    }
  }
  last_store_->put_detail = describe(store) + "; in flight: " + describe(*put);
}

/// @return  whether it breaks the rule.
bool Checker::check_load_in_flight(const Access& access) {
  if (const CommandInFlight* const other = in_flight_.writing(access.lsa.value, access.bytes)) {
    report(Rule::kLoadInFlight, access.instruction, describe(access) + "; in flight: " + describe(*other));
    return true;
  }
  if (!is_in_unread_line(access) || status_unread_->command.opcode() != MfcOpcode::getllar) return false;
  report(Rule::kLoadInFlight, access.instruction,
         describe(access) + "; in flight: " + describe(*status_unread_));
  return true;
}

/// Whether the access is to the line of an atomic command that the program does not know to be complete, because it has not read the
/// command's status.
bool Checker::is_in_unread_line(const Access& access) const {
  if (!status_unread_ || status_unread_->status_is_there) return false;
  const std::uint32_t line = status_unread_->command.lsa.value / dma::kLineBytes * dma::kLineBytes;
  return line < access.lsa.value + access.bytes && access.lsa.value < line + dma::kLineBytes;
}

std::string Checker::describe(const LineCommand& line) const {
  return name_of(line.command) + ", issued at " + places_.of(line.issued_at) + ", whose status was not read";
}

void Checker::check_load(const Access& access) {
  if (check_load_in_flight(access)) return;
  // Loads from the stack are not checked: the compiler stores arguments there without a report, and it warns of variables that are not
  // set. A load is good if any of its bytes was written, because the others may be padding. An SPU program with a heap loads a quadword
  // before it stores to a part of it, so undefined bytes are reported only where they have an effect (report_undefined()).
  if (runs_spu_program() && image_->main == 0) return;
  if (objects_->in_stack(access.lsa.value) || is_written(access.lsa.value, access.bytes)) return;
  report(Rule::kLoadNeverWritten, access.instruction,
         describe(access) + ": this job has not written these bytes");
}

void Checker::begin_channel_operation() {
  stack_pointer_ = to_.engine.stack_pointer().value;
  check_code(to_.engine.position());
}

// ---- commands

ChannelReply Checker::issue(const dma::MfcCommand& command) {
  begin_channel_operation();
  check_frames(to_.engine.position(), stack_pointer_);
  CommandInFlight in_flight{
      .command = command,
      .issued_at = to_.engine.position(),
      .writes_local_store = command.is_get() || command.opcode() == MfcOpcode::getllar,
      .writes_main_storage = command.is_put() || command.kind() == CommandKind::kQueuedLine ||
                             command.opcode() == MfcOpcode::putllc ||
                             command.opcode() == MfcOpcode::putlluc || command.opcode() == MfcOpcode::sdcrz,
      .cursor = command.lsa};
  // Reads the list now, because the command may overwrite it.
  add_ranges(in_flight, to_.local_store, runs_spu_program());
  ChannelReply reply = to_.channels.issue(command);
  if (reply.fault) return reply;
  if (command.kind() == CommandKind::kLine) {
    check_line_command(in_flight);
    return reply;
  }
  SC_ASSERT(command.tag < dma::kTagCount, "the MFC has accepted a command of tag {}", command.tag);
  tags_issued_ |= 1u << command.tag;
  if (command.kind() == CommandKind::kCacheHint && command.opcode() != MfcOpcode::sdcrz) return reply;
  if (command.kind() == CommandKind::kQueuedLine) end_reservation(command);
  check_ranges(in_flight_.add(std::move(in_flight)));
  return reply;
}

void Checker::check_ranges(CommandInFlight& command) {
  SC_ASSERT(objects_.has_value(), "command {} is checked before a run", command.number);
  if (command.moves_local_store()) {
    for (const MovedRange& range : command.ranges) {
      check_local_range(command.command, range, command.writes_local_store);
      if (runs_spu_program() || !objects_->in_stack(range.lsa)) continue;
      // Below the stack pointer check_local_range() has reported it.
      const bool is_used = range.lsa >= to_.engine.stack_pointer().value;
      (is_used ? stack_is_in_flight_ : command.frame_was_left) = true;
    }
  }
  if (command.is_list() && !runs_spu_program() && objects_->in_stack(command.command.list_address().value))
    stack_is_in_flight_ = true;
  check_overlaps(command);
}

void Checker::check_overlaps(const CommandInFlight& command) {
  if (const CommandInFlight* const other = in_flight_.conflicting(command)) {
    report(Rule::kTransfersOverlap, to_.engine.position(), "in flight: " + describe(*other), command.command);
  }
  if (!command.writes_local_store) return;
  for (const MovedRange& range : command.ranges) {
    const CommandInFlight* const list = in_flight_.listing(range.lsa, range.bytes);
    if (list != nullptr && list->number != command.number) {
      report(Rule::kListInFlight, to_.engine.position(), "in flight: " + describe(*list), command.command);
      return;
    }
  }
}

void Checker::check_local_range(const dma::MfcCommand& command, const MovedRange& range, bool is_get) {
  const Address here = to_.engine.position();
  const std::string where = objects_->describe(range.lsa);
  // A program for the SPU may have a heap below its stack.
  const std::uint32_t stack_pointer = runs_spu_program() ? 0 : to_.engine.stack_pointer().value;
  const std::string trespass = trespass_of(range.lsa, range.bytes, stack_pointer);
  if (!trespass.empty()) {
    report(Rule::kOutsideObjects, here, std::to_string(range.bytes) + " bytes at " + where + ": " + trespass,
           command);
  } else if (is_get && objects_->in_code(range.lsa)) {
    report(Rule::kWriteToCode, here, "its destination is " + where, command);
  } else if (!is_get) {
    // Quadword by quadword, as the SPU stores. On the stack the whole range counts as written if one byte is, because it is not known where
    // variables there have padding.
    const std::uint32_t step = objects_->in_stack(range.lsa) ? range.bytes : dma::kQuadwordBytes;
    for (std::uint32_t done = 0; done < range.bytes; done += step) {
      if (is_written(range.lsa + done, std::min(step, range.bytes - done))) continue;
      report(Rule::kPutNeverWritten, here,
             objects_->describe(range.lsa + done) + ": this job has not written these bytes", command);
      break;
    }
  }
  if (!is_get) return;
  written_.mark(range.lsa, range.bytes);
  mark_unsynced(range, here);
}

void Checker::check_line_command(const CommandInFlight& line) {
  const dma::MfcCommand& command = line.command;
  const Address here = to_.engine.position();
  if (status_unread_) {
    report(Rule::kAtomicStatusNotRead, here,
           "the status of the " + name_of(status_unread_->command) + " before it, issued at " +
               places_.of(status_unread_->issued_at) + ", was not read",
           command);
  }
  status_unread_ = LineCommand{command, here};
  if (command.opcode() == MfcOpcode::putllc &&
      !(reservation_ && same_line(reservation_->command.ea, command.ea)))
    report(Rule::kPutllcWithoutReservation, here, "no getllar of this line came before it", command);
  for (const MovedRange& range : line.ranges) check_local_range(command, range, line.writes_local_store);
  check_overlaps(line);  // because it does not wait for the commands in the queue
  end_reservation(command);
}

void Checker::end_reservation(const dma::MfcCommand& by) {
  const bool stores_it =
      reservation_ && by.opcode() != MfcOpcode::getllar && same_line(reservation_->command.ea, by.ea);
  if (reservation_ && !stores_it && reservation_->line_changed && by.opcode() == MfcOpcode::getllar) {
    report(Rule::kReservationNotUsed, reservation_->issued_at,
           "the line was changed, and the next getllar is at " + places_.of(to_.engine.position()),
           reservation_->command);
  }
  if (by.opcode() == MfcOpcode::getllar) {
    reservation_ = LineCommand{by, to_.engine.position()};
  } else if (stores_it || by.opcode() == MfcOpcode::putllc) {
    reservation_.reset();
  }
}

/// Reports commands in flight to or from variables of functions that have returned. These lie below the stack pointer, where the next
/// function stores.
void Checker::check_frames(Address here, std::uint32_t stack_pointer) {
  if (!stack_is_in_flight_) return;
  stack_is_in_flight_ = false;
  for (CommandInFlight& command : in_flight_.all()) {
    for (const MovedRange& range : command.ranges) {
      if (command.frame_was_left || !objects_->in_stack(range.lsa)) continue;
      if (range.lsa + range.bytes > stack_pointer) {
        stack_is_in_flight_ = true;
        continue;
      }
      command.frame_was_left = true;
      report(Rule::kStoreInFlight, here,
             "the function that has these " + std::to_string(range.bytes) +
                 " bytes on the stack has returned, and the next one stores there; in flight: " +
                 describe(command));
    }
    if (!command.is_list() || command.frame_was_left) continue;
    const std::uint32_t list = command.command.list_address().value;
    if (!objects_->in_stack(list)) continue;
    if (list + command.command.size > stack_pointer) {
      stack_is_in_flight_ = true;
      continue;
    }
    command.frame_was_left = true;
    report(Rule::kListInFlight, here,
           "the function that has the list on the stack has returned, and the next one stores there; in "
           "flight: " +
               describe(command));
  }
}

// ---- channels

ChannelReply Checker::count(std::uint32_t channel) {
  begin_channel_operation();
  ChannelReply reply = to_.channels.count(channel);
  if (!reply.fault && reply.value != 0 && is(channel, Channel::kMfcRdTagStat)) on_tag_status();
  if (!reply.fault && reply.value != 0 && is(channel, Channel::kMfcRdAtomicStat) && status_unread_)
    status_unread_->status_is_there = true;
  return reply;
}

ChannelReply Checker::write(std::uint32_t channel, std::uint32_t value) {
  begin_channel_operation();
  check_frames(to_.engine.position(), stack_pointer_);
  ChannelReply reply = to_.channels.write(channel, value);
  if (reply.fault) return reply;
  if (is(channel, Channel::kMfcWrTagMask)) tag_mask_ = value;
  if (is(channel, Channel::kMfcWrTagUpdate)) on_tag_update(value);
  if (is(channel, Channel::kMfcWrListStallAck)) on_list_acknowledged(value);
  return reply;
}

void Checker::on_tag_update(std::uint32_t condition) {
  is_waiting_ = condition != 0;
  asked_at_ = in_flight_.last_number();
  awaited_ = condition == kAllTags || std::has_single_bit(tag_mask_) ? tag_mask_ : 0;
  // A mask of all tags is no mistake. Nor is a tag whose first command comes later, as in a loop over two buffers that waits for both from
  // the start; so report_idle_waits() decides at the end of the run.
  if (!is_waiting_ || (tag_mask_ & tags_issued_) != 0 || tag_mask_ == ~0u) return;
  idle_waits_.try_emplace({to_.engine.position().value, tag_mask_}, stack_pointer_);
}

void Checker::report_idle_waits() {
  for (const auto& [wait, stack_pointer] : idle_waits_) {
    const auto [instruction, mask] = wait;
    if ((mask & tags_issued_) != 0) continue;
    std::string tags;
    for (std::uint32_t tag = 0; tag < dma::kTagCount; ++tag) {
      if ((mask >> tag & 1u) != 0) tags += (tags.empty() ? "tag " : ", tag ") + std::to_string(tag);
    }
    stack_pointer_ = stack_pointer;
    report(Rule::kTagWithoutCommand, {instruction},
           tags.empty() ? "the tag mask is empty" : tags + ": the program has issued no command of it");
  }
}

/// The program has learnt from the channel's count, or from the event, that the tag status is there. So it knows that the tags it waits for
/// are complete, before it reads the status.
void Checker::on_tag_status() {
  if (is_waiting_) complete(awaited_);
}

ChannelReply Checker::read(std::uint32_t channel) {
  begin_channel_operation();
  check_frames(to_.engine.position(), stack_pointer_);
  ChannelReply reply = to_.channels.read(channel);
  if (reply.fault) return reply;
  if (is(channel, Channel::kMfcRdTagStat)) {
    complete(reply.value);
  }
  if (is(channel, Channel::kSpuRdEventStat) && (reply.value & dma::Mfc::kTagStatusEvent) != 0)
    on_tag_status();
  if (is(channel, Channel::kMfcRdListStallStat)) on_list_stall(reply.value);
  if (is(channel, Channel::kMfcRdAtomicStat)) status_unread_.reset();
  return reply;
}

/// Bytes of a get may arrive at any time before its tag is complete, so a `sync` has an effect on them only after that.
void Checker::complete(std::uint32_t tags) {
  for (const CommandInFlight& command : in_flight_.all()) {
    if (!command.writes_local_store || (tags >> command.command.tag & 1u) == 0) continue;
    for (const MovedRange& range : command.ranges) mark_unsynced(range, command.issued_at);
  }
  in_flight_.complete(tags, asked_at_);
}

void Checker::on_list_stall(std::uint32_t tags) {
  for (CommandInFlight& command : in_flight_.all()) {
    if (!command.can_stall() || (tags >> command.command.tag & 1u) == 0) continue;
    command.has_stalled = true;
    command.ranges.clear();  // the elements up to the one that has stalled are complete
  }
}

void Checker::on_list_acknowledged(std::uint32_t tag) {
  for (CommandInFlight& command : in_flight_.all()) {
    if (!command.has_stalled || command.command.tag != tag) continue;
    command.has_stalled = false;
    add_ranges(command, to_.local_store, runs_spu_program());
    check_ranges(command);
  }
}

void Checker::end_run() {
  report_idle_waits();
  if (status_unread_) {
    report(Rule::kAtomicStatusNotRead, status_unread_->issued_at, "the program ends without it",
           status_unread_->command);
  }
  if (reservation_ && reservation_->line_changed) {
    report(Rule::kReservationNotUsed, reservation_->issued_at, "the line was changed, and the program ends",
           reservation_->command);
  }
  for (const CommandInFlight& command : in_flight_.all()) {
    // The program needs no result of a cache command.
    if (command.command.kind() == CommandKind::kOrdering || !command.moves_local_store()) continue;
    report(Rule::kCommandsOutstanding, command.issued_at, "the program ends without a wait for its tag",
           command.command);
  }
}

// ---- reports

void Checker::report(Rule rule, Address place, std::string detail,
                     const std::optional<dma::MfcCommand>& command) {
  SC_ASSERT(image_ != nullptr, "rule {} broken before a run: {}", dma::name(rule), detail);
  const dma::Fault finding{.rule = rule,
                           .spe = to_.spe,
                           .kernel = image_->name,
                           .place = places_.in_program(place, stack_pointer_),
                           .command = command,
                           .detail = std::move(detail)};
  to_.findings.add(finding);
  if (to_.trace != nullptr) to_.trace->on_finding(finding, to_.trace->now());
}

std::string Checker::describe(const Access& access) const {
  return std::string(access.is_store ? "store" : "load") + " of " + std::to_string(access.bytes) +
         (access.bytes == 1 ? " byte at " : " bytes at ") + objects_->describe(access.lsa.value) + " (LSA " +
         base::hex(access.lsa.value, 5) + ")";
}

std::string Checker::describe(const CommandInFlight& other) const {
  std::uint64_t bytes = 0;
  for (const MovedRange& range : other.ranges) bytes += range.bytes;
  return name_of(other.command) + " of " + std::to_string(bytes) + " bytes, tag " +
         std::to_string(other.command.tag) + ", issued at " + places_.of(other.issued_at);
}

}  // namespace softcell::ls_sim
