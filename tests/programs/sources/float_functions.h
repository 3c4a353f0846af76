/* The functions of math.h with one argument, as tests of all of them count them. */
// clang-format off
#define FLOAT_FUNCTIONS(X)                                                      \
  X(sqrt) X(cbrt) X(exp) X(exp2) X(expm1) X(log) X(log2) X(log10) X(log1p)      \
  X(logb) X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh)  \
  X(asinh) X(acosh) X(atanh) X(floor) X(ceil) X(trunc) X(round) X(rint)         \
  X(nearbyint) X(fabs) X(erf) X(erfc) X(tgamma) X(lgamma)
// clang-format on
