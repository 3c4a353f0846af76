/* A library that runs an SPU program, which is loaded and unloaded by reloads_plugin. */
#include <libspe2.h>
#include <stddef.h>

extern spe_program_handle_t breaks_rules;

int run_rule(long rule, void* ea) {
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_context_ptr_t spe = spe_context_create(0, NULL);
  int result = -2;
  if (spe == NULL) return result;
  if (spe_program_load(spe, &breaks_rules) == 0) {
    result = spe_context_run(spe, &entry, 0, (void*)rule, ea, NULL);
  }
  spe_context_destroy(spe);
  return result;
}
