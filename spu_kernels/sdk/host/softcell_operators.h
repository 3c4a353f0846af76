#pragma once
// The operators that compilers of the SPU have for vectors, as for scalars lane by lane; comparisons give -1 or 0 in lanes of
// the same width. Operands are two vectors of one type, or one and a scalar that is converted to its lane. Integers of both signs give
// unsigned ones.
// [GCC, vector extensions] documented

#include "softcell_compare.h"
#include "softcell_double.h"
#include "softcell_integer.h"
#include "softcell_single.h"

namespace softcell_sdk {

// Sums, differences and products: integers wrap, floats and doubles are those of the SPU.
#define SC_SDK_ARITHMETIC(op, function)                                \
  template <class T_>                                                  \
  SC_SDK_INLINE Vector<T_> operator op(Vector<T_> a_, Vector<T_> b_) { \
    if constexpr (kFloating<T_>) {                                     \
      return function(a_, b_);                                         \
    } else {                                                           \
      return make<Vector<T_>>(wrap(a_) op wrap(b_));                   \
    }                                                                  \
  }
SC_SDK_ARITHMETIC(+, spu_add)
SC_SDK_ARITHMETIC(-, spu_sub)
SC_SDK_ARITHMETIC(*, spu_mul)
#undef SC_SDK_ARITHMETIC

#define SC_SDK_LANES(op)                                               \
  template <class T_>                                                  \
  SC_SDK_INLINE Vector<T_> operator op(Vector<T_> a_, Vector<T_> b_) { \
    return make<Vector<T_>>(a_.raw op b_.raw);                         \
  }
SC_SDK_LANES(/)
SC_SDK_LANES(%)
SC_SDK_LANES(&)
SC_SDK_LANES(|)
SC_SDK_LANES(^)
SC_SDK_LANES(<<)
SC_SDK_LANES(>>)
#undef SC_SDK_LANES

template <class T_>
using Mask = Vector<Signed<T_>>;
template <class T_>
SC_SDK_INLINE Mask<T_> operator==(Vector<T_> a_, Vector<T_> b_) {
  if constexpr (kFloating<T_>) {
    return Mask<T_>(spu_cmpeq(a_, b_));
  } else {
    return make<Mask<T_>>(a_.raw == b_.raw);
  }
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator>(Vector<T_> a_, Vector<T_> b_) {
  if constexpr (kFloating<T_>) {
    return Mask<T_>(spu_cmpgt(a_, b_));
  } else {
    return make<Mask<T_>>(a_.raw > b_.raw);
  }
}
template <class T_>
SC_SDK_INLINE Vector<T_> operator~(Vector<T_> a_) {
  return make<Vector<T_>>(~a_.raw);
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator!=(Vector<T_> a_, Vector<T_> b_) {
  return ~(a_ == b_);
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator!(Vector<T_> a_) {
  return a_ == splats<T_>(T_());
}
// Both sides are computed, as on an SPU.
template <class T_, class U_, If<sizeof(T_) == sizeof(U_)> = 0>
SC_SDK_INLINE Mask<T_> operator&&(Vector<T_> a_, Vector<U_> b_) {
  return ~((!a_) | (!b_));
}
template <class T_, class U_, If<sizeof(T_) == sizeof(U_)> = 0>
SC_SDK_INLINE Mask<T_> operator||(Vector<T_> a_, Vector<U_> b_) {
  return ~((!a_) & (!b_));
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator<(Vector<T_> a_, Vector<T_> b_) {
  return b_ > a_;
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator>=(Vector<T_> a_, Vector<T_> b_) {
  return (a_ > b_) | (a_ == b_);
}
template <class T_>
SC_SDK_INLINE Mask<T_> operator<=(Vector<T_> a_, Vector<T_> b_) {
  return (b_ > a_) | (a_ == b_);
}
template <class T_>
SC_SDK_INLINE Vector<T_> operator+(Vector<T_> a_) {
  return a_;
}
template <class T_>
SC_SDK_INLINE Vector<T_> operator-(Vector<T_> a_) {
  if constexpr (kFloating<T_>) {
    return make<Vector<T_>>(-a_.raw);
  } else {
    return make<Vector<T_>>(0 - wrap(a_));
  }
}

template <class T_, class U_>
inline constexpr bool kOfOtherSign = sizeof(T_) == sizeof(U_) && !kFloating<T_> && !kFloating<U_> &&
                                     (T_(-1) < T_(0)) != (U_(-1) < U_(0));
#define SC_SDK_BOTH_SIGNS(op)                                    \
  template <class T_, class U_, If<kOfOtherSign<T_, U_>> = 0>    \
  SC_SDK_INLINE auto operator op(Vector<T_> a_, Vector<U_> b_) { \
    return Vector<Unsigned<T_>>(a_) op Vector<Unsigned<T_>>(b_); \
  }
SC_SDK_BOTH_SIGNS(+)
SC_SDK_BOTH_SIGNS(-)
SC_SDK_BOTH_SIGNS(*)
SC_SDK_BOTH_SIGNS(/)
SC_SDK_BOTH_SIGNS(%)
SC_SDK_BOTH_SIGNS(&)
SC_SDK_BOTH_SIGNS(|)
SC_SDK_BOTH_SIGNS(^)
SC_SDK_BOTH_SIGNS(==)
SC_SDK_BOTH_SIGNS(!=)
#undef SC_SDK_BOTH_SIGNS
// A shift has the sign of what is shifted.
template <class T_, class U_, If<kOfOtherSign<T_, U_>> = 0>
SC_SDK_INLINE Vector<T_> operator<<(Vector<T_> a_, Vector<U_> b_) {
  return a_ << Vector<T_>(b_);
}
template <class T_, class U_, If<kOfOtherSign<T_, U_>> = 0>
SC_SDK_INLINE Vector<T_> operator>>(Vector<T_> a_, Vector<U_> b_) {
  return a_ >> Vector<T_>(b_);
}

// One operand a scalar; and assignments, to volatile vectors too.
#define SC_SDK_WITH_SCALAR(op)                                   \
  template <class T_>                                            \
  SC_SDK_INLINE auto operator op(Vector<T_> a_, Scalar<T_> b_) { \
    return a_ op splats<T_>(b_);                                 \
  }                                                              \
  template <class T_>                                            \
  SC_SDK_INLINE auto operator op(Scalar<T_> a_, Vector<T_> b_) { \
    return splats<T_>(a_) op b_;                                 \
  }
#define SC_SDK_ASSIGNING(op)                                               \
  SC_SDK_WITH_SCALAR(op)                                                   \
  template <class T_, class Operand>                                       \
  SC_SDK_INLINE Vector<T_>& operator op##=(Vector<T_>& a_, Operand b_) {   \
    return a_ = a_ op b_;                                                  \
  }                                                                        \
  template <class T_, class Operand>                                       \
  SC_SDK_INLINE void operator op##=(volatile Vector<T_>& a_, Operand b_) { \
    a_ = Vector<T_>(a_) op b_;                                             \
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

template <class T_>
SC_SDK_INLINE Vector<T_>& operator++(Vector<T_>& a_) {
  return a_ += 1;
}
template <class T_>
SC_SDK_INLINE Vector<T_>& operator--(Vector<T_>& a_) {
  return a_ -= 1;
}
template <class T_>
SC_SDK_INLINE Vector<T_> operator++(Vector<T_>& a_, int) {
  const Vector<T_> before = a_;
  a_ += 1;
  return before;
}
template <class T_>
SC_SDK_INLINE Vector<T_> operator--(Vector<T_>& a_, int) {
  const Vector<T_> before = a_;
  a_ -= 1;
  return before;
}

}  // namespace softcell_sdk

SC_SDK_INLINE qword operator&(qword a_, qword b_) { return qword(vec_uint4(a_) & vec_uint4(b_)); }
SC_SDK_INLINE qword operator|(qword a_, qword b_) { return qword(vec_uint4(a_) | vec_uint4(b_)); }
SC_SDK_INLINE qword operator^(qword a_, qword b_) { return qword(vec_uint4(a_) ^ vec_uint4(b_)); }
SC_SDK_INLINE qword operator~(qword a_) { return qword(~vec_uint4(a_)); }
