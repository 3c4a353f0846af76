#include "softcell/dma/atomics.h"

#include <stdexcept>

#include "softcell/base/assert.h"
#include "text.h"

namespace softcell::dma {

Atomics::Atomics(AddressSpace& space)
    : reservations_(space.reservations()), translation_(space), holder_(reservations_) {}

void Atomics::load_and_reserve(EffectiveAddress ea, void* to, std::uint32_t bytes) {
  reservations_.load_and_reserve(holder_, ea, host_of(ea, bytes), static_cast<std::byte*>(to), bytes);
}

bool Atomics::store_conditional(EffectiveAddress ea, const void* from, std::uint32_t bytes) {
  return reservations_.store_conditional(holder_, ea, host_of(ea, bytes), static_cast<const std::byte*>(from),
                                         bytes);
}

void Atomics::load(EffectiveAddress ea, void* to, std::uint32_t bytes) {
  reservations_.read(holder_, ea, host_of(ea, bytes), static_cast<std::byte*>(to), bytes);
}

void Atomics::store(EffectiveAddress ea, const void* from, std::uint32_t bytes) {
  reservations_.write(holder_, ea, host_of(ea, bytes), static_cast<const std::byte*>(from), bytes);
}

std::byte* Atomics::host_of(EffectiveAddress ea, std::uint32_t bytes) {
  SC_ASSERT(bytes == 4 || bytes == 8, "an atomic word of {} bytes at {}", bytes, ea);
  if (ea.value % bytes != 0) {
    throw std::invalid_argument("atomic access at EA " + to_text(ea) +
                                ", which is not a multiple of the word's " + byte_count(bytes));
  }
  const auto resolved = translation_.resolve(ea, bytes, SpeAccess::kNone);
  if (const Fault* fault = std::get_if<Fault>(&resolved)) {
    throw std::invalid_argument("atomic access at EA " + to_text(ea) + ": " + fault->detail);
  }
  return std::get<std::byte*>(resolved);
}

}  // namespace softcell::dma
