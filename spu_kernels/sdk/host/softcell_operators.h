#pragma once
// The operators that compilers of the SPU have for vectors, as for scalars lane by lane; comparisons give -1 or 0 in lanes of
// the same width. Operands are two vectors of one type, or one and a scalar that is converted to its lane.
// [GCC, vector extensions] documented

#include "softcell_compare.h"
#include "softcell_double.h"
#include "softcell_integer.h"
#include "softcell_single.h"

namespace softcell_sdk {

// Sums, differences and products: integers wrap, floats and doubles are those of the SPU.
#define SC_SDK_ARITHMETIC(op, function)                           \
  template <class T>                                              \
  SC_SDK_INLINE Vector<T> operator op(Vector<T> a, Vector<T> b) { \
    if constexpr (kFloating<T>) {                                 \
      return function(a, b);                                      \
    } else {                                                      \
      return make<Vector<T>>(wrap(a) op wrap(b));                 \
    }                                                             \
  }
SC_SDK_ARITHMETIC(+, spu_add)
SC_SDK_ARITHMETIC(-, spu_sub)
SC_SDK_ARITHMETIC(*, spu_mul)
#undef SC_SDK_ARITHMETIC

#define SC_SDK_LANES(op)                                          \
  template <class T>                                              \
  SC_SDK_INLINE Vector<T> operator op(Vector<T> a, Vector<T> b) { \
    return make<Vector<T>>(a.raw op b.raw);                       \
  }
SC_SDK_LANES(/)
SC_SDK_LANES(%)
SC_SDK_LANES(&)
SC_SDK_LANES(|)
SC_SDK_LANES(^)
SC_SDK_LANES(<<)
SC_SDK_LANES(>>)
#undef SC_SDK_LANES

template <class T>
using Mask = Vector<Signed<T>>;
template <class T>
SC_SDK_INLINE Mask<T> operator==(Vector<T> a, Vector<T> b) {
  if constexpr (kFloating<T>) {
    return Mask<T>(spu_cmpeq(a, b));
  } else {
    return make<Mask<T>>(a.raw == b.raw);
  }
}
template <class T>
SC_SDK_INLINE Mask<T> operator>(Vector<T> a, Vector<T> b) {
  if constexpr (kFloating<T>) {
    return Mask<T>(spu_cmpgt(a, b));
  } else {
    return make<Mask<T>>(a.raw > b.raw);
  }
}
template <class T>
SC_SDK_INLINE Vector<T> operator~(Vector<T> a) {
  return make<Vector<T>>(~a.raw);
}
template <class T>
SC_SDK_INLINE Mask<T> operator!=(Vector<T> a, Vector<T> b) {
  return ~(a == b);
}
template <class T>
SC_SDK_INLINE Mask<T> operator<(Vector<T> a, Vector<T> b) {
  return b > a;
}
template <class T>
SC_SDK_INLINE Mask<T> operator>=(Vector<T> a, Vector<T> b) {
  return (a > b) | (a == b);
}
template <class T>
SC_SDK_INLINE Mask<T> operator<=(Vector<T> a, Vector<T> b) {
  return (b > a) | (a == b);
}
template <class T>
SC_SDK_INLINE Vector<T> operator+(Vector<T> a) {
  return a;
}
template <class T>
SC_SDK_INLINE Vector<T> operator-(Vector<T> a) {
  if constexpr (kFloating<T>) {
    return make<Vector<T>>(-a.raw);
  } else {
    return make<Vector<T>>(0 - wrap(a));
  }
}

// One operand a scalar; and assignments, to volatile vectors too.
#define SC_SDK_WITH_SCALAR(op)                               \
  template <class T>                                         \
  SC_SDK_INLINE auto operator op(Vector<T> a, Scalar<T> b) { \
    return a op splats<T>(b);                                \
  }                                                          \
  template <class T>                                         \
  SC_SDK_INLINE auto operator op(Scalar<T> a, Vector<T> b) { \
    return splats<T>(a) op b;                                \
  }
#define SC_SDK_ASSIGNING(op)                                            \
  SC_SDK_WITH_SCALAR(op)                                                \
  template <class T, class Operand>                                     \
  SC_SDK_INLINE Vector<T>& operator op##=(Vector<T>& a, Operand b) {    \
    return a = a op b;                                                  \
  }                                                                     \
  template <class T, class Operand>                                     \
  SC_SDK_INLINE void operator op##=(volatile Vector<T>& a, Operand b) { \
    a = Vector<T>(a) op b;                                              \
  }
SC_SDK_ASSIGNING(+)
SC_SDK_ASSIGNING(-)
SC_SDK_ASSIGNING(*)
SC_SDK_ASSIGNING(/)
SC_SDK_ASSIGNING(%)
SC_SDK_ASSIGNING(&)
SC_SDK_ASSIGNING(|)
SC_SDK_ASSIGNING(^)
SC_SDK_ASSIGNING(<<)
SC_SDK_ASSIGNING(>>)
SC_SDK_WITH_SCALAR(==)
SC_SDK_WITH_SCALAR(!=)
SC_SDK_WITH_SCALAR(<)
SC_SDK_WITH_SCALAR(>)
SC_SDK_WITH_SCALAR(<=)
SC_SDK_WITH_SCALAR(>=)
#undef SC_SDK_ASSIGNING
#undef SC_SDK_WITH_SCALAR

template <class T>
SC_SDK_INLINE Vector<T>& operator++(Vector<T>& a) {
  return a += 1;
}
template <class T>
SC_SDK_INLINE Vector<T>& operator--(Vector<T>& a) {
  return a -= 1;
}
template <class T>
SC_SDK_INLINE Vector<T> operator++(Vector<T>& a, int) {
  const Vector<T> before = a;
  a += 1;
  return before;
}
template <class T>
SC_SDK_INLINE Vector<T> operator--(Vector<T>& a, int) {
  const Vector<T> before = a;
  a -= 1;
  return before;
}

}  // namespace softcell_sdk
