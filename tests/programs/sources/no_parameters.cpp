// A kernel, no program, whose main has no parameters.
#include <spu_intrinsics.h>

int main() { return static_cast<int>(spu_extract(spu_splats(0u), 0)); }
