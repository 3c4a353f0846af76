#include "host_memory.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "softcell/base/assert.h"
#include "text.h"

namespace softcell::dma {
namespace {

/// All of a file of the kernel, which has no size.
std::string read_all(const char* path) {
  std::string text;
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return text;
  std::array<char, 16384> part;
  for (ssize_t got; (got = read(file, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(got));
  close(file);
  return text;
}

std::uint64_t take_hexadecimal(std::string_view& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error == std::errc()) text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::string range_of(std::uint64_t begin, std::uint64_t end) { return hex(begin) + ".." + hex(end - 1); }

}  // namespace

// A line is "55d0-55f0 r-xp 00002000 08:01 1234   /usr/bin/program". [Linux, proc(5)] documented
HostMemory::Regions HostMemory::read_regions() {
  const std::string text = read_all("/proc/self/maps");
  Regions regions;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const std::uint64_t begin = take_hexadecimal(line);
    if (!line.starts_with('-')) continue;
    line.remove_prefix(1);
    const std::uint64_t end = take_hexadecimal(line);
    if (line.size() < 4 || begin >= end) continue;
    const unsigned access = (line[1] == 'r' ? 1u : 0u) | (line[2] == 'w' ? 2u : 0u);
    const std::size_t name = line.find_first_of("/[");
    regions.push_back({begin, end, static_cast<SpeAccess>(access),
                       name == line.npos ? std::string() : std::string(line.substr(name))});
  }
  return regions;
}

const HostMemory::Region* HostMemory::region_at(const Regions& regions, std::uint64_t address) {
  const auto above = std::upper_bound(regions.begin(), regions.end(), address,
                                      [](std::uint64_t a, const Region& region) { return a < region.begin; });
  if (above == regions.begin()) return nullptr;
  const Region& region = *std::prev(above);
  return address < region.end ? &region : nullptr;
}

bool HostMemory::covers(const Regions& regions, EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) {
  for (std::uint64_t at = ea.value, left = bytes;;) {
    const Region* region = region_at(regions, at);
    if (region == nullptr || region->access == SpeAccess::kNone || !allows(region->access, wanted))
      return false;
    const std::uint64_t here = region->end - at;
    if (left <= here) return true;
    left -= here;
    at = region->end;
  }
}

bool HostMemory::is_mapped(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const {
  {
    const std::shared_lock lock(mutex_);
    if (covers(regions_, ea, bytes, wanted)) return true;
  }
  Regions now = read_regions();
  const bool covered = covers(now, ea, bytes, wanted);
  const std::lock_guard lock(mutex_);
  regions_ = std::move(now);
  return covered;
}

std::optional<Mapping> HostMemory::mapping_at(EffectiveAddress ea, SpeAccess wanted) const {
  if (!is_mapped(ea, 1, wanted)) return std::nullopt;
  std::uint64_t begin = 0, end = 0;
  SpeAccess access = SpeAccess::kNone;
  {
    const std::shared_lock lock(mutex_);
    const Region* region = region_at(regions_, ea.value);
    if (region == nullptr) return std::nullopt;  // another thread has read anew
    begin = region->begin;
    end = region->end;
    access = region->access;
  }
  const HostAllocations* allocations = allocations_.load(std::memory_order_acquire);
  if (allocations != nullptr && allocations->owns(ea.value)) {
    const auto block = allocations->last_at_or_below(ea.value);
    if (!block || !block->live || ea.value - block->begin >= round_up_to_quadword(block->bytes))
      return std::nullopt;
    begin = block->begin;
    end = block->begin + round_up_to_quadword(block->bytes);
  }
  return Mapping{.ea = {begin},
                 .bytes = end - begin,
                 .host = reinterpret_cast<std::byte*>(begin),
                 .spe_access = access,
                 .memory = Memory::kMain,
                 .element_bytes = 0};
}

std::variant<std::byte*, Fault> HostMemory::resolve(EffectiveAddress ea, std::uint64_t bytes,
                                                    SpeAccess wanted) const {
  SC_ASSERT(bytes != 0, "an access of 0 bytes at {}", ea);
  if (!is_mapped(ea, bytes, wanted)) return describe(ea, bytes, wanted);
  if (auto outside = check_allocation(ea, bytes)) return std::move(*outside);
  return reinterpret_cast<std::byte*>(ea.value);
}

/// Checks that a transfer stays within one block of the program's heap. A block counts up to the end of its last quadword, because
/// otherwise no legal command could move its last bytes.
std::optional<Fault> HostMemory::check_allocation(EffectiveAddress ea, std::uint64_t bytes) const {
  const HostAllocations* allocations = allocations_.load(std::memory_order_acquire);
  if (allocations == nullptr || !allocations->owns(ea.value)) return std::nullopt;
  const auto block = allocations->last_at_or_below(ea.value);
  if (!block) {
    return Fault{.rule = Rule::kEaOutsideAllocation,
                 .detail = "EA lies in the heap, in no block that is allocated"};
  }
  const std::uint64_t offset = ea.value - block->begin;
  const std::string what =
      byte_count(block->bytes) + " at " + hex(block->begin) + ", allocated by " + block->made_at;
  const std::uint64_t usable = round_up_to_quadword(block->bytes);
  if (offset >= usable) {
    return Fault{.rule = Rule::kEaOutsideAllocation,
                 .detail = "EA lies in the heap, in no block that is allocated; " +
                           byte_count(offset - block->bytes) + " past the end of " + what};
  }
  if (!block->live) {
    return Fault{.rule = Rule::kEaOutsideAllocation, .detail = "EA lies in a block that was freed: " + what};
  }
  if (bytes > usable - offset) {
    return Fault{.rule = Rule::kEaOutsideAllocation,
                 .detail = std::to_string(block->bytes - std::min(offset, block->bytes)) + " of " +
                           byte_count(bytes) + " lie in " + what + ", the rest behind its end"};
  }
  return std::nullopt;
}

Fault HostMemory::describe(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const {
  const std::shared_lock lock(mutex_);
  std::uint64_t at = ea.value;
  const Region* region = region_at(regions_, at);
  while (region != nullptr && region->access != SpeAccess::kNone && allows(region->access, wanted) &&
         bytes > region->end - ea.value) {
    at = region->end;
    region = region_at(regions_, at);
  }
  const std::string where =
      at == ea.value ? ""
                     : ", from the " + std::to_string(at - ea.value) + "th of " + byte_count(bytes) + " on";
  if (region == nullptr || region->access == SpeAccess::kNone) {
    if (ea.value >> 32 == 0 && region == nullptr) {
      return {.rule = Rule::kEaNotMapped,
              .detail = ea.value == 0 ? "EA is 0, a null pointer"
                                      : "the program has nothing mapped there" + where +
                                            "; the upper word of EA is 0: was MFC_EAH left out, or a pointer "
                                            "cut to 32 bits?"};
    }
    const std::uint64_t exchanged = ea.value << 32 | ea.value >> 32;
    const Region* const other = region_at(regions_, exchanged);
    return {.rule = Rule::kEaNotMapped,
            .detail = "the program has nothing mapped there" + where +
                      (other == nullptr || other->access == SpeAccess::kNone
                           ? ""
                           : ", but at " + hex(exchanged) +
                                 ": are the halves of EA exchanged? Word 0 of a union is the lower one on a "
                                 "PC; use mfc_ea2h() and mfc_ea2l()")};
  }
  const std::string what = range_of(region->begin, region->end) +
                           (region->name.empty() ? std::string() : " (" + region->name + ")");
  const bool reads = allows(wanted, SpeAccess::kRead) && !allows(region->access, SpeAccess::kRead);
  return {.rule = reads ? Rule::kEaNotReadable : Rule::kEaNotWritable,
          .detail = "the program has mapped " + what +
                    (reads ? " without permission to read" : " without permission to write") + where};
}

}  // namespace softcell::dma
