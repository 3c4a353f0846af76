#include "softcell/dma/transfer.h"

#include <algorithm>
#include <bit>

namespace softcell::dma {

void Transfer::move_remaining_pieces(StoragePort& port) {
  for (std::uint32_t piece = 0; piece < pieces_; ++piece) {
    if ((moved_[piece / kWordBits] >> (piece % kWordBits) & 1) == 0) move_piece_number(piece, port);
  }
}

void Transfer::move_piece(std::uint32_t choice, StoragePort& port) {
  std::uint32_t word = 0;
  for (std::uint32_t unset = 0; choice >= (unset = static_cast<std::uint32_t>(std::popcount(~moved_[word])));
       ++word) {
    choice -= unset;
  }
  std::uint64_t bits = ~moved_[word];
  for (; choice != 0; --choice) bits &= bits - 1;
  const std::uint64_t lowest = bits & -bits;
  move_piece_number(word * kWordBits + static_cast<std::uint32_t>(std::countr_zero(lowest)), port);
  moved_[word] |= lowest;
  --pieces_left_;
}

void Transfer::move_piece_number(std::uint32_t piece, StoragePort& port) {
  const std::uint32_t begin = piece == 0 ? 0 : piece * kLineBytes - offset_in_line();
  const std::uint32_t end = std::min(size_, (piece + 1) * kLineBytes - offset_in_line());
  move(begin, end, port);
}

}  // namespace softcell::dma
