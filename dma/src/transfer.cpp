#include "softcell/dma/transfer.h"

#include <algorithm>
#include <bit>

#include "softcell/base/assert.h"

namespace softcell::dma {

void Transfer::move_rest(StoragePort& port) {
  if (pieces_left_ == pieces_) {
    if (size_ != 0) move(0, size_, port);
  } else {
    for (std::uint32_t piece = 0; piece < pieces_; ++piece) {
      if ((moved_[piece / kWordBits] >> (piece % kWordBits) & 1) == 0) move_piece_number(piece, port);
    }
  }
  pieces_left_ = 0;
}

void Transfer::move_piece(std::uint32_t choice, StoragePort& port) {
  SC_ASSERT(choice < pieces_left_, "piece {} of {}", choice, pieces_left_);
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

void Transfer::move(std::uint32_t begin, std::uint32_t end, StoragePort& port) {
  SC_ASSERT(begin < end && end <= size_, "bytes {} to {} of {}", begin, end, size_);
  if (to_ != nullptr) {
    port.read(storage_.after(begin), to_ + begin, end - begin);
  } else {
    port.write(storage_.after(begin), from_ + begin, end - begin);
  }
}

}  // namespace softcell::dma
