#include "softcell/dma/list_transfer.h"

#include <cstring>
#include <optional>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_rules.h"

namespace softcell::dma {

ListElement read_element(std::span<const std::byte> local_store, const MfcCommand& command,
                         std::uint32_t index, bool is_big_endian) {
  SC_ASSERT(index < command.size / kListElementBytes, "element {} of a list of {} bytes", index,
            command.size);
  SC_ASSERT(command.list_address().value + (index + 1) * kListElementBytes <= local_store.size(),
            "element {} of the list at {} lies outside the local store", index, command.list_address());
  ListElement element;
  std::memcpy(&element, &local_store[command.list_address().value + index * kListElementBytes],
              sizeof element);
  if (is_big_endian) element = {__builtin_bswap32(element.head), __builtin_bswap32(element.eal)};
  return element;
}

std::variant<ListElement, Fault> ListTransfer::open_next(std::span<std::byte> local_store,
                                                         StoragePort& port) {
  SC_ASSERT(can_open(), "element {} of {} with {} open", next_, count(), open_);
  const ListElement element = read_element(local_store, command_, next_, port.is_big_endian());
  if (std::optional<Fault> fault = check_element(command_, next_, element, cursor_)) {
    return std::move(*fault);
  }
  if (const std::uint32_t bytes = element.size(); bytes != 0) {
    const bool get = command_.is_get();
    auto resolved = port.resolve(element.ea(command_), bytes, get ? SpeAccess::kRead : SpeAccess::kWrite);
    if (auto* fault = std::get_if<Fault>(&resolved)) {
      fault->command = command_;
      fault->detail = describe_element(command_, next_, fault->detail);
      return std::move(*fault);
    }
    const auto& place = std::get<StoragePlace>(resolved);
    std::byte* local = &local_store[element.local_address(cursor_).value];
    transfers_[open_++] = get ? Transfer::get(place, local, bytes) : Transfer::put(local, place, bytes);
  }
  cursor_ = element.next(cursor_);
  ++next_;
  stalls_ = element.stalls() && next_ < count();
  return element;
}

void ListTransfer::move_open(StoragePort& port) {
  for (std::uint32_t which = 0; which < open_; ++which) transfers_[which].move_rest(port);
  open_ = 0;
}

void ListTransfer::move_piece(std::uint32_t which, std::uint32_t choice, StoragePort& port) {
  SC_ASSERT(which < open_, "open element {} of {}", which, open_);
  transfers_[which].move_piece(choice, port);
  if (transfers_[which].pieces_left() == 0) transfers_[which] = transfers_[--open_];
}

}  // namespace softcell::dma
