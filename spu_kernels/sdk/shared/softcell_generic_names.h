/* The generic intrinsics that vectors of several types have forms of, less spu_; and what a compiler says where there is no form. */
#ifndef SOFTCELL_GENERIC_NAMES_H
#define SOFTCELL_GENERIC_NAMES_H

// clang-format off
#define SOFTCELL_GENERIC_NAMES(X) \
  X(absd) X(add) X(addx) X(and) X(andc) X(avg) X(cmpabseq) X(cmpabsgt) X(cmpeq) X(cmpgt) X(cntb) X(cntlz) X(eqv) \
  X(extend) X(extract) X(gather) X(genb) X(genbx) X(genc) X(gencx) X(insert) X(madd) X(mhhadd) X(msub) X(mul) X(mule) \
  X(mulh) X(mulo) X(mulsr) X(nand) X(nmadd) X(nmsub) X(nor) X(or) X(orc) X(orx) X(re) X(rl) X(rlmask) X(rlmaska) \
  X(roundtf) X(rsqrte) X(sel) X(shuffle) X(sl) X(slqw) X(slqwbyte) X(slqwbytebc) X(sr) X(sra) X(srqw) X(srqwbyte) \
  X(srqwbytebc) X(rlqw) X(rlqwbyte) X(rlqwbytebc) X(rlmaskqw) X(rlmaskqwbyte) X(rlmaskqwbytebc) X(sub) X(subx) X(sumb) \
  X(xor)
// clang-format on

#define SOFTCELL_HAS_NO_FORM(name) \
  __attribute__((error("spu_" #name "() has no form for operands of these types")))

#endif
