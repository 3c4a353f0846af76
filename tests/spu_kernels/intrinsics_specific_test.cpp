// The specific intrinsics: each against its line of the instruction set, on registers of sixteen big-endian
// bytes.
#include "intrinsics_support.h"

#include <vector>

namespace softcell::test {
namespace {

class IntrinsicsSpecific : public SpuArithmetic {};

using R = Register;
using u8 = std::uint8_t;
using s8 = std::int8_t;
using u16 = std::uint16_t;
using s16 = std::int16_t;
using u32 = std::uint32_t;
using s32 = std::int32_t;
using u64 = std::uint64_t;
using s64 = std::int64_t;

/// result.element[i] = f(a.element[i], b.., c..) with elements of type T.
template <class T, class F>
R each(const R& a, const R& b, const R& c, F f) {
  R result;
  for (int i = 0; i < static_cast<int>(16 / sizeof(T)); ++i) {
    result.set<T>(i, static_cast<T>(f(a.get<T>(i), b.get<T>(i), c.get<T>(i))));
  }
  return result;
}
s64 hi(u32 w) { return static_cast<s16>(w >> 16); }
s64 lo(u32 w) { return static_cast<s16>(w); }
u32 uhi(u32 w) { return w >> 16; }
u32 ulo(u32 w) { return w & 0xFFFF; }

struct Row {
  const char* name;
  qword (*intrinsic)(qword a, qword b, qword c);
  R (*meaning)(const R& a, const R& b, const R& c);
};

// One row for an instruction: operands, element type, meaning of an element.
#define SC_ROW1(name, T, expression)                                                                    \
  {                                                                                                     \
#name, [](qword a, qword, qword) { return name(a); },                                                 \
   [](const R& ra, const R& rb, const R& rc) { return each<T>(ra, rb, rc, [](T a, T, T) { return expression; }); } \
  }
#define SC_ROW2(name, T, expression)                                                                    \
  {                                                                                                     \
#name, [](qword a, qword b, qword) { return name(a, b); },                                            \
   [](const R& ra, const R& rb, const R& rc) { return each<T>(ra, rb, rc, [](T a, T b, T) { return expression; }); } \
  }
#define SC_ROW3(name, T, expression)                                                                    \
  {                                                                                                     \
#name, [](qword a, qword b, qword c) { return name(a, b, c); },                                       \
   [](const R& ra, const R& rb, const R& rc) { return each<T>(ra, rb, rc, [](T a, T b, T c) { return expression; }); } \
  }
// With an immediate: at the ends of its range, and in between.
#define SC_ROWI(name, imm, T, expression)                                                               \
  {                                                                                                     \
#name " " #imm, [](qword a, qword, qword) { return name(a, imm); },                                   \
   [](const R& ra, const R& rb, const R& rc) {                                                           \
     return each<T>(ra, rb, rc, [](T a, T, T) {                                                          \
       constexpr int i = imm;                                                                            \
       return expression;                                                                                \
     });                                                                                                 \
   } \
  }
#define SC_ROWS10(name, T, expression)                                                                      \
  SC_ROWI(name, -512, T, expression), SC_ROWI(name, -256, T, expression), SC_ROWI(name, -1, T, expression), \
      SC_ROWI(name, 0, T, expression), SC_ROWI(name, 5, T, expression), SC_ROWI(name, 128, T, expression),  \
      SC_ROWI(name, 511, T, expression)
#define SC_ROWS7(name, T, expression)                                                                       \
  SC_ROWI(name, -64, T, expression), SC_ROWI(name, -33, T, expression), SC_ROWI(name, -17, T, expression),  \
      SC_ROWI(name, -16, T, expression), SC_ROWI(name, -5, T, expression), SC_ROWI(name, 0, T, expression), \
      SC_ROWI(name, 7, T, expression), SC_ROWI(name, 16, T, expression), SC_ROWI(name, 31, T, expression),  \
      SC_ROWI(name, 32, T, expression), SC_ROWI(name, 127, T, expression)
// The register as a whole.
#define SC_WHOLE1(name, body)                                                                          \
  {                                                                                                    \
#name, [](qword a, qword, qword) { return name(a); }, [](const R& a, const R&, const R&) -> R body \
  }
#define SC_WHOLE2(name, body)                                                                              \
  {                                                                                                        \
#name,                                                                                                 \
        [](qword a, qword b, qword) { return name(a, b); }, [](const R& a, const R& b, const R&) -> R body \
  }
#define SC_WHOLE3(name, body)                                                                  \
  {                                                                                            \
#name, [](qword a, qword b, qword c) { return name(a, b, c); }, [](const R& a, const R& b, \
                                                                       const R& c) -> R body   \
  }
#define SC_WHOLEI(name, imm, body)                                                                              \
  {                                                                                                             \
#name " " #imm, [](qword a, qword, qword) { return name(a, imm); }, [](const R& a, const R&, const R&) -> R { \
     constexpr int i = imm;                                                                              \
     body                                                                                                \
   } \
  }
#define SC_WHOLES7(name, body)                                                       \
  SC_WHOLEI(name, -64, body), SC_WHOLEI(name, -13, body), SC_WHOLEI(name, -4, body), \
      SC_WHOLEI(name, 0, body), SC_WHOLEI(name, 3, body), SC_WHOLEI(name, 15, body), \
      SC_WHOLEI(name, 16, body), SC_WHOLEI(name, 127, body)

R word0(u32 value) {
  R r;
  r.set<u32>(0, value);
  return r;
}

void run(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    Operands operands(80);
    for (int round = 0; round < kRounds; ++round) {
      const R a = operands.reg(), b = operands.reg(), c = operands.reg();
      const R got = register_of(row.intrinsic(qword_of(a), qword_of(b), qword_of(c)));
      ASSERT_EQ(got, row.meaning(a, b, c)) << row.name << "\n a " << a << "\n b " << b << "\n c " << c;
    }
  }
}

TEST_F(IntrinsicsSpecific, AddSubtractCarry) {
  run({
      SC_ROW2(si_ah, u16, a + b),
      SC_ROW2(si_a, u32, a + b),
      SC_ROW2(si_sfh, u16, b - a),
      SC_ROW2(si_sf, u32, b - a),
      SC_ROWS10(si_ahi, u16, a + i),
      SC_ROWS10(si_ai, u32, a + static_cast<u32>(i)),
      SC_ROWS10(si_sfhi, u16, i - a),
      SC_ROWS10(si_sfi, u32, static_cast<u32>(i) - a),
      SC_ROW3(si_addx, u32, a + b + (c & 1)),
      SC_ROW2(si_cg, u32, (u64{a} + b) >> 32),
      SC_ROW3(si_cgx, u32, (u64{a} + b + (c & 1)) >> 32),
      SC_ROW3(si_sfx, u32, b + ~a + (c & 1)),
      SC_ROW2(si_bg, u32, b >= a ? 1 : 0),
      SC_ROW3(si_bgx, u32, ((c & 1) != 0 ? b >= a : b > a) ? 1 : 0),
  });
}

TEST_F(IntrinsicsSpecific, Multiply) {
  run({
      SC_ROW2(si_mpy, u32, lo(a) * lo(b)),
      SC_ROW2(si_mpyu, u32, ulo(a) * ulo(b)),
      SC_ROWS10(si_mpyi, u32, lo(a) * i),
      SC_ROWS10(si_mpyui, u32, ulo(a) * static_cast<u16>(i)),
      SC_ROW3(si_mpya, u32, lo(a) * lo(b) + c),
      SC_ROW2(si_mpyh, u32, (uhi(a) * ulo(b)) << 16),
      SC_ROW2(si_mpys, u32, (lo(a) * lo(b)) >> 16),
      SC_ROW2(si_mpyhh, u32, hi(a) * hi(b)),
      SC_ROW2(si_mpyhhu, u32, uhi(a) * uhi(b)),
      SC_ROW3(si_mpyhha, u32, hi(a) * hi(b) + c),
      SC_ROW3(si_mpyhhau, u32, uhi(a) * uhi(b) + c),
  });
}

R gathered(const R& a, int elements) {
  u32 bits = 0;
  for (int i = 0; i < elements; ++i)
    bits = bits << 1 | (a.byte[static_cast<std::size_t>((i + 1) * 16 / elements - 1)] & 1u);
  return word0(bits);
}
/// Element i is ones where bit (elements - 1 - i) is set.
R spread(u32 bits, int elements) {
  R r;
  for (std::size_t i = 0; i < 16; ++i) {
    const auto element = static_cast<int>(i) * elements / 16;
    r.byte[i] = (bits >> (elements - 1 - element) & 1) != 0 ? 0xFF : 0;
  }
  return r;
}

TEST_F(IntrinsicsSpecific, BitsMasksAndBytes) {
  run({
      SC_ROW1(si_clz, u32, a == 0 ? 32 : __builtin_clz(a)),
      SC_ROW1(si_cntb, u8, __builtin_popcount(a)),
      SC_WHOLE1(si_fsmb, { return spread(a.w(0), 16); }),
      SC_WHOLE1(si_fsmh, { return spread(a.w(0), 8); }),
      SC_WHOLE1(si_fsm, { return spread(a.w(0), 4); }),
      SC_WHOLE1(si_gbb, { return gathered(a, 16); }),
      SC_WHOLE1(si_gbh, { return gathered(a, 8); }),
      SC_WHOLE1(si_gb, { return gathered(a, 4); }),
      SC_ROW2(si_avgb, u8, (a + b + 1) >> 1),
      SC_ROW2(si_absdb, u8, a > b ? a - b : b - a),
      SC_ROW2(si_sumb, u32,
              ((b & 0xFF) + (b >> 8 & 0xFF) + (b >> 16 & 0xFF) + (b >> 24)) << 16 |
                  ((a & 0xFF) + (a >> 8 & 0xFF) + (a >> 16 & 0xFF) + (a >> 24))),
      SC_ROW1(si_xsbh, u16, static_cast<s8>(a)),
      SC_ROW1(si_xshw, u32, static_cast<s16>(a)),
      SC_ROW1(si_xswd, u64, static_cast<s32>(a)),
      SC_WHOLE1(si_orx, { return word0(a.w(0) | a.w(1) | a.w(2) | a.w(3)); }),
  });
}

TEST_F(IntrinsicsSpecific, Constants) {
  const auto all = [](qword q, auto value) {
    const R r = register_of(q);
    R expected;
    for (int i = 0; i < static_cast<int>(16 / sizeof value); ++i) expected.set(i, value);
    EXPECT_EQ(r, expected);
  };
  all(si_ilh(0x8001), u16{0x8001});
  all(si_ilh(-2), u16{0xFFFE});
  all(si_ilhu(0x8001), u32{0x80010000});
  all(si_ilhu(-2), u32{0xFFFE0000});
  all(si_il(-32768), u32{0xFFFF8000});
  all(si_il(32767), u32{0x00007FFF});
  all(si_ila(0x3FFFF), u32{0x0003FFFF});
  all(si_iohl(si_ilhu(0x1234), 0xFEDC), u32{0x1234FEDC});
  EXPECT_EQ(register_of(si_fsmbi(0x8421)), spread(0x8421, 16));
  EXPECT_EQ(register_of(si_fsmbi(-1)), spread(0xFFFF, 16));
}

TEST_F(IntrinsicsSpecific, Logic) {
  run({
      SC_ROW2(si_and, u32, a & b),
      SC_ROW2(si_andc, u32, a & ~b),
      SC_ROW2(si_or, u32, a | b),
      SC_ROW2(si_orc, u32, a | ~b),
      SC_ROW2(si_xor, u32, a ^ b),
      SC_ROW2(si_nand, u32, ~(a & b)),
      SC_ROW2(si_nor, u32, ~(a | b)),
      SC_ROW2(si_eqv, u32, ~(a ^ b)),
      SC_ROWS10(si_andbi, u8, a & i),
      SC_ROWS10(si_andhi, u16, a & i),
      SC_ROWS10(si_andi, u32, a & static_cast<u32>(i)),
      SC_ROWS10(si_orbi, u8, a | i),
      SC_ROWS10(si_orhi, u16, a | i),
      SC_ROWS10(si_ori, u32, a | static_cast<u32>(i)),
      SC_ROWS10(si_xorbi, u8, a ^ i),
      SC_ROWS10(si_xorhi, u16, a ^ i),
      SC_ROWS10(si_xori, u32, a ^ static_cast<u32>(i)),
      SC_ROW3(si_selb, u32, (c & b) | (~c & a)),
      SC_WHOLE3(si_shufb,
                {
                  R r;
                  for (std::size_t i = 0; i < 16; ++i) {
                    const u8 k = c.byte[i];
                    r.byte[i] = (k & 0xC0) == 0x80   ? 0x00
                                : (k & 0xE0) == 0xC0 ? 0xFF
                                : (k & 0xE0) == 0xE0 ? 0x80
                                                     : (k & 16 ? b : a).byte[k & 15];
                  }
                  return r;
                }),
  });
}

u32 shift_left(u64 x, int n, int bits) { return n >= bits ? 0 : static_cast<u32>(x << n); }
u32 shift_right(u64 x, int n, int bits) { return n >= bits ? 0 : static_cast<u32>(x >> n); }
u32 shift_signed(s64 x, int n, int bits) { return static_cast<u32>(x >> (n >= bits ? bits - 1 : n)); }
u32 rotate(u64 x, int n, int bits) { return static_cast<u32>(x << n | x >> (bits - n)); }
int minus(u32 n) { return static_cast<int>(0u - n); }

TEST_F(IntrinsicsSpecific, ElementShifts) {
  run({
      SC_ROW2(si_shlh, u16, shift_left(a, b & 31, 16)),
      SC_ROW2(si_shl, u32, shift_left(a, b & 63, 32)),
      SC_ROW2(si_roth, u16, rotate(a, b & 15, 16)),
      SC_ROW2(si_rot, u32, rotate(a, b & 31, 32)),
      SC_ROW2(si_rothm, u16, shift_right(a, minus(b) & 31, 16)),
      SC_ROW2(si_rotm, u32, shift_right(a, minus(b) & 63, 32)),
      SC_ROW2(si_rotmah, u16, shift_signed(static_cast<s16>(a), minus(b) & 31, 16)),
      SC_ROW2(si_rotma, u32, shift_signed(static_cast<s32>(a), minus(b) & 63, 32)),
      SC_ROWS7(si_shlhi, u16, shift_left(a, i & 31, 16)),
      SC_ROWS7(si_shli, u32, shift_left(a, i & 63, 32)),
      SC_ROWS7(si_rothi, u16, rotate(a, i & 15, 16)),
      SC_ROWS7(si_roti, u32, rotate(a, i & 31, 32)),
      SC_ROWS7(si_rothmi, u16, shift_right(a, -i & 31, 16)),
      SC_ROWS7(si_rotmi, u32, shift_right(a, -i & 63, 32)),
      SC_ROWS7(si_rotmahi, u16, shift_signed(static_cast<s16>(a), -i & 31, 16)),
      SC_ROWS7(si_rotmai, u32, shift_signed(static_cast<s32>(a), -i & 63, 32)),
  });
}

/// The register as one number, moved by bits to the left (negative: to the right); what leaves is lost, or
/// comes back.
R moved_whole(const R& a, int shift, bool rotated = false) {
  R r;
  for (int i = 0; i < 128; ++i) {
    const int from = rotated ? (i + shift) & 127 : i + shift;
    if (from < 0 || from > 127) continue;
    if ((a.byte[static_cast<std::size_t>(from / 8)] >> (7 - from % 8) & 1) != 0) {
      r.byte[static_cast<std::size_t>(i / 8)] |= static_cast<u8>(0x80 >> i % 8);
    }
  }
  return r;
}

TEST_F(IntrinsicsSpecific, QuadwordShifts) {
  run({
    SC_WHOLE2(si_shlqbi, { return moved_whole(a, static_cast<int>(b.w(0) & 7)); }),
        SC_WHOLE2(si_shlqby, { return moved_whole(a, static_cast<int>(8 * (b.w(0) & 31))); }),
        SC_WHOLE2(si_shlqbybi, { return moved_whole(a, static_cast<int>(8 * (b.w(0) >> 3 & 31))); }),
        SC_WHOLE2(si_rotqbi, { return moved_whole(a, static_cast<int>(b.w(0) & 7), true); }),
        SC_WHOLE2(si_rotqby, { return moved_whole(a, static_cast<int>(8 * (b.w(0) & 15)), true); }),
        SC_WHOLE2(si_rotqbybi, { return moved_whole(a, static_cast<int>(8 * (b.w(0) >> 3 & 15)), true); }),
        SC_WHOLE2(si_rotqmbi, { return moved_whole(a, -(minus(b.w(0)) & 7)); }),
        SC_WHOLE2(si_rotqmby, { return moved_whole(a, -8 * (minus(b.w(0)) & 31)); }),
        SC_WHOLE2(si_rotqmbybi, { return moved_whole(a, -8 * (minus(b.w(0) >> 3) & 31)); }),
        SC_WHOLES7(si_shlqbii, return moved_whole(a, i & 7);),
        SC_WHOLES7(si_shlqbyi, return moved_whole(a, 8 * (i & 31));),
        SC_WHOLES7(si_rotqbii, return moved_whole(a, i & 7, true);),
        SC_WHOLES7(si_rotqbyi, return moved_whole(a, 8 * (i & 15), true);),
        SC_WHOLES7(si_rotqmbii, return moved_whole(a, -(-i & 7));),
        SC_WHOLES7(si_rotqmbyi, return moved_whole(a, -8 * (-i & 31));),
  });
}

TEST_F(IntrinsicsSpecific, Compares) {
  run({
      SC_ROW2(si_ceqb, u8, a == b ? -1 : 0),
      SC_ROW2(si_ceqh, u16, a == b ? -1 : 0),
      SC_ROW2(si_ceq, u32, a == b ? -1 : 0),
      SC_ROW2(si_cgtb, s8, a > b ? -1 : 0),
      SC_ROW2(si_cgth, s16, a > b ? -1 : 0),
      SC_ROW2(si_cgt, s32, a > b ? -1 : 0),
      SC_ROW2(si_clgtb, u8, a > b ? -1 : 0),
      SC_ROW2(si_clgth, u16, a > b ? -1 : 0),
      SC_ROW2(si_clgt, u32, a > b ? -1 : 0),
      SC_ROWS10(si_ceqbi, u8, a == static_cast<u8>(i) ? -1 : 0),
      SC_ROWS10(si_ceqhi, u16, a == static_cast<u16>(i) ? -1 : 0),
      SC_ROWS10(si_ceqi, u32, a == static_cast<u32>(i) ? -1 : 0),
      SC_ROWS10(si_cgtbi, s8, a > static_cast<s8>(i) ? -1 : 0),
      SC_ROWS10(si_cgthi, s16, a > i ? -1 : 0),
      SC_ROWS10(si_cgti, s32, a > i ? -1 : 0),
      SC_ROWS10(si_clgtbi, u8, a > static_cast<u8>(i) ? -1 : 0),
      SC_ROWS10(si_clgthi, u16, a > static_cast<u16>(i) ? -1 : 0),
      SC_ROWS10(si_clgti, u32, a > static_cast<u32>(i) ? -1 : 0),
  });
}

/// The control that inserts `width` bytes at a position: IDPAT with the preferred slot in its place.
/// [SPU-ISA, cbd ..] documented
R insertion(u32 position, std::size_t width) {
  R r;
  for (std::size_t i = 0; i < 16; ++i) r.byte[i] = static_cast<u8>(0x10 + i);
  const std::size_t first = position & 15 & ~(width - 1);
  for (std::size_t i = 0; i < width; ++i)
    r.byte[first + i] = static_cast<u8>(width == 1 ? 3 : width == 2 ? 2 + i : i);
  return r;
}

TEST_F(IntrinsicsSpecific, InsertionControls) {
  run({
    SC_WHOLE2(si_cbx, { return insertion(a.w(0) + b.w(0), 1); }),
        SC_WHOLE2(si_chx, { return insertion(a.w(0) + b.w(0), 2); }),
        SC_WHOLE2(si_cwx, { return insertion(a.w(0) + b.w(0), 4); }),
        SC_WHOLE2(si_cdx, { return insertion(a.w(0) + b.w(0), 8); }),
        SC_WHOLEI(si_cbd, -64, return insertion(a.w(0) + static_cast<u32>(i), 1);),
        SC_WHOLEI(si_cbd, 63, return insertion(a.w(0) + static_cast<u32>(i), 1);),
        SC_WHOLEI(si_chd, 7, return insertion(a.w(0) + static_cast<u32>(i), 2);),
        SC_WHOLEI(si_cwd, -3, return insertion(a.w(0) + static_cast<u32>(i), 4);),
        SC_WHOLEI(si_cdd, 12, return insertion(a.w(0) + static_cast<u32>(i), 8);),
  });
}

/// Float and double instructions are the generic ones, which have tests of their own; here only that each is
/// the right one.
TEST_F(IntrinsicsSpecific, FloatingPointIsTheGenericIntrinsic) {
  Operands operands(81);
  for (int round = 0; round < kRounds; ++round) {
    // Few magnitudes of either sign, so that every compare holds now and then.
    const auto one = [&] {
      const float magnitudes[] = {0.3f, 1.25f, 2.7f, 1000.1f};
      return operands.count(0, 1) == 0 ? magnitudes[operands.count(0, 3)] : -magnitudes[operands.count(0, 3)];
    };
    const auto ordinary = [&] { return vec_float4{one(), one(), one(), one()}; };
    const vec_float4 f = ordinary(), g = ordinary(), h = ordinary();
    const qword a(f), b(g), c(h);
    const vec_double2 x = spu_extend(f), y = spu_extend(g), z = spu_extend(h);
    const qword d(x), e(y), k(z);
    const vec_int4 s = operands.vector<vec_int4>();
    const auto same = [](qword q, auto v) { EXPECT_EQ(register_of(q), register_of(v)); };
    same(si_fa(a, b), spu_add(f, g));
    same(si_fs(a, b), spu_sub(f, g));
    same(si_fm(a, b), spu_mul(f, g));
    same(si_fma(a, b, c), spu_madd(f, g, h));
    same(si_fms(a, b, c), spu_msub(f, g, h));
    same(si_fnms(a, b, c), spu_nmsub(f, g, h));
    same(si_fceq(a, b), spu_cmpeq(f, g));
    same(si_fcmeq(a, b), spu_cmpabseq(f, g));
    same(si_fcgt(a, b), spu_cmpgt(f, g));
    same(si_fcmgt(a, b), spu_cmpabsgt(f, g));
    same(si_csflt(qword(s), 3), spu_convtf(s, 3));
    same(si_cuflt(qword(s), 3), spu_convtf(vec_uint4(s), 3));
    same(si_cflts(a, 9), spu_convts(f, 9));
    same(si_cfltu(a, 9), spu_convtu(f, 9));
    same(si_fesd(a), x);
    same(si_frds(d), spu_roundtf(x));
    same(si_dfa(d, e), spu_add(x, y));
    same(si_dfs(d, e), spu_sub(x, y));
    same(si_dfm(d, e), spu_mul(x, y));
    same(si_dfma(d, e, k), spu_madd(x, y, z));
    same(si_dfms(d, e, k), spu_msub(x, y, z));
    same(si_dfnms(d, e, k), spu_nmsub(x, y, z));
    same(si_dfnma(d, e, k), spu_nmadd(x, y, z));
    same(si_dfceq(d, e), spu_cmpeq(x, y));
    same(si_dfcmeq(d, e), spu_cmpabseq(x, y));
    same(si_dfcgt(d, e), spu_cmpgt(x, y));
    same(si_dfcmgt(d, e), spu_cmpabsgt(x, y));
    same(si_dftsv(d, SPU_SV_NAN), spu_testsv(x, SPU_SV_NAN));
  }
}

TEST_F(IntrinsicsSpecific, ScalarsLieInThePreferredSlot) {
  EXPECT_EQ(register_of(si_from_char(-2)).get<s8>(3), -2);
  EXPECT_EQ(register_of(si_from_uchar(200)).get<u8>(3), 200);
  EXPECT_EQ(register_of(si_from_short(-3)).get<s16>(1), -3);
  EXPECT_EQ(register_of(si_from_ushort(60000)).get<u16>(1), 60000);
  EXPECT_EQ(register_of(si_from_int(-4)).get<s32>(0), -4);
  EXPECT_EQ(register_of(si_from_uint(4000000000u)).w(0), 4000000000u);
  EXPECT_EQ(register_of(si_from_llong(-5)).get<s64>(0), -5);
  EXPECT_EQ(register_of(si_from_ullong(0x0123456789ABCDEFull)).get<u64>(0), 0x0123456789ABCDEFull);
  EXPECT_EQ(register_of(si_from_float(1.5f)).get<float>(0), 1.5f);
  EXPECT_EQ(register_of(si_from_double(-2.5)).get<double>(0), -2.5);
  Operands operands(82);
  for (int round = 0; round < kRounds; ++round) {
    const R r = operands.reg();
    const qword q = qword_of(r);
    EXPECT_EQ(si_to_char(q), r.get<s8>(3));
    EXPECT_EQ(si_to_uchar(q), r.get<u8>(3));
    EXPECT_EQ(si_to_short(q), r.get<s16>(1));
    EXPECT_EQ(si_to_ushort(q), r.get<u16>(1));
    EXPECT_EQ(si_to_int(q), r.get<s32>(0));
    EXPECT_EQ(si_to_uint(q), r.get<u32>(0));
    EXPECT_EQ(si_to_llong(q), r.get<s64>(0));
    EXPECT_EQ(si_to_ullong(q), r.get<u64>(0));
    EXPECT_EQ(bits_of(si_to_float(q)), r.get<u32>(0));
    EXPECT_EQ(bits_of(si_to_double(q)), r.get<u64>(0));
  }
}

}  // namespace
}  // namespace softcell::test
