#pragma once
// Vector types and immediates as a real SPU compiler sees them. [LEXT, data types] documented

// Macros, not type names, as they are there: `vec_float4{...}` and `vec_float4(x)` are no expressions, and
// the word `vector` is taken.
#define __vector __attribute__((vector_size(16)))
#define vector __vector

#define vec_uchar16 __vector unsigned char
#define vec_char16 __vector signed char
#define vec_ushort8 __vector unsigned short
#define vec_short8 __vector signed short
#define vec_uint4 __vector unsigned int
#define vec_int4 __vector signed int
#define vec_ullong2 __vector unsigned long long
#define vec_llong2 __vector signed long long
#define vec_float4 __vector float
#define vec_double2 __vector double
#define qword __vector signed char

namespace softcell_check {

/// An immediate operand: a constant expression between Low and High, a multiple of Step.
template <long long Low, long long High, long long Step, long long Value>
struct Immediate {
  static_assert(Value >= Low && Value <= High, "immediate outside the range of its field");
  static_assert(Value % Step == 0, "immediate with low bits that the instruction drops");
  static constexpr int value = static_cast<int>(Value);
};

}  // namespace softcell_check

// Fields by their width in bits: U unsigned, S signed, W both (the instruction sees the same bits).
#define SC_IMMEDIATE(low, high, step, imm) (::softcell_check::Immediate<low, high, step, (imm)>::value)
#define SC_U7(imm) SC_IMMEDIATE(0, 127, 1, imm)
#define SC_S7(imm) SC_IMMEDIATE(-64, 63, 1, imm)
#define SC_W7(imm) SC_IMMEDIATE(-64, 127, 1, imm)
#define SC_S10(imm) SC_IMMEDIATE(-512, 511, 1, imm)
#define SC_U14(imm) SC_IMMEDIATE(0, 0x3FFF, 1, imm)
#define SC_S16(imm) SC_IMMEDIATE(-0x8000, 0x7FFF, 1, imm)
#define SC_U16(imm) SC_IMMEDIATE(0, 0xFFFF, 1, imm)
#define SC_W16(imm) SC_IMMEDIATE(-0x8000, 0xFFFF, 1, imm)
#define SC_U18(imm) SC_IMMEDIATE(0, 0x3FFFF, 1, imm)
// Addresses in local store, written in bytes and stored in quadwords or words.
#define SC_S10_QUADWORDS(imm) SC_IMMEDIATE(-0x2000, 0x1FFF, 16, imm)
#define SC_S16_WORDS(imm) SC_IMMEDIATE(-0x20000, 0x1FFFF, 4, imm)
#define SC_U16_WORDS(imm) SC_IMMEDIATE(0, 0x3FFFF, 4, imm)

// What the host's compiler has beyond an SPU g++ 7.
#pragma GCC poison \
    __builtin_shufflevector __builtin_convertvector __builtin_bit_cast _Float16 __float128 __m128 __m256
