#pragma once
// A list command under way: elements are fetched from local store in order, and a few are open at a time, so
// that neighbours may overtake each other.
//
//   elements   0  1  2 [3  4  5  6] 7  8s 9 ...        [ ] open: fetched, not all moved
//                                         s  stalls and notifies once it and all before it have moved
//
// The last element never stalls, whatever its bit. [CBEA, MFC list commands] documented

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "softcell/dma/list_element.h"
#include "softcell/dma/transfer.h"

namespace softcell::dma {

/// A legal list command. Knows nothing of queues, tags or order.
class ListTransfer {
 public:
  /// One without elements.
  ListTransfer() = default;
  explicit ListTransfer(const MfcCommand& command) : command_(command), cursor_(command.lsa) {}

  /// Whether the next element may be fetched now.
  bool can_open() const { return next_ < count() && open_ < kWindow && !stalls_; }

  /// Fetches the next element. @pre can_open(). @return it, or the rule that it breaks.
  std::variant<ListElement, Fault> open_next(std::span<std::byte> local_store, StoragePort& port);

  /// Elements that have been fetched and have bytes to move.
  std::uint32_t open_elements() const { return open_; }

  /// The one fetched last. @pre there is one.
  Transfer& newest_open() { return transfers_[open_ - 1]; }

  /// Moves all bytes of the open elements.
  void move_open(StoragePort& port);

  /// Moves one piece of open element `which`, below open_elements(), as Transfer::move_piece().
  void move_piece(std::uint32_t which, std::uint32_t choice, StoragePort& port);
  std::uint32_t pieces_left(std::uint32_t which) const { return transfers_[which].pieces_left(); }

  /// All up to an element with the stall bit has moved: nothing goes on until resume().
  bool is_stalled() const { return stalls_ && open_ == 0; }
  void resume() { stalls_ = false; }
  /// Whether it has stalled behind the element fetched last, or will.
  bool stalls() const { return stalls_; }

  bool is_done() const { return next_ == count() && open_ == 0; }

  const MfcCommand& command() const { return command_; }
  /// The index of the element to be fetched next.
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

/// Element `index` of a list as it stands in local store now.
ListElement read_element(std::span<const std::byte> local_store, const MfcCommand& command,
                         std::uint32_t index);

}  // namespace softcell::dma
