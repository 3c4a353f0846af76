#pragma once
// What scanf reads, for a program whose int and pointers have 32 bits.

#include <cstdio>
#include <string>

#include "call_memory.h"
#include "format.h"

namespace softcell::ls_sim::assisted {

/// Reads a stream by a format. `l`, `z` and `t` are 32 bits, `ll` and `j` 64; `%lf` and `%Lf` are doubles; `%p` is a
/// local-store address in hexadecimal digits. `%ls`, `%lc` and `%l[` store the characters of
/// UTF-8, a word each; their widths count bytes. Texts are cut at the size of a local store. [C17, 7.21.6.2]
/// @param arguments  the addresses of what is to be stored
/// @return  how many values were stored; EOF if the input ended before the first
int scan_stream(std::FILE* from, const std::string& format, FormatArguments& arguments, CallMemory& memory);

}  // namespace softcell::ls_sim::assisted
