#include "softcell/dma/address_space.h"

#include <iterator>
#include <stdexcept>

#include "arena.h"
#include "local_stores.h"
#include "reserved_addresses.h"
#include "softcell/base/assert.h"
#include "softcell/dma/local_store_port.h"
#include "text.h"

namespace softcell::dma {
namespace {

const char* memory_name(Memory memory) { return memory == Memory::kMain ? "main memory" : "video memory"; }

constexpr std::uint64_t round_up_to_quadword(std::uint64_t bytes) {
  return (bytes + kQuadwordBytes - 1) / kQuadwordBytes * kQuadwordBytes;
}

constexpr bool is_element_width(std::uint32_t bytes) {
  return bytes == 0 || bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
}

}  // namespace

AddressSpace::AddressSpace()
    : main_(std::make_unique<Arena>(kMainMemoryBase, kMainMemoryBytes)),
      video_(std::make_unique<Arena>(kVideoMemoryBase, kVideoMemoryBytes)),
      local_stores_(std::make_unique<LocalStores>()),
      reservations_(local_stores_.get()) {
  reserve_effective_addresses();
}

AddressSpace::~AddressSpace() = default;

EffectiveAddress AddressSpace::allocate(std::string name, std::uint64_t bytes, const BufferOptions& options) {
  if (bytes == 0) throw std::invalid_argument("buffer '" + name + "' of 0 bytes; at least 1 is needed");
  if (!is_element_width(options.element_bytes)) {
    throw std::invalid_argument("buffer '" + name + "' with elements of " +
                                byte_count(options.element_bytes) +
                                "; allowed are 1, 2, 4, 8, or 0 for mixed ones");
  }
  Mapping mapping{.bytes = round_up_to_quadword(bytes),
                  .spe_access = options.spe_access,
                  .memory = options.memory,
                  .element_bytes = options.element_bytes};
  {
    const std::lock_guard lock(arena_mutex_);
    Arena& memory = arena(options.memory);
    const std::optional<EffectiveAddress> ea = memory.allocate(bytes);
    if (!ea) {
      throw std::runtime_error("no room in " + std::string(memory_name(options.memory)) + " for buffer '" +
                               name + "' of " + byte_count(bytes) + ": " + byte_count(memory.free_bytes()) +
                               " of " + std::to_string(memory.bytes()) + " are free, " +
                               std::to_string(memory.largest_free_range()) + " in the largest piece");
    }
    mapping.ea = *ea;
    SC_ASSERT(ea->value % kLineBytes == 0, "buffer '{}' begins at {}, not at a line", name, *ea);
    mapping.host = memory.host(*ea);
  }
  const std::lock_guard lock(registry_mutex_);
  const bool is_new =
      registry_.emplace(mapping.ea.value, NamedBuffer{mapping, std::move(name), bytes}).second;
  SC_ASSERT(is_new, "the allocator handed out {} twice", mapping.ea);
  return mapping.ea;
}

void AddressSpace::free(EffectiveAddress ea) {
  NamedBuffer buffer;
  {
    const std::lock_guard lock(registry_mutex_);
    const auto found = registry_.find(ea.value);
    if (found == registry_.end() || LocalStores::contains(ea))
      throw std::invalid_argument("no buffer begins at EA " + to_text(ea));
    buffer = std::move(found->second);
    registry_.erase(found);
    generation_.fetch_add(1, std::memory_order_release);
  }
  const std::lock_guard lock(arena_mutex_);
  arena(buffer.mapping.memory).free(ea, buffer.allocated_bytes);
}

void AddressSpace::map_local_store(int spe, LocalStorePort& port) {
  const std::string what = "local store of SPE " + std::to_string(spe);
  if (spe < 0 || spe >= kSpeCount)
    throw std::invalid_argument(what + "; SPEs have numbers from 0 to " + std::to_string(kSpeCount - 1));
  const std::span<std::byte> bytes = port.local_store();
  if (bytes.size() != kLocalStoreBytes) {
    throw std::invalid_argument(what + " of " + byte_count(bytes.size()) + "; it must have " +
                                std::to_string(kLocalStoreBytes));
  }
  SC_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % kQuadwordBytes == 0,
            "{} is at {} of the host, not at a quadword", what, bytes.data());
  const EffectiveAddress ea = local_store_ea(spe);
  const Mapping mapping{
      .ea = ea, .bytes = bytes.size(), .host = bytes.data(), .spe_access = SpeAccess::kReadWrite};
  const std::lock_guard lock(registry_mutex_);
  if (!registry_.emplace(ea.value, NamedBuffer{mapping, what, bytes.size()}).second) {
    throw std::invalid_argument(what + " is mapped already, by another group or pool of this memory");
  }
  local_stores_->set_port(spe, &port);
}

void AddressSpace::unmap_local_store(int spe) {
  const std::lock_guard lock(registry_mutex_);
  if (spe < 0 || spe >= kSpeCount || registry_.erase(local_store_ea(spe).value) == 0) {
    throw std::invalid_argument("no local store of SPE " + std::to_string(spe) + " is mapped");
  }
  local_stores_->set_port(spe, nullptr);
  generation_.fetch_add(1, std::memory_order_release);
}

std::variant<std::byte*, Fault> AddressSpace::resolve(EffectiveAddress ea, std::uint64_t bytes,
                                                      SpeAccess wanted) const {
  SC_ASSERT(bytes != 0, "an access of 0 bytes at {}", ea);
  if (LocalStores::contains(ea) && LocalStores::is_register(ea)) {
    return local_stores_->resolve_register(ea, bytes, wanted == SpeAccess::kWrite);
  }
  const std::shared_lock lock(registry_mutex_);
  const auto found = last_at_or_below(ea);
  if (found == registry_.end() || !found->second.mapping.contains(ea)) {
    return Fault{.rule = Rule::kEaNotMapped, .detail = describe_unmapped(ea)};
  }
  const auto& [mapping, name, allocated_bytes] = found->second;
  const std::string buffer =
      "buffer '" + name + "' (" + byte_count(allocated_bytes) + " at " + to_text(mapping.ea) + ")";
  if (mapping.memory == Memory::kVideo && allows(wanted, SpeAccess::kWrite)) {
    return Fault{
        .rule = Rule::kVideoMemoryWrite,
        .detail = buffer + " lies in video memory; put results to main memory, the PPU uploads them"};
  }
  if (!mapping.contains(ea, bytes)) {
    return Fault{.rule = Rule::kEaCrossesBuffer,
                 .detail = std::to_string(mapping.bytes - (ea.value - mapping.ea.value)) + " of " +
                           byte_count(bytes) + " lie in " + buffer + ", the rest behind its end"};
  }
  if (!mapping.permits(wanted)) {
    const bool reads = allows(wanted, SpeAccess::kRead) && !allows(mapping.spe_access, SpeAccess::kRead);
    return Fault{.rule = reads ? Rule::kEaNotReadable : Rule::kEaNotWritable,
                 .detail = buffer + (reads ? " is closed to gets" : " is closed to puts")};
  }
  return mapping.host_of(ea);
}

std::optional<Mapping> AddressSpace::mapping_at(EffectiveAddress ea) const {
  const std::shared_lock lock(registry_mutex_);
  const auto found = last_at_or_below(ea);
  if (found == registry_.end() || !found->second.mapping.contains(ea)) return std::nullopt;
  return found->second.mapping;
}

std::uint64_t AddressSpace::free_bytes(Memory memory) const {
  const std::lock_guard lock(arena_mutex_);
  return arena(memory).free_bytes();
}

std::uint64_t AddressSpace::largest_free_range(Memory memory) const {
  const std::lock_guard lock(arena_mutex_);
  return arena(memory).largest_free_range();
}

AddressSpace::Registry::const_iterator AddressSpace::last_at_or_below(EffectiveAddress ea) const {
  const auto above = registry_.upper_bound(ea.value);
  return above == registry_.begin() ? registry_.end() : std::prev(above);
}

std::string AddressSpace::describe_unmapped(EffectiveAddress ea) const {
  if (!is_effective_address(ea.value)) {
    if (ea.value >> 32 == 0) {
      return "the upper word of EA is 0, that of main storage is " + hex(kMainMemoryBase.value >> 32) +
             "; was MFC_EAH left out?";
    }
    return "EA is not an address of main storage, whose upper word is " + hex(kMainMemoryBase.value >> 32) +
           "; is it a host pointer?";
  }
  if (LocalStores::contains(ea)) {
    return "EA is in the local store of SPE " + std::to_string(LocalStores::spe_of(ea)) +
           ", which does not exist";
  }
  const auto below = last_at_or_below(ea);
  if (below == registry_.end()) return "no buffer lies there or below";
  const auto& [mapping, name, allocated_bytes] = below->second;
  return "no buffer lies there; the nearest below is '" + name + "' (" + byte_count(allocated_bytes) +
         " at " + to_text(mapping.ea) + "), " + byte_count(ea.value - mapping.ea.value - allocated_bytes) +
         " past its end";
}

}  // namespace softcell::dma
