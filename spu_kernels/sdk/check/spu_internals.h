#pragma once
// The vector types and intrinsics, by the name of the header that compilers of the SPU bring.
#include "spu_intrinsics.h"
