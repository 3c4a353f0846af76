#pragma once
#include <spu_mfcio.h>
