#pragma once
// The bytes of one transfer on their way, cut at lines of main storage as the hardware cuts them.
//
//   EA        ..|........|........|........|..       lines of 128 bytes
//   transfer        <--------------------->          a piece each: 4 pieces here, moved in any order
//   piece            0    1        2       3

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "softcell/dma/addresses.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/storage_port.h"

namespace softcell::dma {

/// A legal, resolved transfer. Knows nothing of queues, tags or order.
class Transfer {
 public:
  /// One that moves nothing.
  Transfer() = default;

  /// @param from  `bytes` of main storage, 1..16384.
  static Transfer get(const StoragePlace& from, std::byte* to, std::uint32_t bytes) {
    return Transfer(from, to, nullptr, bytes);
  }
  static Transfer put(const std::byte* from, const StoragePlace& to, std::uint32_t bytes) {
    return Transfer(to, nullptr, from, bytes);
  }

  /// Moves whatever has not moved yet.
  void move_rest(StoragePort& port);

  /// Moves one piece: number `choice`, below pieces_left(), of those not moved yet, lowest address first.
  void move_piece(std::uint32_t choice, StoragePort& port);

  std::uint32_t pieces_left() const { return pieces_left_; }

  /// Fills the destination of a get, as the bytes that the hardware leaves in it are nobody's business until
  /// it has ended. @pre nothing has moved.
  void poison() {
    if (to_ != nullptr) fill_local_store(to_, kPoison, size_);
  }
  /// As a float of the SPU about -1.2e17, as an integer about -6e8.
  static constexpr std::byte kPoison{0xDB};

 private:
  // 16384 bytes that start within a line touch one line more than 128.
  static constexpr std::uint32_t kMaxPieces = kMaxTransferBytes / kLineBytes + 1;
  static constexpr std::uint32_t kWordBits = 64;

  Transfer(const StoragePlace& storage, std::byte* to, const std::byte* from, std::uint32_t bytes)
      : storage_(storage),
        to_(to),
        from_(from),
        size_(bytes),
        pieces_((offset_in_line() + bytes + kLineBytes - 1) / kLineBytes),
        pieces_left_(pieces_) {}

  std::uint32_t offset_in_line() const { return static_cast<std::uint32_t>(storage_.ea.value % kLineBytes); }
  void move(std::uint32_t begin, std::uint32_t end, StoragePort& port);
  void move_piece_number(std::uint32_t piece, StoragePort& port);

  StoragePlace storage_;
  std::byte* to_ = nullptr;          // in local store, of a get
  const std::byte* from_ = nullptr;  // in local store, of a put
  std::uint32_t size_ = 0;           // bytes
  std::uint32_t pieces_ = 0;
  std::uint32_t pieces_left_ = 0;
  std::array<std::uint64_t, (kMaxPieces + kWordBits - 1) / kWordBits> moved_{};  // bit p: piece p
};

}  // namespace softcell::dma
