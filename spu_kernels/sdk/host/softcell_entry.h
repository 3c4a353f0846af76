#pragma once
// Included before every kernel source on the host. A freestanding compiler may mangle main's name; the
// image's entry is the plain one.

#include <stdint.h>

extern "C" int main(uint64_t spe_id, uint64_t argp, uint64_t envp);
