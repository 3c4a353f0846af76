#include "shared.h"
int more(void) { return calls + 21; }
