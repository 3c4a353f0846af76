/* Counts words with pointers in static tables, structures, unions and the C library; prints by itself. */
#include <ctype.h>
#include <spu_mfcio.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
  struct entry *next;
  unsigned count;
  char word[];
} entry;

typedef unsigned (*hash_function)(const char *);
static unsigned first_letter(const char *w) { return (unsigned char)w[0]; }
static unsigned sum_of_letters(const char *w) {
  unsigned s = 0;
  while (*w) s = s * 31 + (unsigned char)*w++;
  return s;
}
static const struct {
  const char *name;
  hash_function hash;
} hashes[] = {{"first", first_letter}, {"sum", sum_of_letters}};

static entry *table[16];
static char text[1024] __attribute__((aligned(128)));

static int by_count(const void *a, const void *b) {
  const entry *x = *(entry *const *)a, *y = *(entry *const *)b;
  if (x->count != y->count) return x->count < y->count ? 1 : -1;
  return strcmp(x->word, y->word);
}

int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  hash_function hash = hashes[envp % 2].hash;
  entry *all[64];
  unsigned n = 0, i;
  char *word;
  (void)id;
  mfc_get(text, argp, sizeof text, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  for (i = 0; text[i]; i++) text[i] = isalpha((unsigned char)text[i]) ? tolower((unsigned char)text[i]) : ' ';
  for (word = strtok(text, " "); word; word = strtok(NULL, " ")) {
    entry **at = &table[hash(word) % 16];
    while (*at && strcmp((*at)->word, word) != 0) at = &(*at)->next;
    if (!*at) {
      *at = malloc(sizeof(entry) + strlen(word) + 1);
      if (!*at) abort();
      (*at)->next = NULL;
      (*at)->count = 0;
      strcpy((*at)->word, word);
      all[n++] = *at;
    }
    (*at)->count++;
  }
  qsort(all, n, sizeof all[0], by_count);
  for (i = 0; i < 3 && i < n; i++) printf("%-6s %2u\n", all[i]->word, all[i]->count);
  printf("%u words, %s\n", n, hashes[envp % 2].name);
  fflush(stdout);
  return (int)n;
}
