#pragma once
// softcell report: makes a page from a trace.

#include <filesystem>
#include <memory>

#include "command_line/verb.h"

namespace softcell::tool {

struct ReportOptions {
  std::filesystem::path trace;
  std::filesystem::path out;
};

int run_report(const ReportOptions& options);

std::unique_ptr<Verb> report_verb();

}  // namespace softcell::tool
