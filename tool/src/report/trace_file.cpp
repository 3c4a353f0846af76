#include "trace_file.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "json_fields.h"
#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/list_element.h"
#include "softcell/dma/mfc_command.h"
#include "verb/verb_files.h"

namespace softcell::tool {
namespace {

using nlohmann::json;

constexpr std::uint64_t kFormat = 1;
constexpr std::uint64_t kMostRows = 999;  // the largest row number in the format
constexpr std::uint64_t kFirstCommandRow = 3;
constexpr std::uint64_t kMostCommandBytes =
    std::uint64_t{dma::kMaxTransferBytes} / dma::kListElementBytes * dma::kMaxTransferBytes;
constexpr std::uint64_t kMostCount = std::uint64_t{1} << 53;  // the page can hold it exactly
constexpr std::size_t kMostSpes = 256;                        // the contexts of a libspe2 program
constexpr std::size_t kMostFileBytes = std::size_t{4} << 30;

/// Reads the events one by one, so that a long trace is never in memory as a tree of values.
class EventReader {
 public:
  explicit EventReader(TraceFile& file) : file_(file) { file_.spes.resize(kMostSpes); }

  void read(const json& value) {
    const JsonFields event(value, "traceEvents[" + std::to_string(count_++) + "]");
    const std::string phase = event.text("ph");
    if (phase == "M") return;  // names of processes and rows are not needed: their numbers are enough
    const std::uint64_t process = event.integer("pid", 1, kMostSpes);
    highest_ = std::max(highest_, process);
    SC_ASSERT(process >= 1 && process <= file_.spes.size(), "process {} of {}", process, file_.spes.size());
    TraceSpe& spe = file_.spes[process - 1];
    const std::uint64_t row = event.integer("tid", process * 1000 + 1, process * 1000 + kMostRows) % 1000;
    const std::string category = event.text("cat");
    if (phase == "i" && category == "finding") {
      spe.findings.push_back(read_finding(event));
    } else if (phase == "X" && category == "job") {
      spe.jobs.push_back(read_job(event, process, row));
    } else if (phase == "X" && category == "wait") {
      spe.waits.push_back(read_slice(event, process, row));
    } else if (phase == "X" && category == "dma") {
      spe.commands.push_back(read_command(event, process, row));
    } else {
      event.refuse("its phase \"" + phase + "\" and category \"" + category +
                   "\" are none that softcell writes: \"X\" with job, wait or dma, \"i\" with finding");
    }
  }

  /// The highest SPE with an event, counted from 1; 0 if there is none.
  std::uint64_t highest_spe() const { return highest_; }

 private:
  /// Reads the fields that jobs, waits and commands share. In each row they must be in order of time without overlaps, because the page
  /// finds them by binary search.
  TraceSlice read_slice(const JsonFields& event, std::uint64_t process, std::uint64_t row) {
    const TraceSlice slice{event.time("ts"), event.time("dur"), intern(event.text("name"))};
    SC_ASSERT(process >= 1 && row < 1000, "row {} of process {}", row, process);
    std::int64_t& row_end = row_ends_[process * 1000 + row];
    if (slice.begin < row_end) event.refuse("it begins before the event before it in its row has ended");
    row_end = slice.begin + slice.duration;
    return slice;
  }

  TraceJob read_job(const JsonFields& event, std::uint64_t process, std::uint64_t row) {
    const JsonFields arguments = event.object("args");
    return {read_slice(event, process, row), arguments.integer("job", 0, kMostCount),
            arguments.boolean("failed")};
  }

  TraceCommand read_command(const JsonFields& event, std::uint64_t process, std::uint64_t row) {
    if (row < kFirstCommandRow) event.refuse("a command lies in the row of jobs or of waits");
    const JsonFields arguments = event.object("args");
    const auto number = [&](const char* key, std::uint64_t most) {
      return static_cast<std::uint32_t>(arguments.integer(key, 0, most));
    };
    TraceCommand command;
    static_cast<TraceSlice&>(command) = read_slice(event, process, row);
    command.row = static_cast<std::uint32_t>(row - kFirstCommandRow);
    command.tag = number("tag", dma::kTagCount - 1);
    command.size = number("size", kMostCommandBytes);
    command.bytes = number("bytes", kMostCommandBytes);
    command.lsa = static_cast<std::uint32_t>(arguments.hex("lsa", dma::kLocalStoreMask));
    command.ea = arguments.hex("ea", ~std::uint64_t{0});
    command.completed = arguments.boolean("completed");
    return command;
  }

  static TraceFinding read_finding(const JsonFields& event) {
    const JsonFields arguments = event.object("args");
    return {
        event.time("ts"),
        event.text("name"),
        arguments.text("kernel"),
        arguments.text("place"),
        arguments.text("message"),
        arguments.has("count") ? arguments.integer("count", 1, kMostCount) : 1};  // before 0.2: each is one
  }

  std::uint32_t intern(const std::string& name) {
    const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(file_.names.size()));
    if (is_new) file_.names.push_back(name);
    return entry->second;
  }

  TraceFile& file_;
  std::size_t count_ = 0;
  std::uint64_t highest_ = 0;
  std::map<std::string, std::uint32_t> numbers_;
  std::map<std::uint64_t, std::int64_t> row_ends_;
};

std::string item(const char* array, std::size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

TraceRange read_range(const JsonFields& fields, const char* name_key) {
  TraceRange range{fields.text(name_key)};
  range.begin = static_cast<std::uint32_t>(fields.integer("begin", 0, dma::kLocalStoreMask));
  range.bytes = static_cast<std::uint32_t>(fields.integer("bytes", 0, dma::kLocalStoreBytes - range.begin));
  return range;
}

TraceImage read_image(const json& value, const std::string& where) {
  const JsonFields fields(value, where);
  TraceImage image{fields.text("name"), fields.boolean("checked"), 0, {}, {}, {}};
  image.budget = static_cast<std::uint32_t>(fields.integer("budget", 0, dma::kLocalStoreBytes));
  if (!fields.is_null("stack_used")) {
    image.stack_used = static_cast<std::uint32_t>(fields.integer("stack_used", 0, dma::kLocalStoreBytes));
  }
  std::uint32_t end = 0;
  for (const json& section : fields.array("sections")) {
    const JsonFields section_fields(section, where + "." + item("sections", image.sections.size()));
    image.sections.push_back(read_range(section_fields, "kind"));
    if (image.sections.back().begin < end) section_fields.refuse("it overlaps the section before it");
    end = image.sections.back().begin + image.sections.back().bytes;
  }
  for (const json& object : fields.array("objects")) {
    image.objects.push_back(
        read_range({object, where + "." + item("objects", image.objects.size())}, "name"));
  }
  return image;
}

/// Reads what the file states about the trace, after its events.
void read_about(const JsonFields& about, std::uint64_t highest_spe, TraceFile& file) {
  if (about.integer("format", 0, kMostCount) != kFormat) {
    about.refuse("\"format\" is of another version of softcell; " + std::to_string(kFormat) + " is expected");
  }
  SC_ASSERT(highest_spe <= kMostSpes, "an event of SPE {} of {}", highest_spe, kMostSpes);
  file.version = about.text("version");
  file.is_simulated = about.has("time") && about.text("time").find("simulated") != std::string::npos;
  const std::uint64_t spes = about.integer("spes", std::max<std::uint64_t>(highest_spe, 1), kMostSpes);
  file.spes.resize(spes);

  const json& dropped = about.array("dropped");
  if (dropped.size() != spes) about.refuse("\"dropped\" must have one entry for each of its SPEs");
  for (std::size_t i = 0; i < spes; ++i) {
    const JsonFields fields(dropped[i], "softcell." + item("dropped", i));
    const auto count = [&](const char* key) { return fields.integer(key, 0, kMostCount); };
    file.spes[i].dropped = {count("jobs"), count("waits"), count("commands"), count("findings")};
  }
  for (const json& image : about.array("images")) {
    file.images.push_back(read_image(image, "softcell." + item("images", file.images.size())));
  }
}

}  // namespace

TraceFile parse_trace(std::string_view text) {
  TraceFile file;
  EventReader events(file);
  bool in_events = false;
  const auto take_events = [&](int depth, json::parse_event_t event, json& value) {
    if (depth == 1 && event == json::parse_event_t::key) in_events = value == "traceEvents";
    const bool ends = event == json::parse_event_t::value || event == json::parse_event_t::object_end ||
                      event == json::parse_event_t::array_end;
    if (!in_events || depth != 2 || !ends) return true;
    events.read(value);
    return false;  // the value is no longer needed
  };
  json root;
  try {
    root = json::parse(text.begin(), text.end(), take_events);
  } catch (const json::exception& error) {
    throw std::runtime_error("it is not JSON: " + explanation_of(error));
  }
  SC_ASSERT(file.spes.size() >= dma::kSpeCount, "events of {} SPEs", file.spes.size());
  const JsonFields fields(root, "the file");
  fields.array("traceEvents");
  if (!root.contains("softcell")) fields.refuse("\"softcell\" is missing; --trace of softcell writes it");
  read_about({root["softcell"], "softcell"}, events.highest_spe(), file);
  return file;
}

TraceFile read_trace(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = base::read_file(path, kMostFileBytes);
  try {
    return parse_trace({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("trace " + path.string() + ": " + error.what());
  }
}

}  // namespace softcell::tool
