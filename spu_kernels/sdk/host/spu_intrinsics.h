#pragma once
// The Cell language extensions for kernels compiled for the host. What each file holds is said at its top.

#include "softcell_control.h"
#include "softcell_estimates.h"
#include "softcell_float.h"
#include "softcell_integer.h"
#include "softcell_logic.h"
#include "softcell_quadword.h"
#include "softcell_vectors.h"
