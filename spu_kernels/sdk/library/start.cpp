// How a program begins and ends.

#include <assert.h>
#include <spu_mfcio.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/spu_event.h>
#include <sys/spu_thread.h>

extern "C" {

using Function = void();
extern Function* const softcell_constructors[] __attribute__((visibility("hidden")));
extern Function* const softcell_constructors_end[] __attribute__((visibility("hidden")));
extern Function* const softcell_destructors[] __attribute__((visibility("hidden")));
extern Function* const softcell_destructors_end[] __attribute__((visibility("hidden")));

/// The program's main, whatever its parameters: what it does not take is left alone. Numbers and vectors come in registers of different
/// kinds.
using Words = softcell_sdk::Raw<unsigned int>;
int softcell_main(uint64_t, uint64_t, uint64_t, uint64_t, Words, Words, Words)
    __attribute__((visibility("hidden")));

/// Where the image is entered.
int softcell_start(uint64_t first, uint64_t second, uint64_t third, uint64_t fourth, Words one, Words two,
                   Words three) {
  for (Function* const* constructor = softcell_constructors; constructor != softcell_constructors_end;
       ++constructor)
    (*constructor)();
  exit(softcell_main(first, second, third, fourth, one, two, three));
}

// What is to be called when the program ends: the last first.

struct AtExit {
  AtExit* before;
  void (*function)(void*);
  void* object;
};
static AtExit* at_exit;
static AtExit first_at_exit[32];
static unsigned int at_exit_count;

static void add_at_exit(AtExit* entry, void (*function)(void*), void* object) {
  *entry = {at_exit, function, object};
  at_exit = entry;
}

/// The object is the function that was given to atexit().
static void call_function(void* function) { reinterpret_cast<Function*>(function)(); }

int atexit(Function* function) {
  if (at_exit_count == sizeof first_at_exit / sizeof first_at_exit[0]) return -1;
  add_at_exit(&first_at_exit[at_exit_count++], &call_function, reinterpret_cast<void*>(function));
  return 0;
}

/// The destructor of a static object. Where the heap has no room for the note, the object is not destroyed.
int __cxa_atexit(void (*destructor)(void*), void* object, void*) {
  auto* const entry = static_cast<AtExit*>(malloc(sizeof(AtExit)));
  if (entry == nullptr) return -1;
  add_at_exit(entry, destructor, object);
  return 0;
}
void* __dso_handle = nullptr;

void exit(int status) {
  while (at_exit != nullptr) {
    const AtExit* const last = at_exit;
    at_exit = last->before;
    last->function(last->object);
  }
  at_exit_count = 0;  // an SPE context may run the program again
  for (Function* const* next = softcell_destructors_end; next != softcell_destructors;) (*--next)();
  _exit(status);
}

void _exit(int status) {
  softcell_sdk::call_gate(softcell_sdk::kStop, 0, 0x2000u | (static_cast<unsigned int>(status) & 0xFFu));
  __builtin_trap();  // a run that has ended is not resumed
}

char* getenv(const char*) { return nullptr; }

void abort() {
  fputs("abort() was called\n", stderr);
  _exit(1);
}

void softcell_assertion_failed(const char* condition, const char* file, int line, const char* function) {
  fprintf(stderr, "%s:%d: %s: assertion \"%s\" failed\n", file, line, function, condition);
  _exit(1);
}

// Stop codes of lv2. [PSL1GHT, libsputhread] documented

void spu_thread_exit(int status) {
  spu_write_out_mbox(static_cast<unsigned int>(status));
  spu_stop(0x102);
  __builtin_trap();
}

void spu_thread_group_exit(int status) {
  spu_write_out_mbox(static_cast<unsigned int>(status));
  spu_stop(0x101);
  __builtin_trap();
}

// Messages to lv2 go through the interrupt mailbox: what is asked, and 24 bits. [PSL1GHT, libsputhread; RPCS3] documented

static void post_event(uint32_t request, uint32_t data0, uint32_t data1) {
  spu_write_out_mbox(data1);
  spu_write_out_intr_mbox(request << 24 | (data0 & 0xFFFFFF));
}

int spu_thread_send_event(uint8_t port, uint32_t data0, uint32_t data1) {
  post_event(port & 63u, data0, data1);
  return static_cast<int>(spu_read_in_mbox());
}

int spu_thread_throw_event(uint8_t port, uint32_t data0, uint32_t data1) {
  post_event(64u | (port & 63u), data0, data1);
  return 0;
}

static const uint32_t kBusy = 0x8001000A;  // of lv2

static int read_event(uint32_t* data0, uint32_t* data1, uint32_t* data2) {
  const uint32_t error = spu_read_in_mbox();
  if (error != 0) return static_cast<int>(error);
  *data0 = spu_read_in_mbox();
  *data1 = spu_read_in_mbox();
  *data2 = spu_read_in_mbox();
  return 0;
}

int spu_thread_receive_event(uint32_t spuq, uint32_t* data0, uint32_t* data1, uint32_t* data2) {
  if (spu_stat_in_mbox() != 0) return static_cast<int>(kBusy);  // the answer would stand behind it
  spu_write_out_mbox(spuq);
  spu_stop(0x110);
  return read_event(data0, data1, data2);
}

int spu_thread_tryreceive_event(uint32_t spuq, uint32_t* data0, uint32_t* data1, uint32_t* data2) {
  if (spu_stat_in_mbox() != 0) return static_cast<int>(kBusy);
  spu_write_out_mbox(spuq);
  spu_stop(0x111);
  return read_event(data0, data1, data2);
}

void spu_thread_group_yield() { spu_stop(0x100); }

}  // extern "C"
