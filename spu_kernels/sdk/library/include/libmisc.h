#pragma once
// What programs commonly use of the Cell SDK's library misc. [SDK for Multicore Acceleration, example library] documented

#include <load_vec_unaligned.h>
#include <malloc_align.h>
#include <stdlib.h>
#include <store_vec_unaligned.h>
