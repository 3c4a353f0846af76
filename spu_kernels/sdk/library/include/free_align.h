#pragma once
#include <malloc_align.h>
