#include "softcell/dma/address_space.h"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "arena.h"
#include "host_access.h"
#include "host_memory.h"
#include "local_stores.h"
#include "reserved_addresses.h"
#include "softcell/base/assert.h"
#include "softcell/dma/local_store_port.h"
#include "text.h"

namespace softcell::dma {
namespace {

const char* memory_name(Memory memory) { return memory == Memory::kMain ? "main memory" : "video memory"; }

/// Host addresses for local stores, inaccessible so far: below 4 GB, where the pointers of a kernel with the
/// SPU's data model reach. Best where lv2 has raw SPUs, so that a program finds them there, or else anywhere.
EffectiveAddress reserve_local_stores(int spes) {
  SC_ASSERT(spes > 0, "storage for {} SPEs", spes);
  const std::uint64_t bytes = static_cast<std::uint64_t>(spes) * kLocalStoreStrideBytes;
  constexpr std::uint64_t kFirst = 0x1000'0000, kStep = 0x100'0000, kEnd = 0x1'0000'0000;
  const auto reserve = [bytes](std::uint64_t at) {
    // The raw system call: see reserved_addresses.cpp.
    const long got = syscall(SYS_mmap, at, bytes, PROT_NONE,
                             MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
    if (static_cast<std::uint64_t>(got) == at) return true;
    if (got != -1) syscall(SYS_munmap, got, bytes);  // a kernel before 4.17
    return false;
  };
  if (reserve(kRawSpusBase)) return {kRawSpusBase};
  for (std::uint64_t at = kFirst; at + bytes <= kEnd; at += kStep) {
    if (reserve(at)) return {at};
  }
  throw std::runtime_error("no " + std::to_string(bytes >> 20) +
                           " MB of addresses are free below 4 GB for the local stores of SPEs");
}

constexpr const char* kNoBuffers =
    "this main storage is the program's own memory, which has no buffers; allocate with malloc";

constexpr bool is_element_width(std::uint32_t bytes) {
  return bytes == 0 || bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
}

constexpr std::uint64_t kMegabyte = 1ull << 20;

std::uint64_t checked_main_memory_bytes(std::uint64_t bytes) {
  if (bytes == 0 || bytes % kMegabyte != 0 || bytes > kMaxMainMemoryBytes) {
    throw std::invalid_argument("main memory of " + byte_count(bytes) +
                                "; it must have whole megabytes (of " + byte_count(kMegabyte) +
                                "), from 1 to " + std::to_string(kMaxMainMemoryBytes / kMegabyte));
  }
  return bytes;
}

}  // namespace

AddressSpace::AddressSpace(std::uint64_t main_memory_bytes)
    : main_(std::make_unique<Arena>(kMainMemoryBase, checked_main_memory_bytes(main_memory_bytes))),
      video_(std::make_unique<Arena>(kVideoMemoryBase, kVideoMemoryBytes)),
      local_stores_(std::make_unique<LocalStores>()),
      reservations_(local_stores_.get()) {
  reserve_effective_addresses();
}

AddressSpace::AddressSpace(const HostProgram& options)
    : host_(std::make_unique<HostMemory>()),
      local_stores_(std::make_unique<LocalStores>(reserve_local_stores(options.spes), options.spes)),
      reservations_(local_stores_.get(), Reservations::Storage::kHostProgram) {
  install_host_access_handlers();
}

AddressSpace::~AddressSpace() {
  if (!is_host_program()) return;
  munmap(reinterpret_cast<void*>(local_stores_->base().value),
         static_cast<std::uint64_t>(local_stores_->spes()) * kLocalStoreStrideBytes);
}

void AddressSpace::set_allocations(const HostAllocations* allocations) {
  SC_ASSERT(is_host_program(), "allocations at {} of storage that has buffers",
            static_cast<const void*>(allocations));
  host_->set_allocations(allocations);
}

EffectiveAddress AddressSpace::local_store_ea(int spe) const {
  SC_ASSERT(spe >= 0 && spe < local_stores_->spes(), "SPE {} of {}", spe, local_stores_->spes());
  return local_stores_->ea_of(spe);
}

std::byte* AddressSpace::host_address_of_local_store(int spe) const {
  return is_host_program() ? reinterpret_cast<std::byte*>(local_store_ea(spe).value) : nullptr;
}

std::uint64_t AddressSpace::allocations_generation() const { return host_->generation(); }

EffectiveAddress AddressSpace::allocate(std::string name, std::uint64_t bytes, const BufferOptions& options) {
  if (bytes == 0) throw std::invalid_argument("buffer '" + name + "' of 0 bytes; at least 1 is needed");
  if (!is_element_width(options.element_bytes)) {
    throw std::invalid_argument("buffer '" + name + "' with elements of " +
                                byte_count(options.element_bytes) +
                                "; allowed are 1, 2, 4, 8, or 0 for mixed ones");
  }
  std::unique_ptr<const ElementLayout> layout;
  if (!options.record.empty()) {
    if (options.element_bytes != 0)
      throw std::invalid_argument("buffer '" + name +
                                  "' with an element width and a record; give one of them");
    try {
      layout = std::make_unique<const ElementLayout>(options.record);
    } catch (const std::invalid_argument& wrong) {
      throw std::invalid_argument("buffer '" + name + "': " + wrong.what());
    }
  }
  if (is_host_program()) throw std::logic_error(kNoBuffers);
  Mapping mapping{.bytes = round_up_to_quadword(bytes),
                  .spe_access = options.spe_access,
                  .memory = options.memory,
                  .element_bytes = options.element_bytes,
                  .layout = layout.get()};
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
      registry_.emplace(mapping.ea.value, NamedBuffer{mapping, std::move(name), bytes, std::move(layout)})
          .second;
  SC_ASSERT(is_new, "the allocator handed out {} twice", mapping.ea);
  return mapping.ea;
}

void AddressSpace::free(EffectiveAddress ea) {
  if (is_host_program()) throw std::logic_error(kNoBuffers);
  NamedBuffer buffer;
  {
    const std::lock_guard lock(registry_mutex_);
    const auto found = registry_.find(ea.value);
    if (found == registry_.end() || local_stores_->contains(ea))
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
  if (spe < 0 || spe >= local_stores_->spes()) {
    throw std::invalid_argument(what + "; SPEs have numbers from 0 to " +
                                std::to_string(local_stores_->spes() - 1));
  }
  const std::span<std::byte> bytes = port.local_store();
  if (bytes.size() != kLocalStoreBytes) {
    throw std::invalid_argument(what + " of " + byte_count(bytes.size()) + "; it must have " +
                                std::to_string(kLocalStoreBytes));
  }
  SC_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % kQuadwordBytes == 0,
            "{} is at {} of the host, not at a quadword", what, bytes.data());
  const EffectiveAddress ea = local_store_ea(spe);
  SC_ASSERT(!is_host_program() || bytes.data() == host_address_of_local_store(spe),
            "{} lies at {} of the host", what, static_cast<const void*>(bytes.data()));
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
  if (spe < 0 || spe >= local_stores_->spes() || registry_.erase(local_store_ea(spe).value) == 0) {
    throw std::invalid_argument("no local store of SPE " + std::to_string(spe) + " is mapped");
  }
  local_stores_->set_port(spe, nullptr);
  generation_.fetch_add(1, std::memory_order_release);
}

std::variant<std::byte*, Fault> AddressSpace::resolve(EffectiveAddress ea, std::uint64_t bytes,
                                                      SpeAccess wanted) const {
  SC_ASSERT(bytes != 0, "an access of 0 bytes at {}", ea);
  if (local_stores_->contains(ea) && local_stores_->is_register(ea)) {
    return local_stores_->resolve_register(ea, bytes, wanted == SpeAccess::kWrite);
  }
  if (is_host_program() && !local_stores_->contains(ea)) {
    auto resolved = host_->resolve(ea, bytes, wanted);
    Fault* const fault = std::get_if<Fault>(&resolved);
    if (fault != nullptr && fault->rule == Rule::kEaNotMapped && local_stores_->is_sum_of_two(ea))
      fault->detail +=
          "; EA is a local store's plus a pointer of a kernel built for the host, which is no offset: "
          "its kernel sends (unsigned)pointer & 0x3FFFF";
    return resolved;
  }
  const std::shared_lock lock(registry_mutex_);
  const auto found = last_at_or_below(ea);
  if (found == registry_.end() || !found->second.mapping.contains(ea)) {
    return Fault{.rule = Rule::kEaNotMapped, .detail = describe_unmapped(ea)};
  }
  const auto& [mapping, name, allocated_bytes, layout] = found->second;
  const std::string buffer =
      "buffer '" + name + "' (" + byte_count(allocated_bytes) + " at " + to_text(mapping.ea) + ")";
  if (mapping.memory == Memory::kVideo && allows(wanted, SpeAccess::kWrite)) {
    return Fault{
        .rule = Rule::kVideoMemoryWrite,
        .detail = buffer + " lies in video memory; put results to main memory, the PPU uploads them"};
  }
  if (!mapping.contains(ea, bytes)) {
    const std::uint64_t offset = ea.value - mapping.ea.value, own = allocated_bytes;
    return Fault{.rule = Rule::kEaCrossesBuffer,
                 .detail = std::to_string(own - std::min(offset, own)) + " of " + byte_count(bytes) +
                           " lie in " + buffer + ", the rest behind its end"};
  }
  if (!mapping.permits(wanted)) {
    const bool reads = allows(wanted, SpeAccess::kRead) && !allows(mapping.spe_access, SpeAccess::kRead);
    return Fault{.rule = reads ? Rule::kEaNotReadable : Rule::kEaNotWritable,
                 .detail = buffer + (reads ? " is closed to gets" : " is closed to puts")};
  }
  return mapping.host_of(ea);
}

std::optional<Mapping> AddressSpace::mapping_at(EffectiveAddress ea, SpeAccess wanted) const {
  if (is_host_program() && !local_stores_->contains(ea)) return host_->mapping_at(ea, wanted);
  const std::shared_lock lock(registry_mutex_);
  const auto found = last_at_or_below(ea);
  if (found == registry_.end() || !found->second.mapping.contains(ea)) return std::nullopt;
  return found->second.mapping;
}

ElementWidths AddressSpace::element_widths_at(EffectiveAddress ea) const {
  if (local_stores_->contains(ea)) return {.element_bytes = local_stores_->is_register(ea) ? 4u : 0u};
  const auto mapping = mapping_at(ea);
  if (!mapping) return {};
  return {.element_bytes = mapping->element_bytes, .layout = mapping->layout, .begin = mapping->ea};
}

std::uint64_t AddressSpace::main_memory_bytes() const {
  if (is_host_program()) throw std::logic_error(kNoBuffers);
  return main_->bytes();
}

std::uint64_t AddressSpace::free_bytes(Memory memory) const {
  if (is_host_program()) throw std::logic_error(kNoBuffers);
  const std::lock_guard lock(arena_mutex_);
  return arena(memory).free_bytes();
}

std::uint64_t AddressSpace::largest_free_range(Memory memory) const {
  if (is_host_program()) throw std::logic_error(kNoBuffers);
  const std::lock_guard lock(arena_mutex_);
  return arena(memory).largest_free_range();
}

AddressSpace::Registry::const_iterator AddressSpace::last_at_or_below(EffectiveAddress ea) const {
  const auto above = registry_.upper_bound(ea.value);
  return above == registry_.begin() ? registry_.end() : std::prev(above);
}

std::string AddressSpace::describe_unmapped(EffectiveAddress ea) const {
  if (!is_host_program() && !is_effective_address(ea.value)) {
    if (ea.value == 0)
      return "EA is 0, where no memory lies; was the address of the data given (argp, --arg, a field of the "
             "job)?";
    if (ea.value >> 32 == 0) {
      return "the upper word of EA is 0, that of main storage is " + hex(kMainMemoryBase.value >> 32) +
             "; was MFC_EAH left out?";
    }
    return "EA is not an address of main storage, whose upper word is " + hex(kMainMemoryBase.value >> 32) +
           "; is it a host pointer?";
  }
  if (local_stores_->contains(ea)) {
    return "EA is in the local store of SPE " + std::to_string(local_stores_->spe_of(ea)) +
           ", which does not exist";
  }
  const auto below = last_at_or_below(ea);
  if (below == registry_.end()) return "no buffer lies there or below";
  const auto& [mapping, name, allocated_bytes, layout] = below->second;
  return "no buffer lies there; the nearest below is '" + name + "' (" + byte_count(allocated_bytes) +
         " at " + to_text(mapping.ea) + "), " + byte_count(ea.value - mapping.ea.value - allocated_bytes) +
         " past its end";
}

}  // namespace softcell::dma
