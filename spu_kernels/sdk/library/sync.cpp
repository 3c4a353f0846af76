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

/// Makes `change` of the word; it returns false to leave it as it is. @return  the word before.
template <class Change>
int update(unsigned long long ea, Change change) {
  for (;;) {
    reserve(ea);
    const int before = word_at(ea);
    if (!change(word_at(ea))) return before;
    mfc_putllc(&line, ea & ~127ull, 0, 0);
    if ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) == 0) return before;
  }
}

int add(int value, unsigned long long ea) {
  return update(ea, [value](int& word) {
    word = static_cast<int>(static_cast<unsigned int>(word) + static_cast<unsigned int>(value));
    return true;
  });
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
                }) -
         1;
}

int mutex_trylock(mutex_ea_t lock) {
  return update(lock, [](int& word) {
           if (word != 0) return false;
           word = 1;
           return true;
         }) == 0;
}
void mutex_lock(mutex_ea_t lock) {
  while (!mutex_trylock(lock)) {
  }
}
void mutex_init(mutex_ea_t lock) { atomic_set(lock, 0); }
/// A putllc of its own, not a put: whoever waits has the line reserved.
void mutex_unlock(mutex_ea_t lock) { atomic_set(lock, 0); }

}  // extern "C"
