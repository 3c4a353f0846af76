/* A cache in software: lines of main storage in the local store, looked up by their addresses. [SDK for Multicore Acceleration,
 * Programmer's Guide, software managed cache] documented
 *
 *     #define CACHE_NAME points        // a name of its own for each cache of a source
 *     #define CACHED_TYPE vec_float4   // what cache_rd() returns and cache_wr() stores
 *     #include <cache-api.h>
 *     ...
 *     vec_float4 v = cache_rd(points, argp + 16 * i);
 *     cache_wr(points, argp + 16 * i, v);
 *     cache_flush(points);             // before the program ends, or others look
 *
 * It may be included again after #undef of these names and of the settings:
 *
 *     CACHE_TYPE           CACHE_TYPE_RW (what it is without), or CACHE_TYPE_RO: no cache_wr(), cache_rw(), cache_flush()
 *     CACHELINE_LOG2SIZE   of a line's bytes: 4 to 14; 7
 *     CACHE_LOG2NSETS      of the number of sets: 0 to 12; 6
 *     CACHE_LOG2NWAY       of the lines of a set: 0 or 2; 2
 *     CACHE_SET_TAGID(set) the tag of a set's transfers; (set) & 31
 *
 * A value lies within one line. Addresses are effective addresses of main storage, of 32 or 64 bits.
 */
#ifndef SC_CACHE_API
#define SC_CACHE_API
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>

#define CACHE_TYPE_RO 0
#define CACHE_TYPE_RW 1

#define SC_CACHE_PASTE(name, what) softcell_cache_##name##_##what
#define SC_CACHE_OF(name, what) SC_CACHE_PASTE(name, what)

/* The value at an address. */
#define cache_rd(name, ea) SC_CACHE_OF(name, read)((uint64_t)(ea))
/* Those at four addresses of 32 bits, in lanes of a vector: of a type of four bytes. */
#define cache_rd_x4(name, ea_x4) SC_CACHE_OF(name, read_4)(ea_x4)
#define cache_wr(name, ea, value) SC_CACHE_OF(name, write)((uint64_t)(ea), (value))
/* Writes all changed lines to main storage and forgets all lines. */
#define cache_flush(name) SC_CACHE_OF(name, flush)()
/* Where a value lies in the local store that is written to, until the next use of the cache that misses, or as long as it is locked. */
#define cache_rw(name, ea) SC_CACHE_OF(name, pointer)((uint64_t)(ea))
/* Where a value lies that is only read; it does not wait for the line, which cache_wait() does. */
#define cache_touch(name, ea) SC_CACHE_OF(name, touch)((uint64_t)(ea))
#define cache_wait(name, pointer) SC_CACHE_OF(name, wait)(pointer)
/* The line of a pointer of cache_rw() or cache_touch() keeps its place. At least one line of a set has to be unlocked. */
#define cache_lock(name, pointer) SC_CACHE_OF(name, lock)(pointer, 1)
#define cache_unlock(name, pointer) SC_CACHE_OF(name, lock)(pointer, 0)
/* Statistics: none are kept. */
#define cache_pr_stats(name) ((void)0)
#endif

#ifndef CACHE_NAME
#error "define CACHE_NAME, the name of a cache, before you include <cache-api.h>"
#endif
#ifndef CACHED_TYPE
#error "define CACHED_TYPE, the type of what is cached, before you include <cache-api.h>"
#endif
#ifndef CACHE_TYPE
#define SC_OWN_CACHE_TYPE
#define CACHE_TYPE CACHE_TYPE_RW
#endif
#ifndef CACHELINE_LOG2SIZE
#define SC_OWN_CACHELINE_LOG2SIZE
#define CACHELINE_LOG2SIZE 7
#endif
#ifndef CACHE_LOG2NSETS
#define SC_OWN_CACHE_LOG2NSETS
#define CACHE_LOG2NSETS 6
#endif
#ifndef CACHE_LOG2NWAY
#define SC_OWN_CACHE_LOG2NWAY
#define CACHE_LOG2NWAY 2
#endif
#ifndef CACHE_SET_TAGID
#define SC_OWN_CACHE_SET_TAGID
#define CACHE_SET_TAGID(set) ((unsigned int)(set)&31u)
#endif
#if CACHELINE_LOG2SIZE < 4 || CACHELINE_LOG2SIZE > 14 || CACHE_LOG2NSETS < 0 || CACHE_LOG2NSETS > 12
#error "a cache has lines of 16 bytes to 16 KB and 1 to 4096 sets"
#endif
#if CACHE_LOG2NWAY != 0 && CACHE_LOG2NWAY != 2
#error "CACHE_LOG2NWAY is 0, a line for each set, or 2, four of them"
#endif

enum {
  SC_CACHE_OF(CACHE_NAME, line_bytes) = 1 << CACHELINE_LOG2SIZE,
  SC_CACHE_OF(CACHE_NAME, sets) = 1 << CACHE_LOG2NSETS,
  SC_CACHE_OF(CACHE_NAME, ways) = 1 << CACHE_LOG2NWAY
};
/* Of a line: where it lies in main storage, what is known of it, and how often it is locked. */
typedef struct {
  uint64_t ea;
  unsigned char is_there, is_changed, is_on_its_way, is_locked;
} SC_CACHE_OF(CACHE_NAME, line);
static char SC_CACHE_OF(CACHE_NAME, bytes)[1 << CACHE_LOG2NSETS][1 << CACHE_LOG2NWAY][1 << CACHELINE_LOG2SIZE]
    __attribute__((aligned(128)));
static SC_CACHE_OF(CACHE_NAME, line)
    SC_CACHE_OF(CACHE_NAME, lines)[1 << CACHE_LOG2NSETS][1 << CACHE_LOG2NWAY];
static unsigned char SC_CACHE_OF(CACHE_NAME, next)[1 << CACHE_LOG2NSETS]; /* to be replaced */
static int SC_CACHE_OF(CACHE_NAME, fetches);                              /* lines on their way */

static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, arrived)(int set) {
  int way;
  for (way = 0; way < SC_CACHE_OF(CACHE_NAME, ways); ++way) {
    SC_CACHE_OF(CACHE_NAME, fetches) -= SC_CACHE_OF(CACHE_NAME, lines)[set][way].is_on_its_way;
    SC_CACHE_OF(CACHE_NAME, lines)[set][way].is_on_its_way = 0;
  }
}
static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, wait_for)(int set) {
  const unsigned int mask = mfc_read_tag_mask(), tag = (CACHE_SET_TAGID(set));
  int other;
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
  mfc_write_tag_mask(mask);
  SC_CACHE_OF(CACHE_NAME, arrived)(set);
  for (other = 0; SC_CACHE_OF(CACHE_NAME, fetches) != 0 && other < SC_CACHE_OF(CACHE_NAME, sets); ++other)
    if ((unsigned int)(CACHE_SET_TAGID(other)) == tag) SC_CACHE_OF(CACHE_NAME, arrived)(other);
}

/* The way of the set that holds the line, or that it is being fetched to. */
static __attribute__((unused)) int SC_CACHE_OF(CACHE_NAME, find)(uint64_t ea, int set) {
  SC_CACHE_OF(CACHE_NAME, line)* const lines = SC_CACHE_OF(CACHE_NAME, lines)[set];
  const uint64_t begin = ea & ~(uint64_t)(SC_CACHE_OF(CACHE_NAME, line_bytes) - 1);
  const unsigned int tag = (CACHE_SET_TAGID(set));
  int way, tries;
  for (way = 0; way < SC_CACHE_OF(CACHE_NAME, ways); ++way)
    if (lines[way].is_there && lines[way].ea == begin) return way;
  way = SC_CACHE_OF(CACHE_NAME, next)[set];
  for (tries = 1; lines[way].is_locked && tries < SC_CACHE_OF(CACHE_NAME, ways); ++tries)
    way = (way + 1) % SC_CACHE_OF(CACHE_NAME, ways);
  SC_CACHE_OF(CACHE_NAME, next)[set] = (unsigned char)((way + 1) % SC_CACHE_OF(CACHE_NAME, ways));
  if (lines[way].is_on_its_way) SC_CACHE_OF(CACHE_NAME, wait_for)(set);
  if (lines[way].is_changed)
    mfc_put(SC_CACHE_OF(CACHE_NAME, bytes)[set][way], lines[way].ea, SC_CACHE_OF(CACHE_NAME, line_bytes), tag,
            0, 0);
  mfc_getf(SC_CACHE_OF(CACHE_NAME, bytes)[set][way], begin, SC_CACHE_OF(CACHE_NAME, line_bytes), tag, 0, 0);
  lines[way].ea = begin;
  lines[way].is_there = lines[way].is_on_its_way = 1;
  ++SC_CACHE_OF(CACHE_NAME, fetches);
  lines[way].is_changed = 0;
  return way;
}

static __attribute__((unused)) CACHED_TYPE* SC_CACHE_OF(CACHE_NAME, place)(uint64_t ea, int is_changed,
                                                                           int waits) {
  const int set = (int)(ea >> CACHELINE_LOG2SIZE) & (SC_CACHE_OF(CACHE_NAME, sets) - 1),
            way = SC_CACHE_OF(CACHE_NAME, find)(ea, set);
  if (waits && SC_CACHE_OF(CACHE_NAME, lines)[set][way].is_on_its_way) SC_CACHE_OF(CACHE_NAME, wait_for)(set);
  if (is_changed) SC_CACHE_OF(CACHE_NAME, lines)[set][way].is_changed = 1;
  return (CACHED_TYPE*)(void*)&SC_CACHE_OF(
      CACHE_NAME, bytes)[set][way][ea & (uint64_t)(SC_CACHE_OF(CACHE_NAME, line_bytes) - 1)];
}

static __attribute__((unused)) CACHED_TYPE SC_CACHE_OF(CACHE_NAME, read)(uint64_t ea) {
  return *SC_CACHE_OF(CACHE_NAME, place)(ea, 0, 1);
}
static __attribute__((unused)) vec_uint4 SC_CACHE_OF(CACHE_NAME, read_4)(vec_uint4 ea_x4) {
  vec_uint4 result = ea_x4;
  int lane;
  for (lane = 0; lane < 4; ++lane)
    result = spu_insert(
        *(const unsigned int*)(const void*)SC_CACHE_OF(CACHE_NAME, place)(spu_extract(ea_x4, lane), 0, 1),
        result, lane);
  return result;
}
static __attribute__((unused)) CACHED_TYPE* SC_CACHE_OF(CACHE_NAME, touch)(uint64_t ea) {
  return SC_CACHE_OF(CACHE_NAME, place)(ea, 0, 0);
}

/* The place of a pointer into the cache: the number of its line, the ways of all sets counted through. */
static __attribute__((unused)) int SC_CACHE_OF(CACHE_NAME, number)(const void* pointer) {
  return (int)(((const char*)pointer - &SC_CACHE_OF(CACHE_NAME, bytes)[0][0][0]) >> CACHELINE_LOG2SIZE);
}
static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, wait)(const void* pointer) {
  const int set = SC_CACHE_OF(CACHE_NAME, number)(pointer) >> CACHE_LOG2NWAY;
  SC_CACHE_OF(CACHE_NAME, wait_for)(set);
}
static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, lock)(const void* pointer, int is_locked) {
  const int number = SC_CACHE_OF(CACHE_NAME, number)(pointer);
  const int set = number >> CACHE_LOG2NWAY, way = number & (SC_CACHE_OF(CACHE_NAME, ways) - 1);
  SC_CACHE_OF(CACHE_NAME, lines)[set][way].is_locked = (unsigned char)is_locked;
}

#if CACHE_TYPE == CACHE_TYPE_RW
static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, write)(uint64_t ea, CACHED_TYPE value) {
  *SC_CACHE_OF(CACHE_NAME, place)(ea, 1, 1) = value;
}
static __attribute__((unused)) CACHED_TYPE* SC_CACHE_OF(CACHE_NAME, pointer)(uint64_t ea) {
  return SC_CACHE_OF(CACHE_NAME, place)(ea, 1, 1);
}
static __attribute__((unused)) void SC_CACHE_OF(CACHE_NAME, flush)(void) {
  int set, way;
  for (set = 0; set < SC_CACHE_OF(CACHE_NAME, sets); ++set) {
    int is_busy = 0;
    for (way = 0; way < SC_CACHE_OF(CACHE_NAME, ways); ++way) {
      SC_CACHE_OF(CACHE_NAME, line)* const line = &SC_CACHE_OF(CACHE_NAME, lines)[set][way];
      if (line->is_on_its_way) SC_CACHE_OF(CACHE_NAME, wait_for)(set);
      if (line->is_changed) {
        mfc_put(SC_CACHE_OF(CACHE_NAME, bytes)[set][way], line->ea, SC_CACHE_OF(CACHE_NAME, line_bytes),
                (CACHE_SET_TAGID(set)), 0, 0);
        is_busy = 1;
      }
      line->is_there = line->is_changed = line->is_locked = 0;
    }
    if (is_busy) SC_CACHE_OF(CACHE_NAME, wait_for)(set);
  }
}
#endif

/* What a cache is without, the next one is without, too. */
#ifdef SC_OWN_CACHE_TYPE
#undef SC_OWN_CACHE_TYPE
#undef CACHE_TYPE
#endif
#ifdef SC_OWN_CACHELINE_LOG2SIZE
#undef SC_OWN_CACHELINE_LOG2SIZE
#undef CACHELINE_LOG2SIZE
#endif
#ifdef SC_OWN_CACHE_LOG2NSETS
#undef SC_OWN_CACHE_LOG2NSETS
#undef CACHE_LOG2NSETS
#endif
#ifdef SC_OWN_CACHE_LOG2NWAY
#undef SC_OWN_CACHE_LOG2NWAY
#undef CACHE_LOG2NWAY
#endif
#ifdef SC_OWN_CACHE_SET_TAGID
#undef SC_OWN_CACHE_SET_TAGID
#undef CACHE_SET_TAGID
#endif
