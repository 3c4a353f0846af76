#pragma once
// The Chrome / Perfetto JSON format, as softcell writes it. docs/guide/running-kernels.md describes each field.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/base/json_text.h"
#include "softcell/base/whole_file.h"
#include "softcell/ls_sim/trace.h"
#include "trace_events.h"

namespace softcell::ls_sim {

class TraceWriter {
 public:
  /// @param begin  time 0 of the file.
  TraceWriter(base::WholeFile& file, TraceTime begin, TraceClock clock)
      : file_(file), begin_(begin), clock_(clock) {}

  /// The whole file; SPE n is the n-th of these.
  void write(const std::vector<const SpeEvents*>& spes);

 private:
  void write_spe(int spe, const SpeEvents& events);
  void write_rows(int spe, std::size_t command_rows);
  void write_jobs(int spe, const SpeEvents& events);
  void write_waits(int spe, const SpeEvents& events);
  void write_commands(int spe, const SpeEvents& events, const std::vector<std::uint32_t>& rows);
  void write_findings(int spe, const SpeEvents& events);
  void write_about(const std::vector<const SpeEvents*>& spes);
  void write_image(const TracedImage& image);

  /// Begins an event on its own line; the caller ends it with raw("}").
  base::JsonText& event(std::string_view phase, int spe, int row);
  /// And of one that lasts, up to where its arguments begin.
  base::JsonText& slice(int spe, int row, TraceTime begin, TraceTime end, std::string_view category,
                        std::string_view quoted_name);
  void name_row(int spe, int row, std::string_view name);
  void flush(std::size_t when_longer_than);

  base::WholeFile& file_;
  TraceTime begin_;
  TraceClock clock_;
  base::JsonText out_;
  bool first_ = true;
};

}  // namespace softcell::ls_sim
