// libFuzzer target: any bytes give a trace that keeps its promises and makes a page, or a std::runtime_error.

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "report/report_page.h"
#include "report/trace_file.h"

namespace {

using namespace softcell::tool;

void require(bool condition) {
  if (!condition) std::abort();
}

template <typename Slices>
void check_names(const Slices& slices, const TraceFile& file) {
  for (const TraceSlice& slice : slices) {
    require(slice.name < file.names.size() && slice.begin >= 0 && slice.duration >= 0);
  }
}

void check(const TraceFile& file) {
  require(!file.spes.empty() && file.spes.size() <= 6);
  for (const TraceSpe& spe : file.spes) {
    check_names(spe.jobs, file);
    check_names(spe.waits, file);
    check_names(spe.commands, file);
    for (const TraceCommand& command : spe.commands) require(command.lsa < 0x40000 && command.tag < 32);
  }
  for (const TraceImage& image : file.images) {
    std::uint32_t end = 0;
    for (const TraceRange& section : image.sections) {
      require(section.begin >= end && section.begin + section.bytes <= 0x40000);
      end = section.begin + section.bytes;
    }
  }
}

/// Its data are one script element: nothing in them ends it.
void check_page(const std::string& page) {
  const std::size_t begin = page.find("id=\"trace\">") + 11, end = page.find("</script>", begin);
  require(end != std::string::npos && page.find('<', begin) == end);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const TraceFile file = parse_trace({reinterpret_cast<const char*>(data), size});
    check(file);
    check_page(report_page(file, "fuzz"));
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
