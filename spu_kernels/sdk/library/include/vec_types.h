#pragma once
// The vector types by the names of VMX. [LEXT, data types] documented

#include <spu_intrinsics.h>
