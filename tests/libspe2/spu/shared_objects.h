/* What the PPU side and the SPEs of shared_objects share: objects of libsync.h, each in a line of its own, and what they protect. */
#ifndef SHARED_OBJECTS_H
#define SHARED_OBJECTS_H
#include <libsync.h>

enum {
  kSpes = 4,
  kThreads = 2,
  kAll = kSpes + kThreads,
  kPlaces = 3, /* of the queue: fewer than there are producers and consumers */
  kNumbers = 40,
  kRounds = 40,
  kPasses = 20
};

typedef struct {
  unsigned int word, others[31];
} __attribute__((aligned(128))) object_t;

typedef struct {
  unsigned int first, count, numbers[30];
} __attribute__((aligned(128))) queue_t;

typedef struct {
  unsigned int same[32];
} __attribute__((aligned(128))) page_t;

typedef struct {
  object_t start, one, passed; /* completions, and how many have passed the second */
  condition_variable_t gate;
  object_t gate_mutex, waiting, opened; /* its lock, how many wait for it and have left it */
  object_t mutex, filled, emptied, sum;
  queue_t queue;
  object_t lock, readers;
  page_t page; /* all its words are the same unless a writer is at work */
  object_t ping, pong;
} shared_t;

typedef struct {
  unsigned long long shared;
  unsigned int index, unused;
} __attribute__((aligned(16))) job_t;

#endif
