#include "report_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::tool {
namespace {

using Json = nlohmann::ordered_json;

/// A column with one number for each event.
template <typename Events, typename Number>
Json column(const Events& events, Number number) {
  Json values = Json::array();
  for (const auto& event : events) values.push_back(number(event));
  return values;
}

/// The columns that every slice has.
template <typename Events>
Json slices(const Events& events) {
  std::int64_t last = 0;
  return {
      {"begin", column(events, [&](const TraceSlice& e) { return e.begin - std::exchange(last, e.begin); })},
      {"duration", column(events, [](const TraceSlice& e) { return e.duration; })},
      {"name", column(events, [](const TraceSlice& e) { return e.name; })}};
}

Json jobs(const std::vector<TraceJob>& events) {
  Json result = slices(events);
  result["number"] = column(events, [](const TraceJob& e) { return e.number; });
  result["failed"] = column(events, [](const TraceJob& e) { return int{e.failed}; });
  return result;
}

Json commands(const std::vector<TraceCommand>& events) {
  Json result = slices(events);
  result["row"] = column(events, [](const TraceCommand& e) { return e.row; });
  result["tag"] = column(events, [](const TraceCommand& e) { return e.tag; });
  result["lsa"] = column(events, [](const TraceCommand& e) { return e.lsa; });
  // In two halves, because JavaScript's numbers hold only 53 bits.
  result["eaHigh"] = column(events, [](const TraceCommand& e) { return e.ea >> 32; });
  result["eaLow"] = column(events, [](const TraceCommand& e) { return e.ea & 0xFFFFFFFFu; });
  result["size"] = column(events, [](const TraceCommand& e) { return e.size; });
  result["bytes"] = column(events, [](const TraceCommand& e) { return e.bytes; });
  result["completed"] = column(events, [](const TraceCommand& e) { return int{e.completed}; });
  return result;
}

Json findings(const std::vector<TraceFinding>& events) {
  return column(events, [](const TraceFinding& e) {
    return Json{{"when", e.when},   {"rule", e.rule},       {"kernel", e.kernel},
                {"place", e.place}, {"message", e.message}, {"count", e.count}};
  });
}

Json ranges(const std::vector<TraceRange>& all) {
  return column(all, [](const TraceRange& r) {
    return Json{{"name", r.name}, {"begin", r.begin}, {"bytes", r.bytes}};
  });
}

Json image(const TraceImage& i) {
  return {{"name", i.name},
          {"checked", i.checked},
          {"budget", i.budget},
          {"stackUsed", i.stack_used ? Json(*i.stack_used) : Json()},
          {"sections", ranges(i.sections)},
          {"objects", ranges(i.objects)}};
}

}  // namespace

nlohmann::ordered_json report_data(const TraceFile& trace) {
  Json spes = Json::array();
  for (const TraceSpe& spe : trace.spes) {
    SC_ASSERT(
        std::ranges::all_of(spe.jobs, [&](const TraceJob& job) { return job.name < trace.names.size(); }),
        "a job's name is none of {}", trace.names.size());
    SC_ASSERT(std::ranges::all_of(spe.commands,
                                  [&](const TraceCommand& c) {
                                    return c.name < trace.names.size() && c.tag < dma::kTagCount;
                                  }),
              "a command's name is none of {}, or its tag none", trace.names.size());
    spes.push_back(Json{{"jobs", jobs(spe.jobs)},
                        {"waits", slices(spe.waits)},
                        {"commands", commands(spe.commands)},
                        {"findings", findings(spe.findings)},
                        {"dropped",
                         {{"jobs", spe.dropped.jobs},
                          {"waits", spe.dropped.waits},
                          {"commands", spe.dropped.commands},
                          {"findings", spe.dropped.findings}}}});
  }
  return {{"version", trace.version},
          {"simulated", trace.is_simulated},
          {"names", trace.names},
          {"spes", std::move(spes)},
          {"images", column(trace.images, image)}};
}

}  // namespace softcell::tool
