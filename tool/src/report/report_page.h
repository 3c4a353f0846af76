#pragma once

#include <span>
#include <string>
#include <string_view>

#include "softcell/base/embedded_file.h"
#include "trace_file.h"

namespace softcell::tool {

/// Of tool/report_page: the page, its style, and its scripts in the order in which they build on each other.
std::span<const base::EmbeddedFile> embedded_report();

/// One HTML page with everything in it: it opens offline and fetches nothing.
/// @param title  what the page is of, such as the trace's file name.
std::string report_page(const TraceFile& trace, std::string_view title);

}  // namespace softcell::tool
