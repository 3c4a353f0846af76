// The handler of a callback throws through the run of a context that has read before its transfer was there. Ends by _exit(), so that the
// report is the one that was written when the run ended.
#include <libspe2.h>
#include <unistd.h>

#include <cstdio>

extern "C" spe_program_handle_t breaks_rules;

namespace {

struct Thrown {};

int throws(void*, unsigned int) { throw Thrown(); }

alignas(128) unsigned int words[64];

}  // namespace

int main() {
  spe_context_ptr_t spe = spe_context_create(0, nullptr);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  if (spe_callback_handler_register(reinterpret_cast<void*>(&throws), 0x10, SPE_CALLBACK_NEW) != 0 ||
      spe_program_load(spe, &breaks_rules) != 0)
    return 1;
  try {
    spe_context_run(spe, &entry, 0, reinterpret_cast<void*>(11), words, nullptr);
  } catch (const Thrown&) {
    std::puts("ok");
    std::fflush(stdout);
    _exit(0);
  }
  return 1;
}
