#pragma once
// The bytes of one get or put on their way, cut at lines of main storage as the hardware cuts them.
//
//   EA        ..|........|........|........|..       lines of 128 bytes
//   transfer        <--------------------->          a piece each: 4 pieces here, moved in any order
//   piece            0    1        2       3

#include <array>
#include <cstddef>
#include <cstdint>

#include "softcell/dma/addresses.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// A legal, resolved transfer. Knows nothing of queues, tags or order.
class Transfer {
 public:
  Transfer() = default;

  /// @param command      legal (check_command), of the kind get or put.
  /// @param local_store  host address of the local store's byte 0.
  /// @param storage      host address of the command's EA.
  Transfer(const MfcCommand& command, std::byte* local_store, std::byte* storage);

  /// Moves whatever has not moved yet.
  void move_rest();

  /// Moves one piece: number `choice`, below pieces_left(), of those not moved yet, lowest address first.
  void move_piece(std::uint32_t choice);

  std::uint32_t pieces_left() const { return pieces_left_; }

 private:
  // 16384 bytes that start within a line touch one line more than 128.
  static constexpr std::uint32_t kMaxPieces = kMaxTransferBytes / kLineBytes + 1;
  static constexpr std::uint32_t kWordBits = 64;

  void move(std::uint32_t piece);

  std::byte* to_ = nullptr;
  const std::byte* from_ = nullptr;
  std::uint32_t size_ = 0;            // bytes
  std::uint32_t offset_in_line_ = 0;  // of the first byte, in main storage
  std::uint32_t pieces_ = 0;
  std::uint32_t pieces_left_ = 0;
  std::array<std::uint64_t, (kMaxPieces + kWordBits - 1) / kWordBits>
      pending_{};  // bit p: piece p has not moved
};

}  // namespace softcell::dma
