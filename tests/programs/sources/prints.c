/* Every way to print, and to read what is typed: "12 apples", a line, and nothing more. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int print(const char* format, ...) {
  va_list list;
  int result;
  va_start(list, format);
  result = vprintf(format, list);
  va_end(list);
  return result;
}
static int print_to(FILE* file, const char* format, ...) {
  va_list list;
  int result;
  va_start(list, format);
  result = vfprintf(file, format, list);
  va_end(list);
  return result;
}
static int into(char* text, size_t bytes, const char* format, ...) {
  va_list list;
  int result;
  va_start(list, format);
  result = bytes == 0 ? vsprintf(text, format, list) : vsnprintf(text, bytes, format, list);
  va_end(list);
  return result;
}
static int from_text(const char* text, const char* format, ...) {
  va_list list;
  int result;
  va_start(list, format);
  result = vsscanf(text, format, list);
  va_end(list);
  return result;
}
static int from_input(int by_stream, const char* format, ...) {
  va_list list;
  int result;
  va_start(list, format);
  result = by_stream ? vfscanf(stdin, format, list) : vscanf(format, list);
  va_end(list);
  return result;
}

int main(void) {
  char text[64], word[16], line[64];
  int a = 0, b = 0;
  double d = 0;
  print("%d %s %.2f\n", 1, "vprintf", 2.5);
  print_to(stdout, "%c%c%c %lld\n", 'v', 'f', 'p', 12345678901ll);
  into(text, 0, "%s-%d", "vsprintf", 7);
  puts(text);
  into(text, 6, "%s", "vsnprintf");
  puts(text);
  fputc('f', stdout);
  putc('p', stdout);
  putchar('c');
  putchar('\n');
  fputs("fputs\n", stdout);
  fwrite("fwrite\n", 1, 7, stdout);
  if (from_text("3 4.5", "%d %lf", &a, &d) == 2) printf("%d %g\n", a, d);
  if (from_input(0, "%d", &a) == 1 && from_input(1, "%15s", word) == 1) printf("read %d %s\n", a, word);
  printf("%d\n", getchar() == '\n');
  if (fgets(line, sizeof line, stdin) != NULL) printf("line %s", line);
  printf("%d %d\n", getchar() == EOF, scanf("%d", &b));
  printf("%d\n", fileno(stdout));
  errno = ENOENT;
  perror("perror");
  errno = EBADF;
  perror(NULL);
  fflush(stdout);
  _exit(5);
}
