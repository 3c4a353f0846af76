#pragma once
#include <simdmath.h>
