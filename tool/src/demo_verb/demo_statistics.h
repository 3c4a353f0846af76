#pragma once
// What a demo says of its run, for other programs and for the reader.

#include <nlohmann/json_fwd.hpp>

#include "demo/run_record.h"
#include "demo_options.h"

namespace softcell::tool {

/// What --json writes; docs/guide/soft-bodies.md lists it. @param demo  stopped
nlohmann::ordered_json statistics_document(const DemoOptions& options, const demos::Demo& demo,
                                           const demos::RunRecord& record);

/// Prints the same in a few lines. @param statistics  of statistics_document()
void print_summary(const nlohmann::ordered_json& statistics, const DemoOptions& options);

}  // namespace softcell::tool
