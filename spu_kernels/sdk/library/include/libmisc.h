#pragma once
// What programs commonly use of the Cell SDK's library misc. [SDK for Multicore Acceleration, example library] documented

#include <malloc_align.h>
#include <stdlib.h>
