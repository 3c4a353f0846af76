#pragma once
// PSL1GHT's printf of SPU threads: here it is printf. [PSL1GHT, sys/spu_printf.h] documented

#include <stdio.h>

#define spu_printf(...) printf(__VA_ARGS__)
