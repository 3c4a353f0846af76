/* Files of the PPU side by streams and by numbers; scanf. `argp` is where the path lies that is to be used. */
#include <errno.h>
#include <fcntl.h>
#include <spu_mfcio.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "check.h"

static char path[256] __attribute__((aligned(128)));
static char other[260];

static void streams(void) {
  char line[32];
  int i, a = 0, b = 0;
  FILE* file = fopen(path, "w");
  CHECK(file != NULL);
  for (i = 0; i < 5; ++i) CHECK(fprintf(file, "%d %d\n", i, i * i) > 0);
  CHECK(fclose(file) == 0 && (file = fopen(path, "r")) != NULL);
  for (i = 0; i < 5; ++i) CHECK(fscanf(file, "%d %d", &a, &b) == 2 && a == i && b == i * i);
  CHECK(fscanf(file, "%d", &a) == EOF && feof(file) && !ferror(file));
  rewind(file);
  CHECK(!feof(file) && fgets(line, sizeof line, file) == line && strcmp(line, "0 0\n") == 0);
  CHECK(fgets(line, 3, file) == line && strcmp(line, "1 ") == 0 && fgetc(file) == '1' && getc(file) == '\n');
  CHECK(ungetc('x', file) == 'x' && fgetc(file) == 'x' && ftell(file) == 8);
  CHECK(fseek(file, -5, SEEK_END) == 0 && fread(line, 1, 4, file) == 4 && memcmp(line, "4 16", 4) == 0);
  CHECK(fread(line, 4, 2, file) == 0 && feof(file));
  clearerr(file);
  CHECK(!feof(file) && fgetc(file) == EOF && fclose(file) == 0);
  errno = 0;
  CHECK(fclose(file) == EOF && errno == EBADF);
  CHECK((file = fopen(path, "a+")) != NULL && fwrite("end", 1, 3, file) == 3 && fflush(file) == 0 && fclose(file) == 0);
  CHECK(fopen(path, "wx") == NULL && errno == EEXIST && fopen(path, "q") == NULL && errno == EINVAL);
  CHECK((file = tmpfile()) != NULL && fputs("text", file) >= 0 && fseek(file, 1, SEEK_SET) == 0 && fgetc(file) == 'e');
  CHECK(fclose(file) == 0);
}

static void other_files(void) {
  char line[32];
  fpos_t where;
  FILE* file = fopen(path, "w");
  CHECK(file != NULL && fputs("one\n", file) >= 0);
  strcat(strcpy(other, path), ".c");
  CHECK(freopen(other, "w", file) == file && fputs("two\nthree\n", file) >= 0);
  CHECK(freopen(path, "r", file) == file && fgets(line, sizeof line, file) == line && strcmp(line, "one\n") == 0);
  CHECK(freopen(other, "r", file) == file && fgets(line, sizeof line, file) == line && strcmp(line, "two\n") == 0);
  CHECK(fgetpos(file, &where) == 0 && fgets(line, sizeof line, file) == line && strcmp(line, "three\n") == 0);
  CHECK(fsetpos(file, &where) == 0 && fgetc(file) == 't');
  CHECK(freopen("/no/such/file", "r", file) == NULL && errno == ENOENT && fgetc(file) == EOF && errno == EBADF);
  CHECK(remove(other) == 0);
}

static void what_is_known(void) {
  struct stat known;
  const int file = open(path, O_RDWR | O_TRUNC);
  CHECK(write(file, "12345", 5) == 5 && fstat(file, &known) == 0 && known.st_size == 5 && S_ISREG(known.st_mode));
  CHECK(close(file) == 0 && stat(path, &known) == 0 && known.st_size == 5 && (known.st_mode & S_IRUSR) != 0);
  CHECK(known.st_nlink == 1 && labs((long)time(NULL) - known.st_mtime) < 1000 && lstat(path, &known) == 0 && known.st_size == 5);
  CHECK(stat("/", &known) == 0 && S_ISDIR(known.st_mode) && stat("/no/such/file", &known) == -1 && errno == ENOENT);
  CHECK(fstat(file, &known) == -1 && errno == EBADF);
}

static void numbers(void) {
  char text[16] = "";
  const int file = open(path, O_RDWR);
  CHECK(file >= 3 && lseek(file, 0, SEEK_END) == 21 + 3 && lseek(file, 4, SEEK_SET) == 4);
  CHECK(read(file, text, 3) == 3 && strcmp(text, "1 1") == 0 && write(file, "!", 1) == 1 && ftruncate(file, 8) == 0);
  CHECK(lseek(file, 0, SEEK_SET) == 0 && read(file, text, sizeof text) == 8 && text[7] == '!' && read(file, text, 1) == 0);
  CHECK(close(file) == 0 && close(file) == -1 && errno == EBADF);
  CHECK(access(path, R_OK | W_OK) == 0 && open("/no/such/file", O_RDONLY) == -1 && errno == ENOENT);
  CHECK(strcmp(strerror(errno), "No such file or directory") == 0);
  strcat(strcpy(other, path), ".b");
  CHECK(rename(path, other) == 0 && access(path, F_OK) == -1 && unlink(other) == 0 && remove(other) == -1);
  CHECK(creat(path, 0600) >= 0 && remove(path) == 0);
  CHECK(write(STDOUT_FILENO, "written\n", 8) == 8);
}

static void scanning(void) {
  int i = 0, n = 0;
  unsigned int x = 0;
  short h = 0;
  signed char hh = 0;
  long long ll = 0;
  float f = 0;
  double d = 0;
  char word[8] = "", set[8] = "", three[4] = "abc", c = 0;
  CHECK(sscanf("-12 0x1F 300 77 -1234567890123 2.5 1e-3", "%d %i %hd %hhd %lld %f %lf", &i, (int*)&x, &h, &hh, &ll, &f, &d) == 7);
  CHECK(i == -12 && x == 31 && h == 300 && hh == 77 && ll == -1234567890123ll && f == 2.5f && d == 1e-3);
  CHECK(sscanf("word,a-c]zz", "%4[a-z],%[^]]]%2c%n", word, set, three, &n) == 3 && n == 11);
  CHECK(strcmp(word, "word") == 0 && strcmp(set, "a-c") == 0 && three[0] == 'z' && three[2] == 'c');
  CHECK(sscanf("12345", "%2d%*1d%1d", &i, &n) == 2 && i == 12 && n == 4);
  CHECK(sscanf("ff 17", "%x %o", &x, &i) == 2 && x == 255 && i == 15);
  CHECK(sscanf("50%", "%d%%%n", &i, &n) == 1 && n == 3 && sscanf("x", "%d", &i) == 0 && sscanf("", "%d", &i) == EOF);
  CHECK(sscanf("  q", "%c", &c) == 1 && c == ' ' && sscanf("long word", "%3s", word) == 1 && strcmp(word, "lon") == 0);
  CHECK(strtol("7", NULL, 10) == 7 && strtod("2.5", NULL) == 2.5 && strtof("1e50", NULL) > 3e38f && errno == ERANGE && atof("x") == 0);
}

int main(uint64_t id, uint64_t argp) {
  (void)id;
  mfc_get(path, argp, sizeof path, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  streams();
  numbers();
  other_files();
  what_is_known();
  CHECK(remove(path) == 0);
  scanning();
  exit(failures);
}
