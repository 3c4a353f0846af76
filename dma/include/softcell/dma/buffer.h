#pragma once
// A typed buffer in emulated memory that frees itself. The PPU side owns it, and SPEs read and write it.

#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/address_space.h"

namespace softcell::dma {

/// size() elements of T, filled with zeros, starting at a line of 128 bytes. Move-only. The PPU side uses
/// span(), SPEs use ea(). The destructor frees it; the address space must outlive it. Construction and
/// destruction are thread safe.
///
///     Buffer<float> heights(space, "heights", 1000, {.spe_access = SpeAccess::kRead});
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>, "DMA moves bytes");
  static_assert(alignof(T) <= kLineBytes, "buffers start at a line of 128 bytes");

 public:
  /// An empty buffer without memory.
  Buffer() = default;

  /// @param options  element_bytes 0, without a record, means sizeof(T) if T is a number or an enumeration.
  /// @throws std::runtime_error  no free range of that memory is large enough; the message gives the sizes.
  /// @throws std::invalid_argument  count is 0.
  Buffer(AddressSpace& space, std::string name, std::size_t count, BufferOptions options = {})
      : space_(&space) {
    if (options.element_bytes == 0 && options.record.empty() &&
        (std::is_arithmetic_v<T> || std::is_enum_v<T>)) {
      options.element_bytes = sizeof(T);
    }
    if (count > std::numeric_limits<std::uint64_t>::max() / sizeof(T))
      throw std::runtime_error("buffer '" + name + "' of " + std::to_string(count) + " elements of " +
                               std::to_string(sizeof(T)) + " bytes: no memory is so large");
    ea_ = space.allocate(std::move(name), count * sizeof(T), options);
    elements_ = {reinterpret_cast<T*>(space.mapping_at(ea_)->host), count};
  }

  Buffer(Buffer&& other) noexcept
      : space_(std::exchange(other.space_, nullptr)),
        ea_(std::exchange(other.ea_, {})),
        elements_(std::exchange(other.elements_, {})) {}

  Buffer& operator=(Buffer&& other) noexcept {
    Buffer moved(std::move(other));
    std::swap(space_, moved.space_);
    std::swap(ea_, moved.ea_);
    std::swap(elements_, moved.elements_);
    return *this;
  }

  ~Buffer() {
    if (space_ != nullptr) space_->free(ea_);
  }

  /// Effective address of the first element, or of element `index`. @pre index <= size()
  EffectiveAddress ea() const { return ea_; }
  EffectiveAddress ea(std::size_t index) const {
    SC_ASSERT(index <= size(), "element {} of a buffer of {}", index, size());
    return ea_ + index * sizeof(T);
  }

  /// The elements in the host's memory. A job that has their address may change them while it runs.
  std::span<T> span() { return elements_; }
  std::span<const T> span() const { return elements_; }
  T* data() { return elements_.data(); }
  const T* data() const { return elements_.data(); }
  /// @pre index < size()
  T& operator[](std::size_t index) {
    SC_ASSERT(index < size(), "element {} of a buffer of {}", index, size());
    return elements_[index];
  }
  const T& operator[](std::size_t index) const {
    SC_ASSERT(index < size(), "element {} of a buffer of {}", index, size());
    return elements_[index];
  }

  std::size_t size() const { return elements_.size(); }
  std::size_t size_bytes() const { return elements_.size_bytes(); }
  bool empty() const { return elements_.empty(); }

 private:
  AddressSpace* space_ = nullptr;
  EffectiveAddress ea_;
  std::span<T> elements_;
};

}  // namespace softcell::dma
