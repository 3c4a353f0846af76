#ifndef SHARED_H
#define SHARED_H
typedef struct {
  unsigned int count, factor, sum, pad[29];
} work_t;
int calls; /* in every source that includes it */
static inline int doubled(int x) { return 2 * x; }
#endif
