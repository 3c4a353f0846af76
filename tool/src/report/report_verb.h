#pragma once
// softcell report: a trace as a page to look at.

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
