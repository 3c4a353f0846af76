/* Reads in blocks of its heap what functions that the PPU side serves have written there. Returns 0, or the number of the one that
   differs. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#define TEXT "42 words\nanother line\n"

static char* block(void) { return malloc(100); }

static int reads_a_file(const char* name) {
  char *line = block(), *bytes = block(), *word = block(), *descriptor = block();
  int* number = malloc(sizeof *number);
  FILE* file = fopen(name, "r");
  int fd;
  if (fgets(line, 100, file) != line || strcmp(line, "42 words\n") != 0) return 10;
  if (fread(bytes, 1, 7, file) != 7 || memcmp(bytes, "another", 7) != 0) return 11;
  if (fscanf(file, "%99s", word) != 1 || strcmp(word, "line") != 0) return 12;
  rewind(file);
  if (fscanf(file, "%d", number) != 1 || *number != 42) return 13;
  fclose(file);
  fd = open(name, O_RDONLY);
  if (read(fd, descriptor, 8) != 8 || memcmp(descriptor, "42 words", 8) != 0) return 14;
  close(fd);
  return 0;
}

int main(void) {
  char *printed = block(), *shortened = block(), *name = block();
  int* scanned = malloc(sizeof *scanned);
  struct timeval* now = malloc(sizeof *now);
  FILE* file;
  int result;
  sprintf(printed, "%d", 42);
  if (atoi(printed) != 42) return 1;
  snprintf(shortened, 3, "%d", 1234);
  if (strcmp(shortened, "12") != 0) return 2;
  if (sscanf("7 dwarfs", "%d", scanned) != 1 || *scanned != 7) return 3;
  gettimeofday(now, NULL);
  if (now->tv_sec == 0) return 4;
  sprintf(name, "/tmp/reads_what_the_ppu_wrote.%lu.%lu", (unsigned long)now->tv_sec,
          (unsigned long)now->tv_usec);
  file = fopen(name, "w");
  if (file == NULL || fputs(TEXT, file) < 0 || fclose(file) != 0) return 5;
  result = reads_a_file(name);
  remove(name);
  return result;
}
