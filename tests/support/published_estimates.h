#pragma once
// Published test vectors of the SPU's estimates, as words: what the intrinsics and the interpreter's model are both held to.

#include <cstdint>

namespace softcell::test {

struct PublishedEstimate {
  std::uint32_t x;
  std::uint32_t reciprocal, interpolated_reciprocal;  ///< frest of x; fi of x and that
  std::uint32_t root, interpolated_root;              ///< frsqest of x, for 1 / sqrt(|x|); fi of x and that
};

inline constexpr PublishedEstimate kPublishedEstimates[] = {
    {0x00000000, 0x7FFFFBE0, 0x7FFFF800, 0x7FB50160, 0x7FB50000},
    {0x80000000, 0xFFFFFBE0, 0xFFFFF800, 0x7FB50160, 0x7FB50000},
    {0x00800000, 0x7E7FFBE0, 0x7E7FF800, 0x5EFFFDF4, 0x5EFFFC00},
    {0x3F800000, 0x3F7FFBE0, 0x3F7FF800, 0x3F7FFDF4, 0x3F7FFC00},
    {0x40000000, 0x3EFFFBE0, 0x3EFFF800, 0x3F350160, 0x3F350000},
    {0x40400000, 0x3EAAA9BE, 0x3EAAA800, 0x3F13CCC0, 0x3F13CC00},
    {0x3F000000, 0x3FFFFBE0, 0x3FFFF800, 0x3FB50160, 0x3FB50000},
    {0x41200000, 0x3DCCCA7E, 0x3DCCC800, 0x3EA1E4F9, 0x3EA1E400},
    {0x7E800000, 0x007FFBE0, 0x007FF800, 0x1FFFFDF4, 0x1FFFFC00},
};

}  // namespace softcell::test
