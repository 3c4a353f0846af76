/* The C library of the local store. */
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <libmisc.h>
#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "check.h"

static int by_value(const void* a, const void* b) { return *(const int*)a - *(const int*)b; }

static void strings(void) {
  char text[32] = "local";
  char list[] = "a,b;;c";
  int parts = 0;
  strcat(text, " store");
  CHECK(strcmp(text, "local store") == 0 && strlen(text) == 11 && strncmp(text, "locale", 5) == 0);
  CHECK(strchr(text, 's') == text + 6 && strrchr(text, 'l') == text + 4 && strstr(text, "sto") == text + 6);
  for (char* part = strtok(list, ",;"); part != NULL; part = strtok(NULL, ",;")) ++parts;
  CHECK(parts == 3);
  memmove(text + 1, text, 5);
  CHECK(memcmp(text, "llocal", 6) == 0 && memchr(text, 'c', 8) == text + 3);
  CHECK(strcasecmp("SPU", "spu") == 0 && strcspn("abc1", "0123") == 3 && toupper('q') == 'Q' &&
        !isalpha('1'));
}

static void numbers(void) {
  char* end;
  int values[50];
  CHECK(strtol("  -0x1Fz", &end, 0) == -31 && *end == 'z' && atoi("42") == 42);
  CHECK(strtol("99999999999", NULL, 10) == LONG_MAX && strtoul("4294967295", NULL, 10) == ULONG_MAX);
  CHECK(strtol("-2147483648", NULL, 10) == LONG_MIN && strtoll("-12345678901", NULL, 10) == -12345678901ll);
  errno = 0;
  CHECK(strtol("2147483647", NULL, 10) == LONG_MAX && strtol("-2147483648", NULL, 0) == LONG_MIN && errno == 0);
  CHECK(strtoul("4294967295", NULL, 10) == ULONG_MAX && strtoull("0xFFFFFFFFFFFFFFFF", NULL, 0) == ULLONG_MAX && errno == 0);
  CHECK(strtol("2147483648", &end, 10) == LONG_MAX && errno == ERANGE && *end == '\0');
  errno = 0;
  CHECK(strtol("-99999999999000", &end, 10) == LONG_MIN && errno == ERANGE && *end == '\0');
  errno = 0;
  CHECK(strtoul("4294967296", NULL, 10) == ULONG_MAX && errno == ERANGE);
  errno = 0;
  CHECK(strtoll("9223372036854775808", NULL, 10) == LLONG_MAX && errno == ERANGE);
  errno = 0;
  CHECK(strtoull("99999999999999999999999", NULL, 10) == ULLONG_MAX && errno == ERANGE);
  errno = 0;
  CHECK(strtol("12", &end, 37) == 0 && errno == EINVAL && *end == '1' && strtol("12", NULL, 1) == 0 && strtol("z", NULL, 36) == 35);
  CHECK(strtof("0.1", NULL) == 0.1f && strtof("-16777219", NULL) == -16777220 &&
        strtof("16777217", NULL) == 16777216);
  CHECK(strtof("1.1754944e-38", NULL) == 0x1p-126f && strtof("1e-39", NULL) == 0 &&
        strtof("3.4028235e38", NULL) == 0x1.FFFFFEp127f);
  srand(5);
  for (int i = 0; i < 50; ++i) values[i] = rand() % 1000;
  qsort(values, 50, sizeof values[0], by_value);
  for (int i = 1; i < 50; ++i) CHECK(values[i - 1] <= values[i]);
  CHECK(bsearch(&values[17], values, 50, sizeof values[0], by_value) != NULL && div(-7, 2).rem == -1);
}

struct Named {
  char name[100], kind;
  int value;
};
static int by_value_of(const void* a, const void* b) {
  return ((const struct Named*)a)->value - ((const struct Named*)b)->value;
}

/* Bytes that nobody has written may be copied with others. To be called while the heap is new. */
static void copies_of_new_memory(void) {
  struct Named* list = malloc(4 * sizeof list[0]);
  for (int i = 0; i < 4; ++i) {
    strcpy(list[i].name, "short");
    list[i].kind = (char)i;
    list[i].value = 4 - i;
  }
  struct Named* const copy = malloc(5 * sizeof list[0]);
  memcpy(copy, list, 4 * sizeof list[0]);
  memmove(copy + 1, copy, 4 * sizeof list[0]);
  qsort(list, 4, sizeof list[0], by_value_of);
  list = realloc(list, 8 * sizeof list[0]);
  CHECK(list[0].value == 1 && list[3].value == 4 && list[0].kind == 3 && copy[4].value == 1 &&
        strcmp(copy[4].name, "short") == 0);
  char* const untouched = realloc(malloc(100), 300);
  CHECK(untouched != NULL);
  free(untouched);
  free(copy);
  free(list);
}

static void heap(void) {
  char* blocks[16];
  int i;
  char* const large = malloc(100000);
  CHECK(large != NULL && ((uintptr_t)large & 15) == 0 && malloc(200000) == NULL);
  free(large);
  for (i = 0; i < 16; ++i) {
    blocks[i] = malloc(1000 + i);
    CHECK(blocks[i] != NULL);
    memset(blocks[i], i, 1000 + i);
  }
  for (i = 0; i < 16; ++i) CHECK(blocks[i][0] == i && blocks[i][999 + i] == i);
  for (i = 0; i < 16; i += 2) free(blocks[i]);
  for (i = 1; i < 16; i += 2) free(blocks[i]);
  char* const again = malloc(200000);
  CHECK(again != NULL);
  free(again);
  unsigned char bytes[40] = {0};
  int place;
  for (place = 0; place < 20; ++place) {
    store_vec_unaligned(bytes + place, ((vec_uchar16){7, 8, 9}));
    CHECK(bytes[place + 2] == 9 && bytes[place + 3] == 0 && spu_extract(load_vec_unaligned(bytes + place + 1), 0) == 8);
  }
  char* const aligned = malloc_align(300, 7);
  CHECK(((uintptr_t)aligned & 127) == 0);
  char* const grown = realloc(calloc(4, 4), 64);
  CHECK(grown != NULL && grown[0] == 0 && grown[15] == 0);
  free(grown);
  free_align(aligned);
}

/* As POSIX defines them, a PC has the same. */
static void random_numbers(void) {
  unsigned short state[3] = {0x330E, 1, 0};
  int i;
  srand48(1);
  CHECK(drand48() == 0x0.0aa849495101p0 && lrand48() == 976015093);
  CHECK(erand48(state) == 0x0.0aa849495101p0 && nrand48(state) == 976015093 && jrand48(state) == (long)3585512650u && state[2] == 0xD5B6);
  srand48(2009);
  CHECK(mrand48() == -1663586239 && mrand48() == 1168852354);
  srandom(5);
  const long first = random();
  for (i = 0; i < 100; ++i) CHECK(random() >= 0);
  srandom(5);
  CHECK(random() == first);
}

static void copies(void) {
  char text[8] = "";
  CHECK(strlcpy(text, "abc", sizeof text) == 3 && strlcat(text, "defghijk", sizeof text) == 11 && strcmp(text, "abcdefg") == 0);
  CHECK(strlcpy(text, "abc", 0) == 3 && text[0] == 'a' && strlcat(text, "x", 3) == 4);
  CHECK(memccpy(text, "12;34", ';', 5) == text + 3 && text[3] == 'd' && memccpy(text, "12", ';', 2) == NULL);
  CHECK(mempcpy(text, "xy", 2) == text + 2 && text[1] == 'y' && ffs(0) == 0 && ffs(0x50) == 5);
  CHECK(isascii('a') && !isascii(200) && toascii(200) == 72);
}

static char* written(const char* format, ...) {
  char* text;
  va_list list;
  va_start(list, format);
  CHECK(vasprintf(&text, format, list) >= 0);
  va_end(list);
  return text;
}

static void texts_of_any_length(void) {
  char* text;
  wchar_t wide[8];
  CHECK(asprintf(&text, "%d-%s", 12, "ab") == 5 && strcmp(text, "12-ab") == 0);
  free(text);
  text = written("%200s|%.1f", "x", 2.5);
  CHECK(strlen(text) == 204 && strcmp(text + 199, "x|2.5") == 0);
  free(text);
  CHECK(asprintf(&text, "%300000d", 1) == 4096);
  free(text);
  text = written("%ls|%5ls|%.2ls|%lc", L"wide", L"ab", L"\x20AC", (unsigned)L'\xE9');
  CHECK(strcmp(text, "wide|   ab||\xC3\xA9") == 0);
  CHECK(sscanf("caf\xC3\xA9 x", "%ls", wide) == 1 && wide[2] == L'f' && wide[3] == 0xE9 && wide[4] == 0);
  free(text);
}

static void other_names(void) {
  char text[] = "a,,b", copy[8], *rest = text;
  void* block = NULL;
  CHECK(strcmp(strsep(&rest, ","), "a") == 0 && strcmp(strsep(&rest, ","), "") == 0);
  CHECK(strcmp(strsep(&rest, ","), "b") == 0 && rest == NULL && strsep(&rest, ",") == NULL);
  CHECK(stpcpy(copy, "abc") == copy + 3 && index(copy, 'b') == copy + 1 && rindex(copy, 'z') == NULL);
  CHECK(bcmp(copy, "abc", 4) == 0);
  bcopy(copy, copy + 1, 3);
  CHECK(memcmp(copy, "aabc", 4) == 0);
  bzero(copy, 2);
  CHECK(copy[0] == 0 && copy[1] == 0 && copy[2] == 'b');
  char* const part = strndup("whole", 3);
  CHECK(part != NULL && strcmp(part, "who") == 0);
  free(part);
  CHECK(posix_memalign(&block, 64, 100) == 0 && ((uintptr_t)block & 63) == 0);
  free(block);
  CHECK(posix_memalign(&block, 16, 300000) == ENOMEM);
  CHECK(posix_memalign(&block, 24, 100) == EINVAL && posix_memalign(&block, 0, 100) == EINVAL);
  block = aligned_alloc(32, 64);
  CHECK(((uintptr_t)block & 31) == 0);
  free(block);
  int* const zeros = calloc_align(4, sizeof *zeros, 7);
  CHECK(((uintptr_t)zeros & 127) == 0 && zeros[0] == 0 && zeros[3] == 0);
  zeros[3] = 9;
  int* const more = realloc_align(zeros, 4000, 7);
  CHECK(more != NULL && ((uintptr_t)more & 127) == 0 && more[0] == 0 && more[3] == 9);
  CHECK(realloc_align(more, 100, 5) == more && realloc_align(more, 300000, 7) == NULL);
  free_align(more);
  char* end;
  char* const brief = alloca(300);
  memset(brief, 7, 300);
  CHECK(brief[299] == 7);
  errno = 0;
  CHECK(malloc(1000000) == NULL && errno == ENOMEM && calloc(1000, 1000) == NULL);
  CHECK(strtof("nan", NULL) != 1.5f && strtof("-nan(", &end) != 1.5f && *end == '(');
  CHECK(getenv("PATH") == NULL && strtold("2.5", NULL) == 2.5L);
  CHECK(setvbuf(stdout, NULL, _IONBF, 0) == 0);
  setbuf(stdout, NULL);
  CHECK(siprintf(copy, "%d", 42) == 2 && strcmp(copy, "42") == 0);
  CHECK(sniprintf(copy, 3, "%d", 1234) == 4 && strcmp(copy, "12") == 0);
  CHECK(iprintf("%s", "") == 0 && fiprintf(stdout, "%s", "") == 0);
}

static void output(void) {
  char text[80];
  CHECK(snprintf(text, sizeof text, "%d %u %s %c %5.2f|%-4x|%08llX %%", -1, 3000000000u, "spu", 'x', 3.14159,
                 0xABu, 0x123456789ull) == 42);
  CHECK(strcmp(text, "-1 3000000000 spu x  3.14|ab  |123456789 %") == 0);
  CHECK(sprintf(text, "%d%d%d%d%d%d%d%d %g %g", 1, 2, 3, 4, 5, 6, 7, 8, 0.5, 1.5) == 16 &&
        strcmp(text, "12345678 0.5 1.5") == 0);
  CHECK(snprintf(text, 4, "%s", "truncated") == 9 && strcmp(text, "tru") == 0);
  int count = 0;
  CHECK(sprintf(text, "%s%n|%d", "abc", &count, 7) == 5 && count == 3 && strcmp(text, "abc|7") == 0);
  CHECK(sprintf(text, "%ld %zu %hd %*d %.3s", -5l, sizeof text, (short)-2, 4, 7, "abcdef") == 17);
}

int main(int argc, char** argv) {
  random_numbers();
  copies();
  assert(failures == 0);
  strings();
  numbers();
  copies_of_new_memory();
  heap();
  other_names();
  texts_of_any_length();
  output();
  printf("%d failures of %s\n", failures, "library.c");
  exit(failures);
}
