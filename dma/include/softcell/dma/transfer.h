#pragma once
// A transfer in progress, cut into pieces at lines of main storage as the hardware cuts it.
//
//   EA        ..|........|........|........|..       lines of 128 bytes
//   transfer        <--------------------->          a piece each: 4 pieces here, moved in any order
//   piece            0    1        2       3

#include <array>
#include <cstddef>
#include <cstdint>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/dma/storage_port.h"

namespace softcell::dma {

/// A legal, translated transfer; MfcQueue handles its slot, tags and order. Used by the thread of its MFC.
class Transfer {
 public:
  /// A transfer of no bytes.
  Transfer() = default;

  /// @param from  `bytes` of main storage, 1..16384.
  static Transfer get(const StoragePlace& from, std::byte* to, std::uint32_t bytes) {
    return Transfer(from, to, nullptr, bytes);
  }
  static Transfer put(const std::byte* from, const StoragePlace& to, std::uint32_t bytes) {
    return Transfer(to, nullptr, from, bytes);
  }

  /// Moves all bytes that have not moved yet.
  void move_rest(StoragePort& port);

  /// Moves one piece: number `choice` of those that have not moved yet, lowest address first.
  /// @pre  choice < pieces_left()
  void move_piece(std::uint32_t choice, StoragePort& port);

  std::uint32_t pieces_left() const { return pieces_left_; }

  /// Fills the destination of a get with kPoison: until the get is complete, its contents are undefined.
  /// @pre  nothing has moved
  void poison() {
    SC_ASSERT(pieces_left_ == pieces_, "{} of {} pieces have moved", pieces_ - pieces_left_, pieces_);
    if (to_ != nullptr) fill_local_store(to_, kPoison, size_);
  }
  /// The byte of poison: a float of it is about -1.2e17 on the SPU, an integer about -6e8.
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
        pieces_left_(pieces_) {
    SC_ASSERT(bytes != 0 && pieces_ <= kMaxPieces, "a transfer of {} bytes at {}", bytes, storage.ea);
  }

  std::uint32_t offset_in_line() const { return static_cast<std::uint32_t>(storage_.ea.value % kLineBytes); }
  void move(std::uint32_t begin, std::uint32_t end, StoragePort& port);
  void move_piece_number(std::uint32_t piece, StoragePort& port);

  StoragePlace storage_;
  std::byte* to_ = nullptr;          // in local store, for a get
  const std::byte* from_ = nullptr;  // in local store, for a put
  std::uint32_t size_ = 0;           // bytes
  std::uint32_t pieces_ = 0;
  std::uint32_t pieces_left_ = 0;
  std::array<std::uint64_t, (kMaxPieces + kWordBits - 1) / kWordBits> moved_{};  // bit p: piece p
};

}  // namespace softcell::dma
