// Integers: from text, at random, divided, sorted.

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

namespace {

/// A number as strtol reads it: white space, sign, digits. `most` is the largest magnitude; a larger one is cut to it, with
/// ERANGE. [C17 7.22.1.4]
struct Parsed {
  uint64_t magnitude = 0;
  bool negative = false;
};

Parsed parse(const char* text, char** end, int base, uint64_t most, uint64_t most_negative) {
  if (base < 0 || base == 1 || base > 36) {
    errno = EINVAL;
    if (end != nullptr) *end = const_cast<char*>(text);
    return {};
  }
  const char* s = text;
  while (isspace(static_cast<unsigned char>(*s))) ++s;
  Parsed number;
  number.negative = *s == '-';
  if (*s == '-' || *s == '+') ++s;
  if ((base == 0 || base == 16) && s[0] == '0' && (s[1] == 'x' || s[1] == 'X') &&
      isxdigit(static_cast<unsigned char>(s[2]))) {
    s += 2;
    base = 16;
  }
  if (base == 0) base = *s == '0' ? 8 : 10;
  const uint64_t limit = number.negative ? most_negative : most;
  bool any = false, too_large = false;
  for (;; ++s) {
    const int c = static_cast<unsigned char>(*s);
    const int digit = isdigit(c) ? c - '0' : isalpha(c) ? tolower(c) - 'a' + 10 : 99;
    if (digit >= base) break;
    any = true;
    const uint64_t b = static_cast<uint64_t>(base), d = static_cast<uint64_t>(digit);
    too_large = too_large || number.magnitude > (limit - d) / b;
    number.magnitude = too_large ? limit : number.magnitude * b + d;
  }
  if (too_large) errno = ERANGE;
  if (end != nullptr) *end = const_cast<char*>(any ? s : text);
  return number;
}

uint64_t value(const Parsed& number) { return number.negative ? 0 - number.magnitude : number.magnitude; }

}  // namespace

extern "C" {

long strtol(const char* text, char** end, int base) {
  return static_cast<long>(value(parse(text, end, base, LONG_MAX, uint64_t{LONG_MAX} + 1)));
}
unsigned long strtoul(const char* text, char** end, int base) {
  return static_cast<unsigned long>(value(parse(text, end, base, ULONG_MAX, ULONG_MAX)));
}
long long strtoll(const char* text, char** end, int base) {
  return static_cast<long long>(value(parse(text, end, base, LLONG_MAX, uint64_t{LLONG_MAX} + 1)));
}
unsigned long long strtoull(const char* text, char** end, int base) {
  return value(parse(text, end, base, ULLONG_MAX, ULLONG_MAX));
}
int atoi(const char* text) { return static_cast<int>(strtol(text, nullptr, 10)); }
long atol(const char* text) { return strtol(text, nullptr, 10); }
long long atoll(const char* text) { return strtoll(text, nullptr, 10); }

int abs(int v) { return v < 0 ? -v : v; }
long labs(long v) { return v < 0 ? -v : v; }
long long llabs(long long v) { return v < 0 ? -v : v; }
div_t div(int a, int b) { return {a / b, a % b}; }
ldiv_t ldiv(long a, long b) { return {a / b, a % b}; }
lldiv_t lldiv(long long a, long long b) { return {a / b, a % b}; }

// A linear congruential generator of 64 bits, of which the upper 31 are given: Knuth's MMIX constants.
static uint64_t random_state = 1;
static uint64_t next_state(uint64_t state) { return state * 6364136223846793005ull + 1442695040888963407ull; }
void srand(unsigned int seed) { random_state = seed; }
int rand() {
  random_state = next_state(random_state);
  return static_cast<int>(random_state >> 33);
}
int rand_r(unsigned int* state) {
  const uint64_t next = next_state(next_state(*state));
  *state = static_cast<unsigned int>(next >> 32);
  return static_cast<int>(next >> 33);
}

static uint64_t other_random_state = 1;
void srandom(unsigned int seed) { other_random_state = seed; }
long random() {
  other_random_state = next_state(other_random_state);
  return static_cast<long>(other_random_state >> 33);
}

// A generator of 48 bits. [POSIX, drand48]
static uint64_t state_of_48 = 0x1234ABCD330E;
static uint64_t next_of_48(uint64_t& state) {
  state = (state * 0x5DEECE66D + 0xB) & 0xFFFFFFFFFFFF;
  return state;
}
static uint64_t next_of_words(unsigned short state[3]) {
  uint64_t whole = uint64_t{state[2]} << 32 | uint64_t{state[1]} << 16 | state[0];
  next_of_48(whole);
  for (int i = 0; i < 3; ++i) state[i] = static_cast<unsigned short>(whole >> 16 * i);
  return whole;
}
static double of_unit(uint64_t bits) { return static_cast<double>(static_cast<int64_t>(bits)) * 0x1p-48; }
void srand48(long seed) { state_of_48 = uint64_t{static_cast<uint32_t>(seed)} << 16 | 0x330E; }
double drand48() { return of_unit(next_of_48(state_of_48)); }
double erand48(unsigned short state[3]) { return of_unit(next_of_words(state)); }
long lrand48() { return static_cast<long>(next_of_48(state_of_48) >> 17); }
long nrand48(unsigned short state[3]) { return static_cast<long>(next_of_words(state) >> 17); }
long mrand48() { return static_cast<int32_t>(next_of_48(state_of_48) >> 16); }
long jrand48(unsigned short state[3]) { return static_cast<int32_t>(next_of_words(state) >> 16); }

#ifdef SOFTCELL_CHECKED
void __tsan_write_range(const volatile void* at, size_t bytes);  // sdk/checked
#define SC_NOT_REPORTED __attribute__((no_sanitize("thread", "kernel-address")))
#else
#define SC_NOT_REPORTED
#endif

/// For the checker it writes both: not all bytes of an element need be written, such as its padding.
SC_NOT_REPORTED static void exchange(unsigned char* a, unsigned char* b, size_t bytes) {
#ifdef SOFTCELL_CHECKED
  __tsan_write_range(a, bytes);
  __tsan_write_range(b, bytes);
#endif
  for (size_t i = 0; i < bytes; ++i) {
    const unsigned char kept = a[i];
    a[i] = b[i];
    b[i] = kept;
  }
}

void qsort(void* array, size_t count, size_t bytes, int (*compare)(const void*, const void*)) {
  auto* const first = static_cast<unsigned char*>(array);
  const auto at = [&](size_t i) { return first + i * bytes; };
  // Lets an element sink to its place in the heap of the first `end`.
  const auto sink = [&](size_t root, size_t end) {
    for (;;) {
      size_t child = 2 * root + 1;
      if (child >= end) return;
      if (child + 1 < end && compare(at(child), at(child + 1)) < 0) ++child;
      if (compare(at(root), at(child)) >= 0) return;
      exchange(at(root), at(child), bytes);
      root = child;
    }
  };
  for (size_t root = count / 2; root-- > 0;) sink(root, count);
  for (size_t end = count; end-- > 1;) {
    exchange(at(0), at(end), bytes);
    sink(0, end);
  }
}

void* bsearch(const void* key, const void* array, size_t count, size_t bytes,
              int (*compare)(const void*, const void*)) {
  const auto* first = static_cast<const unsigned char*>(array);
  while (count != 0) {
    const auto* const middle = first + count / 2 * bytes;
    const int order = compare(key, middle);
    if (order == 0) return const_cast<unsigned char*>(middle);
    if (order > 0) {
      first = middle + bytes;
      count -= count / 2 + 1;
    } else {
      count /= 2;
    }
  }
  return nullptr;
}

}  // extern "C"
