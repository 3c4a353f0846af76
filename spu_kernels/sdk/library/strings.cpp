// Strings, and kinds of characters in the locale "C".

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

extern "C" {

int islower(int c) { return c >= 'a' && c <= 'z'; }
int isupper(int c) { return c >= 'A' && c <= 'Z'; }
int isdigit(int c) { return c >= '0' && c <= '9'; }
int isalpha(int c) { return islower(c) || isupper(c); }
int isalnum(int c) { return isalpha(c) || isdigit(c); }
int isblank(int c) { return c == ' ' || c == '\t'; }
int isspace(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
int iscntrl(int c) { return (c >= 0 && c < ' ') || c == 0x7F; }
int isprint(int c) { return c >= ' ' && c < 0x7F; }
int isgraph(int c) { return c > ' ' && c < 0x7F; }
int ispunct(int c) { return isgraph(c) && !isalnum(c); }
int isxdigit(int c) { return isdigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
int tolower(int c) { return isupper(c) ? c + ('a' - 'A') : c; }
int toupper(int c) { return islower(c) ? c - ('a' - 'A') : c; }

size_t strnlen(const char* s, size_t most) {
  size_t n = 0;
  while (n < most && s[n] != '\0') ++n;
  return n;
}
size_t strlen(const char* s) { return strnlen(s, ~size_t{0}); }

char* strcpy(char* to, const char* from) {
  size_t i = 0;
  do to[i] = from[i];
  while (from[i++] != '\0');
  return to;
}
char* strncpy(char* to, const char* from, size_t most) {
  const size_t n = strnlen(from, most);
  memcpy(to, from, n);
  memset(to + n, 0, most - n);
  return to;
}
char* strncat(char* to, const char* from, size_t most) {
  const size_t at = strlen(to), n = strnlen(from, most);
  memcpy(to + at, from, n);
  to[at + n] = '\0';
  return to;
}
char* strcat(char* to, const char* from) { return strncat(to, from, ~size_t{0}); }

static int compare(const char* a, const char* b, size_t most, int (*kind)(int)) {
  for (size_t i = 0; i < most; ++i) {
    const int left = kind(static_cast<unsigned char>(a[i])), right = kind(static_cast<unsigned char>(b[i]));
    if (left != right) return left - right;
    if (left == 0) return 0;
  }
  return 0;
}
static int as_it_is(int c) { return c; }
int strcmp(const char* a, const char* b) { return compare(a, b, ~size_t{0}, as_it_is); }
int strncmp(const char* a, const char* b, size_t most) { return compare(a, b, most, as_it_is); }
int strcasecmp(const char* a, const char* b) { return compare(a, b, ~size_t{0}, tolower); }
int strncasecmp(const char* a, const char* b, size_t most) { return compare(a, b, most, tolower); }

char* strchr(const char* s, int c) { return static_cast<char*>(memchr(s, c, strlen(s) + 1)); }
char* strrchr(const char* s, int c) {
  for (size_t i = strlen(s) + 1; i-- > 0;)
    if (s[i] == static_cast<char>(c)) return const_cast<char*>(s + i);
  return nullptr;
}
char* strstr(const char* s, const char* part) {
  const size_t n = strlen(part);
  for (;; ++s) {
    if (strncmp(s, part, n) == 0) return const_cast<char*>(s);
    if (*s == '\0') return nullptr;
  }
}

static size_t run_of(const char* s, const char* these, bool inside) {
  size_t n = 0;
  while (s[n] != '\0' && (strchr(these, s[n]) != nullptr) == inside) ++n;
  return n;
}
size_t strspn(const char* s, const char* these) { return run_of(s, these, true); }
size_t strcspn(const char* s, const char* these) { return run_of(s, these, false); }
char* strpbrk(const char* s, const char* these) {
  s += strcspn(s, these);
  return *s == '\0' ? nullptr : const_cast<char*>(s);
}

char* strtok_r(char* s, const char* separators, char** rest) {
  if (s == nullptr) s = *rest;
  s += strspn(s, separators);
  char* const end = s + strcspn(s, separators);
  *rest = *end == '\0' ? end : end + 1;
  *end = '\0';
  return end == s ? nullptr : s;
}
char* strtok(char* s, const char* separators) {
  static char* rest;
  return strtok_r(s, separators, &rest);
}

char* strdup(const char* s) {
  const size_t bytes = strlen(s) + 1;
  auto* const copy = static_cast<char*>(malloc(bytes));
  return copy == nullptr ? nullptr : static_cast<char*>(memcpy(copy, s, bytes));
}

char* strndup(const char* s, size_t most) {
  const size_t bytes = strnlen(s, most);
  auto* const copy = static_cast<char*>(malloc(bytes + 1));
  if (copy == nullptr) return nullptr;
  memcpy(copy, s, bytes);
  copy[bytes] = '\0';
  return copy;
}

void* mempcpy(void* to, const void* from, size_t bytes) {
  return static_cast<char*>(memcpy(to, from, bytes)) + bytes;
}
void* memccpy(void* to, const void* from, int c, size_t most) {
  const auto* const found = static_cast<const char*>(memchr(from, c, most));
  const size_t bytes =
      found == nullptr ? most : static_cast<size_t>(found + 1 - static_cast<const char*>(from));
  void* const end = mempcpy(to, from, bytes);
  return found == nullptr ? nullptr : end;
}
size_t strlcpy(char* to, const char* from, size_t room) {
  const size_t length = strlen(from);
  if (room == 0) return length;
  const size_t bytes = length < room ? length : room - 1;
  memcpy(to, from, bytes);
  to[bytes] = '\0';
  return length;
}
size_t strlcat(char* to, const char* from, size_t room) {
  const size_t at = strnlen(to, room);
  return at + strlcpy(to + at, from, room - at);
}

char* stpcpy(char* to, const char* from) { return strcpy(to, from) + strlen(from); }

char* strsep(char** rest, const char* separators) {
  char* const token = *rest;
  if (token == nullptr) return nullptr;
  char* const end = token + strcspn(token, separators);
  *rest = *end == '\0' ? nullptr : end + 1;
  *end = '\0';
  return token;
}

void bzero(void* to, size_t bytes) { memset(to, 0, bytes); }
void bcopy(const void* from, void* to, size_t bytes) { memmove(to, from, bytes); }

char* strerror(int error) {
  static const struct {
    int number;
    const char* text;
  } kErrors[] = {{0, "Success"},
                 {EPERM, "Operation not permitted"},
                 {ENOENT, "No such file or directory"},
                 {EINTR, "Interrupted system call"},
                 {EIO, "Input/output error"},
                 {EBADF, "Bad file descriptor"},
                 {EAGAIN, "Resource temporarily unavailable"},
                 {ENOMEM, "Cannot allocate memory"},
                 {EACCES, "Permission denied"},
                 {EFAULT, "Bad address"},
                 {EBUSY, "Device or resource busy"},
                 {EEXIST, "File exists"},
                 {EXDEV, "Invalid cross-device link"},
                 {ENOTDIR, "Not a directory"},
                 {EISDIR, "Is a directory"},
                 {EINVAL, "Invalid argument"},
                 {ENFILE, "Too many open files in system"},
                 {EMFILE, "Too many open files"},
                 {EFBIG, "File too large"},
                 {ENOSPC, "No space left on device"},
                 {ESPIPE, "Illegal seek"},
                 {EROFS, "Read-only file system"},
                 {EPIPE, "Broken pipe"},
                 {EDOM, "Numerical argument out of domain"},
                 {ERANGE, "Numerical result out of range"},
                 {ENAMETOOLONG, "File name too long"},
                 {ENOSYS, "Function not implemented"},
                 {EOVERFLOW, "Value too large for defined data type"}};
  for (const auto& known : kErrors)
    if (known.number == error) return const_cast<char*>(known.text);
  return const_cast<char*>("Unknown error");
}

}  // extern "C"
