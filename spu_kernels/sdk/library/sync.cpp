// libsync.h: a word in main storage is changed in its line, again until nobody else has written the line meanwhile.

#include <libsync.h>
#include <spu_mfcio.h>

namespace {

struct alignas(128) Line {
  int words[32];
};
Line line;

int& word_at(unsigned long long ea) { return line.words[(ea & 127) / sizeof(int)]; }

void reserve(unsigned long long ea) {
  mfc_getllar(&line, ea & ~127ull, 0, 0);
  mfc_read_atomic_status();
}

struct Update {
  bool changed;
  int before;
};

/// Makes `change` of the word; it returns false to leave it as it is.
template <class Change>
Update update(unsigned long long ea, Change change) {
  for (;;) {
    reserve(ea);
    const int before = word_at(ea);
    if (!change(word_at(ea))) return {false, before};
    mfc_putllc(&line, ea & ~127ull, 0, 0);
    if ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) == 0) return {true, before};
  }
}

/// Makes `change` of the word as soon as it no longer leaves it as it is, and sleeps until then. Events of the program stay pending.
template <class Change>
void update_in_time(unsigned long long ea, Change change) {
  if (update(ea, change).changed) return;
  const unsigned int mask = spu_read_event_mask();
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  for (;;) {
    spu_write_event_ack(MFC_LLR_LOST_EVENT);  // of reservations before this one
    if (update(ea, change).changed) break;
    spu_read_event_status();
  }
  spu_write_event_mask(mask);
}

int add(int value, unsigned long long ea) {
  return update(ea,
                [value](int& word) {
                  word = static_cast<int>(static_cast<unsigned int>(word) + static_cast<unsigned int>(value));
                  return true;
                })
      .before;
}

bool take(int& mutex) {
  if (mutex != 0) return false;
  mutex = 1;
  return true;
}
bool begin_to_read(int& lock) {
  if (lock < 0) return false;
  ++lock;
  return true;
}
bool begin_to_write(int& lock) {
  if (lock != 0) return false;
  lock = -1;
  return true;
}

// A condition counts those who wait in the low half of its word, and in the high half those of them who may go on.
constexpr unsigned int kWaits = 1, kGoesOn = 0x10000;
unsigned int waiting(int cond) { return static_cast<unsigned int>(cond) & 0xFFFF; }
unsigned int going_on(int cond) { return static_cast<unsigned int>(cond) >> 16; }

/// Who comes after a signal lets those go first to whom it was given: it would take it from them.
bool begin_to_wait(int& cond) {
  if (going_on(cond) != 0) return false;
  cond = static_cast<int>(static_cast<unsigned int>(cond) + kWaits);
  return true;
}
bool go_on(int& cond) {
  if (going_on(cond) == 0) return false;
  cond = static_cast<int>(static_cast<unsigned int>(cond) - kWaits - kGoesOn);
  return true;
}
bool let_one_go_on(int& cond) {
  if (going_on(cond) == waiting(cond)) return false;
  cond = static_cast<int>(static_cast<unsigned int>(cond) + kGoesOn);
  return true;
}
bool let_all_go_on(int& cond) {
  cond = static_cast<int>(waiting(cond) * (kWaits + kGoesOn));
  return true;
}

// A completion is 0, or how many may pass it: one, or below 0 all.
bool pass(int& completion) {
  if (completion == 0) return false;
  if (completion > 0) completion = 0;
  return true;
}
bool let_one_pass(int& completion) {
  if (completion != 0) return false;
  completion = 1;
  return true;
}

}  // namespace

extern "C" {

int atomic_read(atomic_ea_t ea) {
  reserve(ea);
  return word_at(ea);
}
void atomic_set(atomic_ea_t ea, int value) {
  update(ea, [value](int& word) {
    word = value;
    return true;
  });
}
int atomic_add_return(int value, atomic_ea_t ea) { return add(value, ea); }
int atomic_sub_return(int value, atomic_ea_t ea) { return add(-value, ea); }
int atomic_inc_return(atomic_ea_t ea) { return add(1, ea); }
int atomic_dec_return(atomic_ea_t ea) { return add(-1, ea); }
void atomic_add(int value, atomic_ea_t ea) { add(value, ea); }
void atomic_sub(int value, atomic_ea_t ea) { add(-value, ea); }
void atomic_inc(atomic_ea_t ea) { add(1, ea); }
void atomic_dec(atomic_ea_t ea) { add(-1, ea); }
int atomic_sub_and_test(int value, atomic_ea_t ea) { return add(-value, ea) == value; }
int atomic_dec_and_test(atomic_ea_t ea) { return add(-1, ea) == 1; }
int atomic_dec_if_positive(atomic_ea_t ea) {
  return update(ea,
                [](int& word) {
                  if (word <= 0) return false;
                  --word;
                  return true;
                })
             .before -
         1;
}

void mutex_init(mutex_ea_t lock) { atomic_set(lock, 0); }
void mutex_lock(mutex_ea_t lock) { update_in_time(lock, take); }
int mutex_trylock(mutex_ea_t lock) { return update(lock, take).changed; }
/// A putllc of its own, not a put: whoever waits has the line reserved.
void mutex_unlock(mutex_ea_t lock) { atomic_set(lock, 0); }

void cond_init(cond_ea_t cond) { atomic_set(cond, 0); }
void cond_wait(cond_ea_t cond, mutex_ea_t mutex) {
  update_in_time(cond, begin_to_wait);
  mutex_unlock(mutex);
  update_in_time(cond, go_on);
  mutex_lock(mutex);
}
void cond_signal(cond_ea_t cond) { update(cond, let_one_go_on); }
void cond_broadcast(cond_ea_t cond) { update(cond, let_all_go_on); }

void init_completion(completion_ea_t completion) { atomic_set(completion, 0); }
void wait_for_completion(completion_ea_t completion) { update_in_time(completion, pass); }
void complete(completion_ea_t completion) { update(completion, let_one_pass); }
void complete_all(completion_ea_t completion) { atomic_set(completion, -1); }

void rwlock_init(eaddr_t lock) { atomic_set(lock, 0); }
void read_lock(eaddr_t lock) { update_in_time(lock, begin_to_read); }
int read_trylock(eaddr_t lock) { return update(lock, begin_to_read).changed; }
void read_unlock(eaddr_t lock) { add(-1, lock); }
void write_lock(eaddr_t lock) { update_in_time(lock, begin_to_write); }
int write_trylock(eaddr_t lock) { return update(lock, begin_to_write).changed; }
void write_unlock(eaddr_t lock) { atomic_set(lock, 0); }

}  // extern "C"
