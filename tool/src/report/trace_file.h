#pragma once
// Reads a trace that ls_sim::Trace wrote. docs/guide/running-kernels.md describes the file.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softcell::tool {

/// Times are nanoseconds since the trace began.
struct TraceSlice {
  std::int64_t begin = 0, duration = 0;
  std::uint32_t name = 0;  ///< index into TraceFile::names: a kernel, a channel or a command
};

struct TraceJob : TraceSlice {
  std::uint64_t number = 0;
  bool failed = false;
};

struct TraceCommand : TraceSlice {
  std::uint32_t row = 0;  ///< commands in one row do not overlap
  std::uint32_t tag = 0, lsa = 0, size = 0, bytes = 0;
  std::uint64_t ea = 0;
  bool completed = true;
};

/// A mistake of an SPE; however often it happens, there is one finding.
struct TraceFinding {
  std::int64_t when = 0;  ///< when it first happened
  std::string rule, kernel, place, message;
  std::uint64_t count = 1;
};

/// The numbers of events beyond the trace's limit.
struct TraceDropped {
  std::uint64_t jobs = 0, waits = 0, commands = 0, findings = 0;
};

/// Events of one kind are in order of time; jobs, waits, and commands in one row do not overlap.
struct TraceSpe {
  std::vector<TraceJob> jobs;
  std::vector<TraceSlice> waits;
  std::vector<TraceCommand> commands;
  std::vector<TraceFinding> findings;
  TraceDropped dropped;
};

/// A part of a local store, by its kind ("text") or its name.
struct TraceRange {
  std::string name;
  std::uint32_t begin = 0, bytes = 0;
};

struct TraceImage {
  std::string name;
  bool checked = false;
  std::uint32_t budget = 0;
  std::optional<std::uint32_t> stack_used;
  std::vector<TraceRange> sections;  ///< in order of address, without overlaps
  std::vector<TraceRange> objects;
};

struct TraceFile {
  std::string version;        ///< of the softcell that wrote it
  bool is_simulated = false;  ///< whether its times are those of the SPEs' simulated clocks
  std::vector<std::string> names;
  std::vector<TraceSpe> spes;
  std::vector<TraceImage> images;
};

/// @throws std::runtime_error  one sentence that says what is wrong, where, and what is expected.
TraceFile parse_trace(std::string_view json);

/// @throws std::runtime_error  as for parse_trace(), or the file cannot be read; the message names it.
TraceFile read_trace(const std::filesystem::path& path);

}  // namespace softcell::tool
