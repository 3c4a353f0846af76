/* Loads a plugin that needs libspe2, and unloads it, again and again: its first run breaks a rule. Argument: the plugin. */
#include <dlfcn.h>
#include <stdio.h>

int main(int argc, char** argv) {
  int (*run_rule)(long, void*);
  int i;
  for (i = 0; i < 20; ++i) {
    void* const plugin = dlopen(argc > 1 ? argv[1] : "", RTLD_NOW);
    if (plugin == NULL) return fprintf(stderr, "%s\n", dlerror()), 1;
    *(void**)&run_rule = dlsym(plugin, "run_rule");
    if (run_rule(i == 0 ? 2 : 0, NULL) != (i == 0 ? -1 : 0)) return 1;
    dlclose(plugin);
  }
  puts("ok");
  return 0;
}
