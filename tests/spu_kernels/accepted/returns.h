#pragma once
// RETURNS(type, call): the call is legal and has exactly this type. Nothing is evaluated.

template <class A, class B>
struct IsSame {
  static constexpr bool value = false;
};
template <class A>
struct IsSame<A, A> {
  static constexpr bool value = true;
};
#define RETURNS(type, ...) static_assert(IsSame<type, decltype(__VA_ARGS__)>::value, #__VA_ARGS__)
