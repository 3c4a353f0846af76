// strtod() and its family: the nearest double, of numbers with up to 19 significant digits. More digits count only where these lie
// exactly between two doubles.

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

namespace {

/// A whole number of any size that occurs here: 10^19 * 10^345 and 2^1200 fit.
struct Whole {
  uint32_t limb[44];  // the lowest first
  int count;
};

void multiply(Whole& n, uint32_t by) {
  uint64_t carry = 0;
  for (int i = 0; i < n.count; ++i) {
    carry += static_cast<uint64_t>(n.limb[i]) * by;
    n.limb[i] = static_cast<uint32_t>(carry);
    carry >>= 32;
  }
  if (carry != 0) n.limb[n.count++] = static_cast<uint32_t>(carry);
}
void multiply_by_power_of_10(Whole& n, int exponent) {
  for (; exponent >= 9; exponent -= 9) multiply(n, 1000000000);
  for (; exponent > 0; --exponent) multiply(n, 10);
}
void multiply_by_power_of_2(Whole& n, int exponent) {
  for (; exponent >= 31; exponent -= 31) multiply(n, 1u << 31);
  if (exponent > 0) multiply(n, 1u << exponent);
}
Whole whole(uint64_t value) {
  Whole n;
  n.limb[0] = static_cast<uint32_t>(value);
  n.limb[1] = static_cast<uint32_t>(value >> 32);
  n.count = n.limb[1] != 0 ? 2 : 1;
  return n;
}
int compare(const Whole& a, const Whole& b) {
  if (a.count != b.count) return a.count < b.count ? -1 : 1;
  for (int i = a.count; i-- > 0;)
    if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
  return 0;
}

/// Digits and what they are multiplied with.
struct Decimal {
  uint64_t digits = 0;  // at most 19
  int exponent = 0;     // of 10
  bool more = false;    // digits that are not 0 were cut off
};

/// digits * 10^exponent against m * 2^q, of which m is a whole number.
int compare(const Decimal& d, uint64_t m, int q) {
  Whole left = whole(d.digits), right = whole(m);
  multiply_by_power_of_10(d.exponent > 0 ? left : right, d.exponent > 0 ? d.exponent : -d.exponent);
  multiply_by_power_of_2(q > 0 ? right : left, q > 0 ? q : -q);
  const int order = compare(left, right);
  return order == 0 && d.more ? 1 : order;
}

double power_of_10(int exponent) {
  static const double kPowers[] = {1e1, 1e2, 1e4, 1e8, 1e16, 1e32, 1e64, 1e128, 1e256};
  double power = 1;
  for (int i = 0; i < 9; ++i)
    if ((exponent >> i & 1) != 0) power *= kPowers[i];
  return power;
}

double times_power_of_10(double x, int exponent) {
  return exponent < 0 ? x / power_of_10(-exponent) : x * power_of_10(exponent);
}

double too_large() {
  errno = ERANGE;
  return HUGE_VAL;
}
/// What is smaller than the smallest normal double, as an SPU has no others.
double too_small() {
  errno = ERANGE;
  return 0;
}

double nearest(const Decimal& d) {
  constexpr uint64_t kLeast = 1ull << 52;  // of a double's 53 bits
  if (d.digits == 0) return 0;
  if (d.exponent > 310) return too_large();
  if (d.exponent < -345) return too_small();
  const int half = d.exponent / 2;
  const double near =
      times_power_of_10(times_power_of_10(static_cast<double>(d.digits), half), d.exponent - half);
  if (d.exponent == 0 && d.digits <= 1ull << 53) return near;
  // An estimate that is right to some units in the last place, and within the normal numbers.
  constexpr int kLeastPower = -1074, kMostPower = 971;
  int q = 0;
  uint64_t m = 0;
  if (near < 0x1p-1022) {
    if (near < 0x1p-1023) return too_small();
    m = kLeast;
    q = kLeastPower;
  } else if (near > 0x1.fffffffffffffp1023) {
    m = 2 * kLeast - 1;
    q = kMostPower;
  } else {
    m = static_cast<uint64_t>(ldexp(frexp(near, &q), 53));
    q -= 53;
  }
  for (;;) {
    if (m == 2 * kLeast) {
      m = kLeast;
      ++q;
    }
    if (q > kMostPower) return too_large();
    const int above = compare(d, 2 * m + 1, q - 1);
    if (above > 0 || (above == 0 && (m & 1) != 0)) {
      ++m;
      continue;
    }
    // Below a power of two doubles are half as far apart.
    const bool is_power = m == kLeast;
    const int below = is_power ? compare(d, 4 * m - 1, q - 2) : compare(d, 2 * m - 1, q - 1);
    if (below > 0 || (below == 0 && (m & 1) == 0)) break;
    m = is_power ? 2 * kLeast - 1 : m - 1;
    if (is_power && --q < kLeastPower) return too_small();
  }
  return ldexp(static_cast<double>(m), q);
}

bool starts_with(const char* s, const char* word) {
  for (; *word != '\0'; ++s, ++word)
    if (tolower(static_cast<unsigned char>(*s)) != *word) return false;
  return true;
}

/// The exponent behind a mark, which is read only if digits follow. Cut at 9999.
int read_exponent(const char*& s, char mark) {
  if (tolower(static_cast<unsigned char>(*s)) != mark) return 0;
  const char* at = s + 1;
  const bool negative = *at == '-';
  if (*at == '-' || *at == '+') ++at;
  if (!isdigit(static_cast<unsigned char>(*at))) return 0;
  int exponent = 0;
  for (; isdigit(static_cast<unsigned char>(*at)); ++at)
    if (exponent < 1000) exponent = exponent * 10 + (*at - '0');
  s = at;
  return negative ? -exponent : exponent;
}

/// Digits with a point, and their exponent. @return  false: there are none
bool read_decimal(const char*& s, Decimal& d) {
  bool any = false, point = false;
  const char* at = s;
  for (;; ++at) {
    if (*at == '.' && !point) {
      point = true;
      continue;
    }
    if (!isdigit(static_cast<unsigned char>(*at))) break;
    any = true;
    if (d.digits <= 999999999999999999ull) {
      d.digits = d.digits * 10 + static_cast<unsigned>(*at - '0');
      if (point) --d.exponent;
    } else {
      if (*at != '0') d.more = true;
      if (!point) ++d.exponent;
    }
  }
  if (!any) return false;
  s = at;
  const int exponent = read_exponent(s, 'e');
  d.exponent += exponent;
  return true;
}

/// Without its lowest bits, the nearest, halves to the even one. (A conversion would truncate, as the host does while a kernel runs.)
uint64_t without_low_bits(uint64_t number, int bits) {
  const uint64_t unit = uint64_t{1} << bits, rest = number & (unit - 1);
  const uint64_t kept = number >> bits;
  return kept + (rest > unit / 2 || (rest == unit / 2 && (kept & 1) != 0) ? 1 : 0);
}

/// The nearest double.
double rounded(uint64_t number) {
  constexpr int kBits = 53;
  int excess = 0;
  while (excess < 64 - kBits && number >> (kBits + excess) != 0) ++excess;
  if (excess == 0) return static_cast<double>(number);
  return ldexp(static_cast<double>(without_low_bits(number, excess)), excess);
}

/// The nearest float of a double that is no larger than the largest; of those below the smallest it is 0.
float rounded_to_float(double x) {
  constexpr int kLessDigits = 52 - 23;
  constexpr uint64_t kSign = uint64_t{1} << 63, kLessExponent = uint64_t{1023 - 127} << 23,
                     kSmallest = 1u << 23;
  uint64_t bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  const uint64_t size = without_low_bits(bits & ~kSign, kLessDigits);
  uint32_t result = static_cast<uint32_t>((bits & kSign) >> 32);
  if (size >= kLessExponent + kSmallest) result |= static_cast<uint32_t>(size - kLessExponent);
  float rounded;
  __builtin_memcpy(&rounded, &result, sizeof rounded);
  return rounded;
}

/// The same in sixteens, behind 0x.
bool read_hexadecimal(const char*& s, double& value) {
  bool any = false, point = false, more = false;
  uint64_t digits = 0;
  int exponent = 0;
  const char* at = s + 2;
  for (;; ++at) {
    if (*at == '.' && !point) {
      point = true;
      continue;
    }
    const int c = static_cast<unsigned char>(*at);
    if (!isxdigit(c)) break;
    any = true;
    if (digits >> 58 == 0) {
      digits = digits << 4 | static_cast<unsigned>(isdigit(c) ? c - '0' : tolower(c) - 'a' + 10);
      if (point) exponent -= 4;
    } else {
      more = more || c != '0';
      if (!point) exponent += 4;
    }
  }
  if (!any) return false;
  s = at;
  exponent += read_exponent(s, 'p');
  // The digits have up to 62 bits, of which the lowest keeps what was cut off.
  const double size = rounded(digits | (more ? 1 : 0));
  int binary;
  const double part = frexp(size, &binary);
  if (size != 0 && binary + exponent > 1024)
    value = too_large();
  else if (size != 0 && binary + exponent < -1021)
    value = too_small();
  else
    value = ldexp(part, binary + exponent);
  return true;
}

}  // namespace

extern "C" {

double strtod(const char* text, char** end) {
  const char* s = text;
  while (isspace(static_cast<unsigned char>(*s))) ++s;
  const bool negative = *s == '-';
  if (*s == '-' || *s == '+') ++s;
  double value = 0;
  Decimal decimal;
  bool any = true;
  if (starts_with(s, "inf")) {
    s += starts_with(s, "infinity") ? 8 : 3;
    value = HUGE_VAL;
  } else if (starts_with(s, "nan")) {
    s += 3;
    value = __builtin_nan("");
  } else if (s[0] != '0' || tolower(static_cast<unsigned char>(s[1])) != 'x' || !read_hexadecimal(s, value)) {
    any = read_decimal(s, decimal);
    if (any) value = nearest(decimal);
  }
  if (end != nullptr) *end = const_cast<char*>(any ? s : text);
  return negative && any ? -value : value;
}

float strtof(const char* text, char** end) {
  const double value = strtod(text, end);
  if (value > HUGE_VALF || value < -HUGE_VALF) {
    errno = ERANGE;
    return value < 0 ? -HUGE_VALF : HUGE_VALF;
  }
  if (value != value)
    return __builtin_copysignf(__builtin_nanf(""),
                               static_cast<float>(__builtin_signbit(value) != 0 ? -1 : 1));
  return rounded_to_float(value);
}

double atof(const char* text) { return strtod(text, nullptr); }

}  // extern "C"
