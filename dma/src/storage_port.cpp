#include "softcell/dma/storage_port.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace softcell::dma {
namespace {

using Line = std::array<std::byte, kLineBytes>;

/// The elements from `place` on that have one width.
ElementRun run_at(const StoragePlace& place) {
  if (place.swapped.layout == nullptr)
    return {.bytes = std::numeric_limits<std::uint32_t>::max(), .element_bytes = place.swapped.element_bytes};
  return place.swapped.layout->run_at(place.ea.value - place.swapped.begin.value);
}

template <class Element>
Element swapped(Element value) {
  if constexpr (sizeof(Element) == 2) return __builtin_bswap16(value);
  if constexpr (sizeof(Element) == 4) return __builtin_bswap32(value);
  if constexpr (sizeof(Element) == 8) return __builtin_bswap64(value);
}

template <class Element>
void swap_all(std::byte* data, std::uint32_t bytes) {
  for (std::uint32_t i = 0; i < bytes; i += sizeof(Element)) {
    Element value;
    std::memcpy(&value, data + i, sizeof value);
    value = swapped(value);
    std::memcpy(data + i, &value, sizeof value);
  }
}

/// Swaps the elements of a transfer, whose bytes from `place` are at `data`.
void swap_elements(const StoragePlace& place, std::byte* data, std::uint32_t bytes) {
  for (std::uint32_t done = 0; done < bytes;) {
    const ElementRun run = run_at(place.after(done));
    const std::uint32_t count = std::min(run.bytes, bytes - done);
    SC_ASSERT(count % run.element_bytes == 0, "{} bytes of elements of {}", count, run.element_bytes);
    if (run.element_bytes == 2) swap_all<std::uint16_t>(data + done, count);
    if (run.element_bytes == 4) swap_all<std::uint32_t>(data + done, count);
    if (run.element_bytes == 8) swap_all<std::uint64_t>(data + done, count);
    done += count;
  }
}

/// A transfer of less than an element moves one element, the part that it asks for. That has its mirror image's place: the
/// first byte here is the last one there.
StoragePlace mirrored(const StoragePlace& part, std::uint32_t bytes, std::uint32_t element_bytes) {
  const auto offset = static_cast<std::uint32_t>(part.ea.value % element_bytes);
  SC_ASSERT(offset + bytes <= element_bytes, "{} bytes at {} pass an element of {}", bytes, part.ea,
            element_bytes);
  const std::int64_t distance = std::int64_t{element_bytes} - bytes - 2 * std::int64_t{offset};
  return {
      {part.ea.value + static_cast<std::uint64_t>(distance)}, part.host + distance, {.element_bytes = bytes}};
}

/// Where a transfer's bytes are in the host's order.
StoragePlace on_the_host(const StoragePlace& place, std::uint32_t bytes) {
  const std::uint32_t element_bytes = run_at(place).element_bytes;
  return bytes < element_bytes ? mirrored(place, bytes, element_bytes) : place;
}

}  // namespace

void StoragePort::read_swapped(const StoragePlace& place, std::byte* to, std::uint32_t bytes) {
  SC_ASSERT(bytes <= kMaxTransferBytes, "{} bytes in one transfer", bytes);
  std::array<std::byte, kMaxTransferBytes> data;
  const StoragePlace from = on_the_host(place, bytes);
  reservations_.read(holder_, from.ea, from.host, data.data(), bytes, false);
  swap_elements(from, data.data(), bytes);
  copy_to_local_store(to, data.data(), bytes);
}

void StoragePort::write_swapped(const StoragePlace& place, const std::byte* from, std::uint32_t bytes) {
  std::array<std::byte, kMaxTransferBytes> data;
  const StoragePlace to = on_the_host(place, bytes);
  // Only sdcrz writes more than a transfer's bytes at once.
  for (std::uint32_t done = 0; done < bytes; done += kMaxTransferBytes) {
    const std::uint32_t part = std::min(bytes - done, kMaxTransferBytes);
    std::copy_n(from + done, part, data.data());
    swap_elements(to.after(done), data.data(), part);
    reservations_.write(holder_, to.ea + done, to.host + done, data.data(), part);
  }
}

void StoragePort::load_and_reserve(const StoragePlace& line, std::byte* to) {
  if (!line.is_swapped()) return reservations_.load_and_reserve(holder_, line.ea, line.host, to);
  Line data;
  reservations_.load_and_reserve(holder_, line.ea, line.host, data.data());
  swap_elements(line, data.data(), kLineBytes);
  copy_to_local_store(to, data.data(), kLineBytes);
}

bool StoragePort::store_conditional(const StoragePlace& line, const std::byte* from) {
  if (!line.is_swapped()) return reservations_.store_conditional(holder_, line.ea, line.host, from);
  Line data;
  std::copy_n(from, kLineBytes, data.data());
  swap_elements(line, data.data(), kLineBytes);
  return reservations_.store_conditional(holder_, line.ea, line.host, data.data());
}

void StoragePort::store_line(const StoragePlace& line, const std::byte* from) {
  if (!line.is_swapped()) return reservations_.store_line(holder_, line.ea, line.host, from);
  Line data;
  std::copy_n(from, kLineBytes, data.data());
  swap_elements(line, data.data(), kLineBytes);
  reservations_.store_line(holder_, line.ea, line.host, data.data());
}

}  // namespace softcell::dma
