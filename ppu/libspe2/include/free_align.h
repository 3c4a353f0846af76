#include <malloc_align.h>
