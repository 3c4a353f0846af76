#include "softcell/dma/transfer.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace softcell::dma {

Transfer::Transfer(const MfcCommand& command, std::byte* local_store, std::byte* storage)
    : size_(command.size), offset_in_line_(static_cast<std::uint32_t>(command.ea.value % kLineBytes)) {
  std::byte* local = local_store + command.lsa.value;
  to_ = command.is_get() ? local : storage;
  from_ = command.is_get() ? storage : local;
  pieces_ = pieces_left_ = (offset_in_line_ + size_ + kLineBytes - 1) / kLineBytes;
  std::uint32_t bits = pieces_;
  for (std::uint64_t& word : pending_) {
    const std::uint32_t here = std::min(bits, kWordBits);
    word = here == 0 ? 0 : ~std::uint64_t{0} >> (kWordBits - here);
    bits -= here;
  }
}

void Transfer::move_rest() {
  if (pieces_left_ == pieces_) {
    std::memcpy(to_, from_, size_);
  } else {
    for (std::uint32_t piece = 0; piece < pieces_; ++piece) {
      if (pending_[piece / kWordBits] >> (piece % kWordBits) & 1) move(piece);
    }
  }
  pending_.fill(0);
  pieces_left_ = 0;
}

void Transfer::move_piece(std::uint32_t choice) {
  std::uint32_t word = 0;
  for (std::uint32_t set = 0; choice >= (set = static_cast<std::uint32_t>(std::popcount(pending_[word])));
       ++word) {
    choice -= set;
  }
  std::uint64_t bits = pending_[word];
  for (; choice != 0; --choice) bits &= bits - 1;
  const std::uint64_t lowest = bits & -bits;
  move(word * kWordBits + static_cast<std::uint32_t>(std::countr_zero(lowest)));
  pending_[word] &= ~lowest;
  --pieces_left_;
}

void Transfer::move(std::uint32_t piece) {
  const std::uint32_t begin = piece == 0 ? 0 : piece * kLineBytes - offset_in_line_;
  const std::uint32_t end = std::min(size_, (piece + 1) * kLineBytes - offset_in_line_);
  std::memcpy(to_ + begin, from_ + begin, end - begin);
}

}  // namespace softcell::dma
