#pragma once
// A list command in progress. It fetches elements from local store in order and keeps a few open at a time,
// so that neighbours may overtake each other.
//
//   elements   0  1  2 [3  4  5  6] 7  8s 9 ...        [ ] open: fetched, not moved completely
//                                         s  stalls and notifies once it and all before it have moved
//
// The stall bit of the last element has no effect. [CBEA, MFC list commands] documented

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/dma/list_element.h"
#include "softcell/dma/transfer.h"

namespace softcell::dma {

/// A legal list command; MfcQueue handles its slot, tags and order. Used by the thread of its MFC.
class ListTransfer {
 public:
  /// A list without elements.
  ListTransfer() = default;
  explicit ListTransfer(const MfcCommand& command) : command_(command), cursor_(command.lsa) {}

  /// True if the next element may be fetched now.
  bool can_open() const { return next_ < count() && open_ < kWindow && !stalls_; }

  /// Fetches the next element. @pre can_open(). @return  the element, or the rule that it breaks.
  std::variant<ListElement, Fault> open_next(std::span<std::byte> local_store, StoragePort& port);

  /// Number of elements that were fetched and still have bytes to move.
  std::uint32_t open_elements() const { return open_; }

  /// The open element that was fetched last. @pre open_elements() is not 0
  Transfer& newest_open() {
    SC_ASSERT(open_ != 0, "no element of {} is open, the next is {}", count(), next_);
    return transfers_[open_ - 1];
  }

  /// Moves all bytes of the open elements.
  void move_open(StoragePort& port);

  /// Moves one piece of open element `which`, as Transfer::move_piece(). @pre which < open_elements()
  void move_piece(std::uint32_t which, std::uint32_t choice, StoragePort& port);
  std::uint32_t pieces_left(std::uint32_t which) const {
    SC_ASSERT(which < open_, "open element {} of {}", which, open_);
    return transfers_[which].pieces_left();
  }

  /// True after all elements up to one with the stall bit have moved. The list then waits for resume().
  bool is_stalled() const { return stalls_ && open_ == 0; }
  /// Continues after the stall. @pre is_stalled()
  void resume() {
    SC_ASSERT(is_stalled(), "a list that has not stalled resumes at element {} of {}", next_, count());
    stalls_ = false;
  }
  /// True if the list has stalled after the element fetched last, or will.
  bool stalls() const { return stalls_; }

  bool is_done() const { return next_ == count() && open_ == 0; }

  const MfcCommand& command() const { return command_; }
  /// Index of the element that is fetched next.
  std::uint32_t next() const { return next_; }
  std::uint32_t count() const { return command_.size / kListElementBytes; }

 private:
  static constexpr std::uint32_t kWindow = 4;

  MfcCommand command_;
  LocalStoreAddress cursor_;  // of the next element's bytes
  std::uint32_t next_ = 0;
  std::uint32_t open_ = 0;
  bool stalls_ = false;  // the element fetched last has the stall bit, and others follow
  std::array<Transfer, kWindow> transfers_;
};

/// Element `index` of a list, as it is in local store now. @param is_big_endian  the byte order of the local store.
/// @pre it lies in the list and in the local store
ListElement read_element(std::span<const std::byte> local_store, const MfcCommand& command,
                         std::uint32_t index, bool is_big_endian = false);

}  // namespace softcell::dma
