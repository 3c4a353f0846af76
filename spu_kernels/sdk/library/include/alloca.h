#pragma once
// Memory of the stack, until the function returns. It counts in the declared stack.

#define alloca(bytes) __builtin_alloca(bytes)
