#pragma once
// The page of softcell report, and what of a trace is in it.

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "softcell/base/embedded_file.h"
#include "trace_file.h"

namespace softcell::tool {

/// The trace as the page of `softcell report` reads it (tool/report_page/trace.js): events as columns of
/// whole numbers, times as the distance from the event before, so that a long trace stays small.
nlohmann::ordered_json report_data(const TraceFile& trace);

/// Of tool/report_page: the page, its style, and its scripts in the order in which they build on each other.
std::span<const base::EmbeddedFile> embedded_report();

/// One HTML page with everything in it: it opens offline and fetches nothing.
/// @param title  what the page is of, such as the trace's file name.
std::string report_page(const TraceFile& trace, std::string_view title);

}  // namespace softcell::tool
