#pragma once
// Memory between the image and its stack, numbers from text, sorting, and how a program ends. [C17, 7.22]

#ifndef __STRICT_ANSI__
#include <alloca.h>
#endif
#include <stddef.h>
#include <sys/cdefs.h>

#define EXIT_SUCCESS 0
#define EXIT_FAILURE 1
#define RAND_MAX 0x7FFFFFFF

typedef struct {
  int quot, rem;
} div_t;
typedef struct {
  long quot, rem;
} ldiv_t;
typedef struct {
  long long quot, rem;
} lldiv_t;

__BEGIN_DECLS
/// Memory of the heap, which lies between bss and the declared stack, aligned to 16 bytes. Null when there is no room.
void* malloc(size_t bytes);
void* calloc(size_t count, size_t bytes);
void* realloc(void* old, size_t bytes);
/// @param alignment  a power of two
void* memalign(size_t alignment, size_t bytes);
void* aligned_alloc(size_t alignment, size_t bytes);
/// @return  ENOMEM when there is no room
int posix_memalign(void** memory, size_t alignment, size_t bytes);
void free(void* memory);

int abs(int value);
long labs(long value);
long long llabs(long long value);
div_t div(int a_, int b_);
ldiv_t ldiv(long a_, long b_);
lldiv_t lldiv(long long a_, long long b_);
int atoi(const char* text);
long atol(const char* text);
long long atoll(const char* text);
long strtol(const char* text, char** end, int base);
unsigned long strtoul(const char* text, char** end, int base);
long long strtoll(const char* text, char** end, int base);
unsigned long long strtoull(const char* text, char** end, int base);
/// The nearest double of a number with up to 19 significant digits; more of them count only where these lie exactly between two doubles.
/// What is smaller than the smallest normal double is 0, and what is too large infinite; both set errno to ERANGE.
double strtod(const char* text, char** end);
/// The float nearest to that double, where too large ones are the largest and those below 2^-126 are 0.
float strtof(const char* text, char** end);
long double strtold(const char* text, char** end) __asm__("strtod");
double atof(const char* text);

/// The same numbers in every run. rand() is 0..RAND_MAX.
int rand(void);
int rand_r(unsigned int* state);
void srand(unsigned int seed);
/// As rand(), with a state of its own.
long random(void);
void srandom(unsigned int seed);
/// POSIX defines these numbers, so that they are those of a PC, too: doubles in [0, 1), longs from 0 or from -2^31 on. Those with a
/// state use that, the others share one.
double drand48(void);
double erand48(unsigned short state[3]);
long lrand48(void);
long nrand48(unsigned short state[3]);
long mrand48(void);
long jrand48(unsigned short state[3]);
void srand48(long seed);

/// Heapsort: no memory and no recursion. Equal elements may change places.
void qsort(void* array, size_t count, size_t bytes, int (*compare)(const void*, const void*));
void* bsearch(const void* key, const void* array, size_t count, size_t bytes,
              int (*compare)(const void*, const void*));

/// Ends the program with the stop code 0x2000 + the low eight bits of the status.
void exit(int status) __attribute__((noreturn));
void _exit(int status) __attribute__((noreturn));
void _Exit(int status) __asm__("_exit") __attribute__((noreturn));
/// A local store has no environment: always null.
char* getenv(const char* name);
/// Ends it with status 1 and a message.
void abort(void) __attribute__((noreturn));
/// Called by exit(), the last first; 32 at most. @return  0, or -1 when there is no room.
int atexit(void (*function)(void));
__END_DECLS
