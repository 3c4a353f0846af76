#pragma once

#include <string>
#include <string_view>

#include "trace_file.h"

namespace softcell::demos {

/// One HTML page with everything in it: it opens offline and fetches nothing.
/// @param title  what the page is of, such as the trace's file name.
std::string report_page(const TraceFile& trace, std::string_view title);

}  // namespace softcell::demos
