#include "trace_writer.h"

#include <algorithm>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/ls_sim/channel_name.h"

namespace softcell::ls_sim {
namespace {

constexpr std::size_t kFlushBytes = 1 << 20;
constexpr int kJobRow = 1, kWaitRow = 2, kFirstCommandRow = 3, kRowsOfProcess = 1000;

// Viewers take process 0 for the idle one, and some tell rows apart by their number alone.
int process(int spe) { return spe + 1; }
int thread(int spe, int row) { return process(spe) * kRowsOfProcess + row; }

std::string json_string(std::string_view text) { return base::JsonText().string(text).text(); }

/// For each command the row that is free when it is issued: the first of them, so that commands that follow
/// one another share a row and only those in flight at the same time lie side by side.
std::vector<std::uint32_t> command_rows(const EventLog<TracedCommand>& commands) {
  std::vector<std::uint32_t> rows(commands.size());
  std::vector<TraceTime> free_from;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const TracedCommand& command = commands[i];
    const auto row = std::find_if(free_from.begin(), free_from.end(),
                                  [&](TraceTime free) { return free <= command.issue; });
    rows[i] = static_cast<std::uint32_t>(row - free_from.begin());
    if (row == free_from.end()) {
      free_from.push_back(command.complete);
    } else {
      *row = command.complete;
    }
  }
  return rows;
}

std::string command_name(std::uint16_t opcode) {
  const std::string_view known = dma::name(static_cast<dma::MfcOpcode>(opcode));
  return known.empty() ? "command " + std::to_string(opcode) : std::string(known);
}

std::string wait_name(std::uint32_t channel) {
  const std::string_view known = channel_name(channel);
  return known.empty() ? "channel " + std::to_string(channel) : std::string(known);
}

/// Every image that some SPE ran, in order of name; the stack is the most that any of them used.
std::vector<TracedImage> all_images(const std::vector<const SpeEvents*>& spes) {
  std::vector<TracedImage> all;
  for (const SpeEvents* spe : spes) {
    for (const TracedImage& image : spe->images) {
      const auto known =
          std::find_if(all.begin(), all.end(), [&](const TracedImage& i) { return i.is(image); });
      if (known == all.end()) {
        all.push_back(image);
      } else if (image.stack_used) {
        known->stack_used = std::max(known->stack_used.value_or(0), *image.stack_used);
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const TracedImage& a, const TracedImage& b) { return a.name < b.name; });
  return all;
}

}  // namespace

void TraceWriter::write(const std::vector<const SpeEvents*>& spes) {
  out_.raw("{\"traceEvents\":[");
  for (std::size_t i = 0; i < spes.size(); ++i) write_spe(static_cast<int>(i), *spes[i]);
  // Behind the events: a viewer may stop at a key that it does not know.
  out_.raw("\n],\n\"softcell\":");
  write_about(spes);
  out_.raw("}\n");
  flush(0);
}

void TraceWriter::write_spe(int spe, const SpeEvents& events) {
  const std::vector<std::uint32_t> rows = command_rows(events.commands);
  const auto highest = std::max_element(rows.begin(), rows.end());
  SC_ASSERT(rows.size() == events.commands.size(), "{} commands of SPE {} have {} rows",
            events.commands.size(), spe, rows.size());
  write_rows(spe, highest == rows.end() ? 0 : *highest + std::size_t{1});
  write_jobs(spe, events);
  write_waits(spe, events);
  write_commands(spe, events, rows);
  write_findings(spe, events);
}

void TraceWriter::write_rows(int spe, std::size_t command_rows) {
  event("M", spe, kJobRow)
      .raw(",\"name\":\"process_name\",\"args\":{\"name\":\"SPE ")
      .number(spe)
      .raw("\"}}");
  event("M", spe, kJobRow)
      .raw(",\"name\":\"process_sort_index\",\"args\":{\"sort_index\":")
      .number(spe)
      .raw("}}");
  name_row(spe, kJobRow, "jobs");
  name_row(spe, kWaitRow, "waits");
  for (std::size_t i = 0; i < command_rows; ++i) {
    name_row(spe, kFirstCommandRow + static_cast<int>(i), "DMA " + std::to_string(i + 1));
  }
}

void TraceWriter::name_row(int spe, int row, std::string_view name) {
  event("M", spe, row).raw(",\"name\":\"thread_name\",\"args\":{\"name\":").string(name).raw("}}");
  event("M", spe, row).raw(",\"name\":\"thread_sort_index\",\"args\":{\"sort_index\":").number(row).raw("}}");
}

void TraceWriter::write_jobs(int spe, const SpeEvents& events) {
  std::vector<std::string> names;
  for (const TracedImage& image : events.images) names.push_back(json_string(image.name));
  for (std::size_t i = 0; i < events.jobs.size(); ++i) {
    const TracedJob& job = events.jobs[i];
    SC_ASSERT(job.image < names.size(), "job {} has image {} of {}", job.number, job.image, names.size());
    slice(spe, kJobRow, job.begin, job.end, "job", names[job.image])
        .raw("\"job\":")
        .number(static_cast<std::int64_t>(job.number))
        .raw(",\"failed\":")
        .boolean(job.failed)
        .raw("}}");
  }
}

void TraceWriter::write_waits(int spe, const SpeEvents& events) {
  for (std::size_t i = 0; i < events.waits.size(); ++i) {
    const TracedWait& wait = events.waits[i];
    slice(spe, kWaitRow, wait.begin, wait.end, "wait", json_string(wait_name(wait.channel)))
        .raw("\"channel\":")
        .number(wait.channel)
        .raw("}}");
  }
}

void TraceWriter::write_commands(int spe, const SpeEvents& events, const std::vector<std::uint32_t>& rows) {
  for (std::size_t i = 0; i < events.commands.size(); ++i) {
    const TracedCommand& command = events.commands[i];
    slice(spe, kFirstCommandRow + static_cast<int>(rows[i]), command.issue, command.complete, "dma",
          json_string(command_name(command.opcode)))
        .raw("\"tag\":")
        .number(command.tag)
        .raw(",\"lsa\":")
        .hex(command.lsa, 5)
        .raw(",\"ea\":")
        .hex(command.ea, 12)
        .raw(",\"size\":")
        .number(command.size)
        .raw(",\"bytes\":")
        .number(command.bytes)
        .raw(",\"completed\":")
        .boolean(command.completed)
        .raw("}}");
  }
}

void TraceWriter::write_findings(int spe, const SpeEvents& events) {
  for (const TracedFinding& finding : events.findings) {
    event("i", spe, kJobRow)
        .raw(",\"s\":\"p\",\"ts\":")
        .microseconds(finding.when - begin_)
        .raw(",\"cat\":\"finding\",\"name\":")
        .string(dma::name(finding.first.rule))
        .raw(",\"args\":{\"kernel\":")
        .string(finding.first.kernel)
        .raw(",\"place\":")
        .string(finding.first.place)
        .raw(",\"message\":")
        .string(finding.first.message())
        .raw(",\"count\":")
        .number(static_cast<std::int64_t>(finding.count))
        .raw("}}");
  }
}

void TraceWriter::write_about(const std::vector<const SpeEvents*>& spes) {
  out_.raw("{\"format\":1,\"version\":\"" SOFTCELL_VERSION "\",\"time\":\"")
      .raw(clock_ == TraceClock::kHost ? "microseconds of the host's steady clock since the trace began"
                                       : "microseconds of the simulated clocks of the SPEs")
      .raw("\",\"spes\":")
      .number(static_cast<std::int64_t>(spes.size()))
      .raw(",\n\"dropped\":[");
  for (std::size_t i = 0; i < spes.size(); ++i) {
    const auto count = [&](std::string_view key, std::size_t value) {
      out_.raw(key).number(static_cast<std::int64_t>(value));
    };
    if (i != 0) out_.raw(",");
    count("{\"jobs\":", spes[i]->jobs.dropped());
    count(",\"waits\":", spes[i]->waits.dropped());
    count(",\"commands\":", spes[i]->commands.dropped());
    count(",\"findings\":", spes[i]->dropped_findings);
    out_.raw("}");
  }
  out_.raw("],\n\"images\":[");
  bool first = true;
  for (const TracedImage& image : all_images(spes)) {
    out_.raw(first ? "\n" : ",\n");
    write_image(image);
    first = false;
  }
  out_.raw("]}");
}

void TraceWriter::write_image(const TracedImage& image) {
  const auto range = [&](std::string_view key, std::string_view name, std::uint32_t begin,
                         std::uint32_t bytes) {
    out_.raw(key).string(name).raw(",\"begin\":").number(begin).raw(",\"bytes\":").number(bytes).raw("}");
  };
  out_.raw("{\"name\":").string(image.name).raw(",\"checked\":").boolean(image.checked);
  out_.raw(",\"budget\":").number(image.budget).raw(",\"stack_used\":");
  if (image.stack_used) {
    out_.number(*image.stack_used);
  } else {
    out_.raw("null");
  }
  out_.raw(",\n \"sections\":[");
  bool first = true;
  for (const LocalStoreSection& section : image.sections) {
    range(first ? "{\"kind\":" : ",{\"kind\":", section.kind, section.begin, section.bytes);
    first = false;
  }
  out_.raw("],\n \"objects\":[");
  first = true;
  for (const ImageObject& object : image.objects) {
    range(first ? "{\"name\":" : ",{\"name\":", object.name, object.begin.value, object.bytes);
    first = false;
  }
  out_.raw("]}");
}

base::JsonText& TraceWriter::event(std::string_view phase, int spe, int row) {
  SC_ASSERT(spe >= 0 && row >= kJobRow && row < kRowsOfProcess, "an event of SPE {} in row {}", spe, row);
  flush(kFlushBytes);
  out_.raw(first_ ? "\n{\"ph\":\"" : ",\n{\"ph\":\"").raw(phase);
  first_ = false;
  return out_.raw("\",\"pid\":").number(process(spe)).raw(",\"tid\":").number(thread(spe, row));
}

base::JsonText& TraceWriter::slice(int spe, int row, TraceTime begin, TraceTime end,
                                   std::string_view category, std::string_view quoted_name) {
  SC_ASSERT(begin <= end, "{} of SPE {} begins at {} and ends at {}", quoted_name, spe, begin, end);
  // An event that began before the trace is shown from the trace's beginning.
  const TraceTime from = std::max<TraceTime>(begin - begin_, 0), to = std::max(end - begin_, from);
  return event("X", spe, row)
      .raw(",\"ts\":")
      .microseconds(from)
      .raw(",\"dur\":")
      .microseconds(to - from)
      .raw(",\"cat\":\"")
      .raw(category)
      .raw("\",\"name\":")
      .raw(quoted_name)
      .raw(",\"args\":{");
}

void TraceWriter::flush(std::size_t when_longer_than) {
  if (out_.text().size() <= when_longer_than) return;
  file_.write(out_.text());
  out_.clear();
}

}  // namespace softcell::ls_sim
