#pragma once

#include <nlohmann/json_fwd.hpp>

#include "trace_file.h"

namespace softcell::tool {

/// The trace as the page of `softcell report` reads it (tool/report_page/trace.js): events as columns of whole
/// numbers, times as the distance from the event before, so that a long trace stays small.
nlohmann::ordered_json report_data(const TraceFile& trace);

}  // namespace softcell::tool
