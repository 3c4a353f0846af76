#pragma once
// Makes the page of softcell report, and the data of a trace that are in it.

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "softcell/base/embedded_file.h"
#include "trace_file.h"

namespace softcell::tool {

/// The trace in the form that the page of `softcell report` reads (tool/report_page/trace.js): events as columns of whole numbers, times as
/// the distance from the previous event, so that a long trace stays small.
nlohmann::ordered_json report_data(const TraceFile& trace);

/// The files of tool/report_page: the page, its style, and its scripts in the order in which they depend on each other.
std::span<const base::EmbeddedFile> embedded_report();

/// One HTML page with everything in it: it opens offline and fetches nothing.
/// @param title  what the page shows, such as the trace's file name.
std::string report_page(const TraceFile& trace, std::string_view title);

}  // namespace softcell::tool
