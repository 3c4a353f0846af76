/* ctype.h for every character, and the functions of string.h and stdlib.h that the other programs do not call. */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "check.h"

static void kinds(void) {
  static const char punctuation[] = "!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~";
  int c;
  for (c = 0; c < 256; ++c) {
    const int lower = c >= 'a' && c <= 'z', upper = c >= 'A' && c <= 'Z', digit = c >= '0' && c <= '9';
    const int mark = c != 0 && c < 128 && strchr(punctuation, c) != NULL;
    CHECK(!!islower(c) == lower && !!isupper(c) == upper && !!isdigit(c) == digit && !!ispunct(c) == mark);
    CHECK(!!isalpha(c) == (lower || upper) && !!isalnum(c) == (lower || upper || digit));
    CHECK(!!isgraph(c) == (lower || upper || digit || mark) && !!isprint(c) == (isgraph(c) || c == ' '));
    CHECK(!!isspace(c) == (c == ' ' || (c >= 9 && c <= 13)) && !!isblank(c) == (c == ' ' || c == 9));
    CHECK(!!iscntrl(c) == (c < 32 || c == 127) && !!isxdigit(c) == (digit || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')));
    CHECK(tolower(c) == (upper ? c + 32 : c) && toupper(c) == (lower ? c - 32 : c));
  }
}

static void strings(void) {
  char text[16], *rest = NULL, *copy;
  memset(text, 'x', sizeof text);
  CHECK(strncpy(text, "ab", 5) == text && memcmp(text, "ab\0\0\0x", 6) == 0 && strncpy(text, "abcdef", 3) && text[2] == 'c' && text[3] == 0);
  CHECK(strcmp(strncat(text, "defgh", 2), "abcde") == 0 && strnlen(text, 3) == 3 && strnlen(text, 99) == 5);
  CHECK(strspn(text, "cab") == 3 && strspn(text, "x") == 0 && strpbrk(text, "xdc") == text + 2 && strpbrk(text, "z") == NULL);
  CHECK(strncasecmp("Local", "lOCKED", 3) == 0 && strncasecmp("Local", "lOCKED", 4) < 0);
  CHECK((copy = strdup(text)) != NULL && copy != text && strcmp(copy, text) == 0);
  CHECK(strcmp(strtok_r(strcpy(copy, "a--b"), "-", &rest), "a") == 0 && strcmp(strtok_r(NULL, "-", &rest), "b") == 0);
  CHECK(strtok_r(NULL, "-", &rest) == NULL && memcmp(memcpy(text, "12", 3), "12", 3) == 0);
  CHECK(strcmp(strerror(0), "Success") == 0 && strcmp(strerror(ERANGE), "Numerical result out of range") == 0);
  CHECK(strcmp(strerror(12345), "Unknown error") == 0);
  free(copy);
}

static void integers(void) {
  unsigned int seed = 1, again = 1;
  CHECK(atol("-7") == -7 && atoll("9000000000") == 9000000000ll && strtoull("18446744073709551615", NULL, 10) == ULLONG_MAX);
  CHECK(abs(-3) == 3 && labs(-4l) == 4 && llabs(-5000000000ll) == 5000000000ll);
  CHECK(ldiv(-7, 2).quot == -3 && ldiv(-7, 2).rem == -1 && lldiv(7000000000ll, 3).rem == 1);
  CHECK(rand_r(&seed) == rand_r(&again) && seed == again && rand_r(&seed) >= 0);
}

int main(void) {
  kinds();
  strings();
  integers();
  _Exit(failures);
}
