#pragma once
// Addresses of loads and stores, targets of branches, conditions of halts. Each function is one instruction.
// [SPU-ISA] documented
#include "spu_state.h"

namespace softcell::ls_sim::interpreter::semantics {

// ---- local-store addresses of quadwords

inline std::uint32_t quadword_at(std::uint32_t address) { return address & kQuadwordMask; }
inline std::uint32_t words_on(std::uint32_t from, std::int32_t words) {
  return from + (static_cast<std::uint32_t>(words) << 2);
}

inline std::uint32_t lqd(const In& in, std::uint32_t) {
  return quadword_at(preferred_word(in.a) + (static_cast<std::uint32_t>(in.imm) << 4));
}
inline std::uint32_t lqx(const In& in, std::uint32_t) {
  return quadword_at(preferred_word(in.a) + preferred_word(in.b));
}
inline std::uint32_t lqa(const In& in, std::uint32_t) { return quadword_at(words_on(0, in.imm)); }
inline std::uint32_t lqr(const In& in, std::uint32_t pc) { return quadword_at(words_on(pc, in.imm)); }
inline std::uint32_t stqd(const In& in, std::uint32_t pc) { return lqd(in, pc); }
inline std::uint32_t stqx(const In& in, std::uint32_t pc) { return lqx(in, pc); }
inline std::uint32_t stqa(const In& in, std::uint32_t pc) { return lqa(in, pc); }
inline std::uint32_t stqr(const In& in, std::uint32_t pc) { return lqr(in, pc); }

// ---- branches

struct Jump {
  bool taken;
  std::uint32_t target;  ///< masked
};
inline Jump jump_if(bool condition, std::uint32_t target) { return {condition, target & kInstructionMask}; }
inline std::uint32_t condition_half(const In& in) { return preferred_word(in.t) & 0xFFFF; }

inline Jump br(const In& in, std::uint32_t pc) { return jump_if(true, words_on(pc, in.imm)); }
inline Jump bra(const In& in, std::uint32_t) { return jump_if(true, words_on(0, in.imm)); }
inline Jump brsl(const In& in, std::uint32_t pc) { return br(in, pc); }
inline Jump brasl(const In& in, std::uint32_t pc) { return bra(in, pc); }
inline Jump brnz(const In& in, std::uint32_t pc) {
  return jump_if(preferred_word(in.t) != 0, words_on(pc, in.imm));
}
inline Jump brz(const In& in, std::uint32_t pc) {
  return jump_if(preferred_word(in.t) == 0, words_on(pc, in.imm));
}
inline Jump brhnz(const In& in, std::uint32_t pc) {
  return jump_if(condition_half(in) != 0, words_on(pc, in.imm));
}
inline Jump brhz(const In& in, std::uint32_t pc) {
  return jump_if(condition_half(in) == 0, words_on(pc, in.imm));
}
inline Jump bi(const In& in, std::uint32_t) { return jump_if(true, preferred_word(in.a)); }
inline Jump bisl(const In& in, std::uint32_t pc) { return bi(in, pc); }
inline Jump biz(const In& in, std::uint32_t) {
  return jump_if(preferred_word(in.t) == 0, preferred_word(in.a));
}
inline Jump binz(const In& in, std::uint32_t) {
  return jump_if(preferred_word(in.t) != 0, preferred_word(in.a));
}
inline Jump bihz(const In& in, std::uint32_t) {
  return jump_if(condition_half(in) == 0, preferred_word(in.a));
}
inline Jump bihnz(const In& in, std::uint32_t) {
  return jump_if(condition_half(in) != 0, preferred_word(in.a));
}

// ---- halts

inline bool heq(const In& in) { return preferred_word(in.a) == preferred_word(in.b); }
inline bool heqi(const In& in) { return preferred_word(in.a) == static_cast<std::uint32_t>(in.imm); }
inline std::int32_t preferred_signed(Quadword q) { return static_cast<std::int32_t>(preferred_word(q)); }
inline bool hgt(const In& in) { return preferred_signed(in.a) > preferred_signed(in.b); }
inline bool hgti(const In& in) { return preferred_signed(in.a) > in.imm; }
inline bool hlgt(const In& in) { return preferred_word(in.a) > preferred_word(in.b); }
inline bool hlgti(const In& in) { return preferred_word(in.a) > static_cast<std::uint32_t>(in.imm); }

}  // namespace softcell::ls_sim::interpreter::semantics
