#pragma once
// Main storage: main memory and video memory behind effective addresses, handed out as named buffers.
//
//   0x5EA010000000  main memory, 256 MB *  +--------+--------+-----------+
//   0x5EA0C0000000  video memory, 256 MB   | buffer | buffer |   free    |  each starts at a line
//   0x5EA0F0000000  local store of SPE 0, 256 KB, and its registers; those of SPE n are n MB further up
//
//   * as on a PS3; your own address space can have from 1 MB to 2816 MB
//
// The bytes lie somewhere else in the host's memory. Host pointers belong to the PPU side, effective addresses to the SPEs, and only
// resolve() translates one to the other.
//
// Main storage may also be the memory of the host program itself (HostProgram). Then effective addresses are
// the program's own pointers, checked against what the process has mapped:
//
//   anything that is mapped               as its page permits
//   below 4 GB, 1 MB for each SPE         local stores and registers, as above; a local store's address is
//                                         a pointer to its bytes

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <variant>

#include "softcell/dma/addresses.h"
#include "softcell/dma/element_layout.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/reservations.h"

namespace softcell::dma {

class Arena;
class HostAllocations;
class HostMemory;
class LocalStorePort;
class LocalStores;

/// Which memory a buffer lies in.
enum class Memory : std::uint8_t { kMain, kVideo };

/// What SPEs may do with a buffer, or what a command needs: a get reads, a put writes.
enum class SpeAccess : std::uint8_t { kNone = 0, kRead = 1, kWrite = 2, kReadWrite = 3 };

constexpr bool allows(SpeAccess granted, SpeAccess wanted) {
  return (static_cast<unsigned>(wanted) & ~static_cast<unsigned>(granted)) == 0;
}

/// Options of a new buffer.
struct BufferOptions {
  SpeAccess spe_access = SpeAccess::kReadWrite;  ///< SPEs can never write to video memory
  Memory memory = Memory::kMain;
  /// Size of one element in bytes, 1, 2, 4 or 8, for engines that swap the byte order; 0 for elements of
  /// mixed or unknown width.
  std::uint32_t element_bytes = 0;
  /// Instead of element_bytes: the widths of a structure's members, which repeat to the buffer's end. The allocation copies it.
  std::span<const ElementRun> record = {};
};

/// The width of the numbers at an address, for engines that swap the byte order.
struct ElementWidths {
  std::uint32_t element_bytes = 0;        ///< of all elements; 0: bytes, or as `layout` says
  const ElementLayout* layout = nullptr;  ///< of the buffer, valid as long as the buffer
  EffectiveAddress begin = {};            ///< of the buffer
};

/// One buffer as the MFC sees it.
struct Mapping {
  EffectiveAddress ea = {};
  /// The buffer's size rounded up to a quadword: otherwise no legal command could move the last bytes.
  std::uint64_t bytes = 0;
  std::byte* host = nullptr;
  SpeAccess spe_access = SpeAccess::kNone;
  Memory memory = Memory::kMain;
  std::uint32_t element_bytes = 0;
  const ElementLayout* layout = nullptr;  ///< for elements of several widths

  bool contains(EffectiveAddress address) const { return address.value - ea.value < bytes; }
  bool contains(EffectiveAddress address, std::uint64_t size) const {
    return contains(address) && size <= bytes - (address.value - ea.value);
  }
  /// True if SPEs may access this buffer in this way.
  bool permits(SpeAccess wanted) const {
    return allows(spe_access, wanted) && (memory != Memory::kVideo || !allows(wanted, SpeAccess::kWrite));
  }
  std::byte* host_of(EffectiveAddress address) const { return host + (address.value - ea.value); }
};

/// Options of storage that is the host program's memory.
struct HostProgram {
  int spes = 256;  ///< how many SPEs can be mapped
};

/// Main storage. All functions are thread safe: the PPU side may allocate while SPEs resolve addresses. A
/// process may have several address spaces; they share their addresses and have separate bytes. An address
/// space must outlive its buffers and every MFC that uses it.
class AddressSpace {
 public:
  /// Reserves host address space for main memory and 256 MB of video memory; the host provides memory for a
  /// page when it is first touched. Once per process, it also makes the host addresses that are equal to
  /// effective addresses inaccessible.
  /// @param main_memory_bytes  whole megabytes (2^20 bytes), up to kMaxMainMemoryBytes.
  /// @throws std::invalid_argument  another size of main memory.
  /// @throws std::runtime_error     the host has no address range left.
  explicit AddressSpace(std::uint64_t main_memory_bytes = kMainMemoryBytes);

  /// Makes the memory of this process main storage. Such storage has no buffers: allocate() and free() throw. It reserves 1 MB of host
  /// addresses below 4 GB for each SPE. From now on it handles SIGSEGV and SIGBUS, for transfers whose bytes are unmapped while they move:
  /// such a transfer ends with the fault ea-not-mapped.
  /// @throws std::runtime_error  there is no such range left.
  explicit AddressSpace(const HostProgram& options);
  ~AddressSpace();
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

  /// Allocates a buffer, filled with zeros, at the lowest address that has room. Prefer Buffer<T>, which
  /// frees itself.
  /// @param name   for messages.
  /// @param bytes  at least 1; the buffer occupies whole lines of 128 bytes.
  /// @return  its address, a multiple of 128.
  /// @throws std::runtime_error  no free range is large enough; the message gives the sizes.
  /// @throws std::invalid_argument  zero bytes, an element width other than 0, 1, 2, 4 and 8, both a width and a record, or
  ///                                a record that ElementLayout refuses.
  /// @throws std::logic_error  is_host_program()
  EffectiveAddress allocate(std::string name, std::uint64_t bytes, const BufferOptions& options = {});

  /// Frees a buffer. @pre no command is in flight to or from it
  /// @throws std::invalid_argument  no buffer begins at `ea`.
  /// @throws std::logic_error       is_host_program()
  void free(EffectiveAddress ea);

  /// Whether this storage is the memory of the host program.
  bool is_host_program() const { return host_ != nullptr; }

  /// For the memory of a host program: sets the allocator that knows the program's blocks, by which the rule ea-outside-allocation is
  /// checked. Null: the rule is not checked. `allocations` must outlive this object. @pre is_host_program()
  void set_allocations(const HostAllocations* allocations);

  /// The address of this SPE's local store, mapped or not.
  /// @pre  0 <= spe < kSpeCount; in a host program's memory, 0 <= spe < HostProgram::spes
  EffectiveAddress local_store_ea(int spe) const;

  /// The host address at which this SPE's local store must lie; null: anywhere.
  std::byte* host_address_of_local_store(int spe) const;

  /// Maps an SPE at local_store_ea(spe): its local store for any access, and its registers Sig_Notify_1,
  /// Sig_Notify_2 and SPU_In_Mbox for writes of 4 bytes. Every write that goes through reservations() calls
  /// the port.
  /// @param spe   0..5, or below the number of HostProgram.
  /// @param port  must live until unmap_local_store().
  /// @throws std::invalid_argument  `spe` is out of range or mapped already, or the local store has another
  ///                                size than 256 KB.
  void map_local_store(int spe, LocalStorePort& port);

  /// Unmaps the SPE. @pre no command is in flight to or from it
  /// @throws std::invalid_argument  the SPE is not mapped.
  void unmap_local_store(int spe);

  /// Translates [ea, ea + bytes) to the host's bytes. The range must lie within one buffer that permits
  /// `wanted`.
  /// @param bytes   at least 1.
  /// @param wanted  the access; kNone, for the PPU side, needs no permission.
  /// @return  the host pointer, or a fault with rule and detail set: ea-not-mapped, ea-crosses-buffer,
  ///          ea-not-readable, ea-not-writable, video-memory-write or register-access. The pointer for a
  ///          register must be passed to Reservations::write() only: there are no bytes behind it.
  /// @note    Takes a shared lock. An MFC goes through its TranslationCache instead.
  std::variant<std::byte*, Fault> resolve(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const;

  /// The buffer or local store that contains `ea`, if any.
  /// @param wanted  in a host program's memory: looks for an access that the page permits.
  std::optional<Mapping> mapping_at(EffectiveAddress ea, SpeAccess wanted = SpeAccess::kNone) const;

  /// The element widths at `ea`: those of a typed buffer or a register; none for plain bytes, as in local stores and the memory of a host
  /// program.
  ElementWidths element_widths_at(EffectiveAddress ea) const;

  /// A number that changes whenever a mapping ends. Code that keeps copies of mappings must drop them then.
  std::uint64_t generation() const {
    const std::uint64_t own = generation_.load(std::memory_order_acquire);
    return is_host_program() ? own + allocations_generation() : own;  // both only grow
  }

  /// The reservations of this storage. Every copy that must respect reserved lines goes through them.
  Reservations& reservations() const { return reservations_; }

  /// The size of main memory. @throws std::logic_error  is_host_program()
  std::uint64_t main_memory_bytes() const;

  /// Free bytes: the sum, and the size of the largest free range. @throws std::logic_error  is_host_program()
  std::uint64_t free_bytes(Memory memory) const;
  std::uint64_t largest_free_range(Memory memory) const;

 private:
  struct NamedBuffer {
    Mapping mapping;
    std::string name;
    std::uint64_t allocated_bytes = 0;  // as asked for
    std::unique_ptr<const ElementLayout> layout = nullptr;
  };
  using Registry = std::map<std::uint64_t, NamedBuffer>;  // by effective address

  std::uint64_t allocations_generation() const;
  Arena& arena(Memory memory) const { return memory == Memory::kMain ? *main_ : *video_; }
  Registry::const_iterator last_at_or_below(EffectiveAddress ea) const;  // registry_mutex_ held
  std::string describe_unmapped(EffectiveAddress ea) const;              // registry_mutex_ held

  mutable std::mutex arena_mutex_;  // guards the arenas; never taken while registry_mutex_ is held
  std::unique_ptr<Arena> main_;
  std::unique_ptr<Arena> video_;

  mutable std::shared_mutex registry_mutex_;
  Registry registry_;
  std::atomic<std::uint64_t> generation_{1};

  const std::unique_ptr<HostMemory> host_;  ///< null: main and video memory of softcell
  const std::unique_ptr<LocalStores> local_stores_;
  mutable Reservations reservations_;
};

}  // namespace softcell::dma
