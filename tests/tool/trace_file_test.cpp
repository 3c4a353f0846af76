// A trace read back: what ls_sim::Trace writes, and what is refused.

#include "report/trace_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "report/report_page.h"
#include "softcell/ls_sim/trace.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"

namespace softcell::tool {
namespace {

using nlohmann::json;
using tests::ScratchFolder;

ls_sim::KernelImage image() {
  ls_sim::KernelImage image;
  image.name = "saxpy";
  image.text_begin = 0x80, image.text_end = 0x480;
  image.sizes = {.text = 0x400, .bss = 0x8000, .stack = 2048, .budget = 65536, .end = 0x8480};
  image.objects = {{"buffers", {0x480}, 0x8000}};
  return image;
}

dma::MfcCommand command(dma::MfcOpcode opcode, std::uint32_t size, std::uint32_t tag) {
  return {.word = static_cast<std::uint32_t>(opcode),
          .lsa = {0x480},
          .ea = dma::kMainMemoryBase,
          .size = size,
          .tag = tag};
}

/// A trace of two SPEs with some of everything.
std::string written() {
  ls_sim::Trace trace(2);
  const ls_sim::TraceTime now = ls_sim::trace_now();
  ls_sim::SpeTrace& spe = trace.spe(1);
  spe.on_issue(1, command(dma::MfcOpcode::get, 16384, 31), 16384);
  spe.on_issue(2, command(dma::MfcOpcode::putlf, 2048, 2), 1'000'000);
  spe.on_complete(1);
  spe.on_wait(24, now + 1000, now + 4000);
  spe.on_job(image(), 7, now, now + 500'000'000, true);
  spe.on_stack_used(image(), 700);
  spe.on_finding({.rule = dma::kAllRules[0], .spe = 1, .kernel = "saxpy", .place = "saxpy.cpp:4"}, now + 5);
  spe.on_finding({.rule = dma::kAllRules[0], .spe = 1, .kernel = "saxpy", .place = "saxpy.cpp:4"}, now + 6);
  trace.spe(0).on_job(image(), 8, now, now + 1, false);
  const ScratchFolder folder;
  trace.write(folder / "trace.json");
  return test::text_of(folder / "trace.json");
}

TEST(TraceFile, ReadsWhatTraceWrites) {
  const TraceFile file = parse_trace(written());
  ASSERT_EQ(file.spes.size(), 2u);
  const TraceSpe& spe = file.spes[1];
  ASSERT_EQ(spe.jobs.size(), 1u);
  EXPECT_EQ(file.names[spe.jobs[0].name], "saxpy");
  EXPECT_EQ(spe.jobs[0].number, 7u);
  EXPECT_EQ(spe.jobs[0].duration, 500'000'000);
  EXPECT_TRUE(spe.jobs[0].failed);
  EXPECT_FALSE(file.spes[0].jobs[0].failed);

  ASSERT_EQ(spe.waits.size(), 1u);
  EXPECT_EQ(file.names[spe.waits[0].name], "MFC_RdTagStat");
  EXPECT_EQ(spe.waits[0].duration, 3000);

  ASSERT_EQ(spe.commands.size(), 2u);
  EXPECT_EQ(file.names[spe.commands[1].name], "putlf");
  EXPECT_EQ(spe.commands[0].row, 0u);
  EXPECT_EQ(spe.commands[1].row, 1u);
  EXPECT_EQ(spe.commands[0].tag, 31u);
  EXPECT_EQ(spe.commands[0].lsa, 0x480u);
  EXPECT_EQ(spe.commands[0].ea, dma::kMainMemoryBase.value);
  EXPECT_TRUE(spe.commands[0].completed);
  EXPECT_FALSE(spe.commands[1].completed);
  EXPECT_EQ(spe.commands[1].size, 2048u);
  EXPECT_EQ(spe.commands[1].bytes, 1'000'000u);

  ASSERT_EQ(spe.findings.size(), 1u);
  EXPECT_EQ(spe.findings[0].place, "saxpy.cpp:4");
  EXPECT_EQ(spe.findings[0].count, 2u);

  ASSERT_EQ(file.images.size(), 1u);
  EXPECT_EQ(file.images[0].stack_used, 700u);
  EXPECT_EQ(file.images[0].sections.back().name, "stack");
  EXPECT_EQ(file.images[0].objects[0].begin, 0x480u);
}

struct Damage {
  const char* what;
  std::function<void(json&)> apply;
  const char* part;  ///< of the sentence
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.what; }

/// The first event of a category.
json& event(json& file, const std::string& category) {
  for (json& candidate : file["traceEvents"]) {
    if (candidate.value("cat", "") == category) return candidate;
  }
  throw std::logic_error("no event of " + category);
}

class TraceFileRefuses : public testing::TestWithParam<Damage> {};

TEST_P(TraceFileRefuses, WithOneSentenceThatSaysWhere) {
  json file = json::parse(written());
  GetParam().apply(file);
  try {
    parse_trace(file.dump());
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().part), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Damaged, TraceFileRefuses,
    testing::Values(
        Damage{"a number", [](json& f) { f = 3; }, "the file: it is 3; an object is expected"},
        Damage{"no events", [](json& f) { f.erase("traceEvents"); }, "\"traceEvents\" is missing"},
        Damage{"events no array", [](json& f) { f["traceEvents"] = "none"; },
               "\"traceEvents\" is \"none\"; an array is expected"},
        Damage{"of another program", [](json& f) { f.erase("softcell"); }, "\"softcell\" is missing"},
        Damage{"of another version", [](json& f) { f["softcell"]["format"] = 2; }, "another version"},
        Damage{"event no object", [](json& f) { f["traceEvents"][1] = json::array({1}); },
               "traceEvents[1]: it is an array"},
        Damage{"event a number", [](json& f) { f["traceEvents"][2] = 5; }, "traceEvents[2]: it is 5"},
        Damage{"unknown category", [](json& f) { event(f, "job")["cat"] = "gpu"; }, "category \"gpu\""},
        Damage{"unknown phase", [](json& f) { event(f, "job")["ph"] = "B"; }, "phase \"B\""},
        Damage{"no time", [](json& f) { event(f, "wait").erase("ts"); }, "\"ts\" is missing"},
        Damage{"time as text", [](json& f) { event(f, "wait")["ts"] = "now"; },
               "\"ts\" is \"now\"; a time in microseconds"},
        Damage{"negative duration", [](json& f) { event(f, "job")["dur"] = -1; }, "\"dur\" is -1"},
        Damage{"absurd time", [](json& f) { event(f, "job")["ts"] = 1e300; }, "a time in microseconds"},
        Damage{"SPE beyond all contexts", [](json& f) { event(f, "job")["pid"] = 257; },
               "\"pid\" is 257; a whole number from 1 to 256"},
        Damage{"row of another SPE", [](json& f) { event(f, "job")["tid"] = 5001; }, "\"tid\" is 5001"},
        Damage{"more SPEs than it says", [](json& f) { f["softcell"]["spes"] = 1; }, "\"spes\" is 1"},
        Damage{"fractional job", [](json& f) { event(f, "job")["args"]["job"] = 1.5; }, "\"job\" is 1.5"},
        Damage{"no arguments", [](json& f) { event(f, "dma").erase("args"); }, "\"args\" is missing"},
        Damage{"arguments no object", [](json& f) { event(f, "dma")["args"] = 1; }, ".args: it is 1"},
        Damage{"tag 32", [](json& f) { event(f, "dma")["args"]["tag"] = 32; }, "\"tag\" is 32"},
        Damage{"absurd size", [](json& f) { event(f, "dma")["args"]["bytes"] = 1ull << 40; }, "33554432"},
        Damage{"address past the store", [](json& f) { event(f, "dma")["args"]["lsa"] = "0x40000"; },
               "at most 0x3ffff"},
        Damage{"address as number", [](json& f) { event(f, "dma")["args"]["lsa"] = 12; }, "\"lsa\" is 12"},
        Damage{"address not hex", [](json& f) { event(f, "dma")["args"]["ea"] = "0xZZ"; }, "\"0xZZ\""},
        Damage{"failed as number", [](json& f) { event(f, "job")["args"]["failed"] = 0; }, "true or false"},
        Damage{"long name", [](json& f) { event(f, "job")["name"] = std::string(5000, 'x'); },
               "at most 4096 characters"},
        Damage{"command among jobs", [](json& f) { event(f, "dma")["tid"] = 2001; }, "row of jobs"},
        Damage{"overlapping",
               [](json& f) {
                 json again = event(f, "wait");
                 f["traceEvents"].push_back(again);
               },
               "before the event before it in its row has ended"},
        Damage{"dropped too short", [](json& f) { f["softcell"]["dropped"].erase(0); }, "one entry for each"},
        Damage{"section past the store",
               [](json& f) { f["softcell"]["images"][0]["sections"][1]["bytes"] = 300000; },
               "softcell.images[0].sections[1]"},
        Damage{"overlapping sections",
               [](json& f) { f["softcell"]["images"][0]["sections"][2]["begin"] = 8; }, "overlaps"}),
    [](const auto& damage) {
      std::string name = damage.param.what;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

TEST(TraceFile, RefusesWhatIsNoJson) {
  const std::string whole = written();
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("ELF"), whole.substr(0, whole.size() / 2), whole + "x",
        std::string("{\"traceEvents\":[\"\xFF\"]}"), std::string(100'000, '[')}) {
    try {
      parse_trace(text);
      FAIL() << "accepted";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("it is not JSON: ", 0), 0u) << error.what();
    }
  }
}

TEST(TraceFile, NamesTheFileThatItCannotRead) {
  const ScratchFolder folder;
  std::ofstream(folder / "bad.json") << "{}";
  for (const char* name : {"missing.json", "bad.json"}) {
    try {
      read_trace(folder / name);
      FAIL() << "accepted";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(folder / name), std::string::npos) << error.what();
    }
  }
}

TEST(ReportPage, LetsNothingInATraceEndItsScript) {
  json file = json::parse(written());
  event(file, "finding")["args"]["message"] = "</script><script>alert(1)</script><!--";
  event(file, "job")["name"] = "@script@ @style@";
  const std::string page = report_page(parse_trace(file.dump()), "<b>\"a&b\"</b>");
  EXPECT_EQ(page.find("</script><script>alert"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>\\u003cscript>alert(1)"), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;b>&quot;a&amp;b&quot;&lt;/b>"), std::string::npos);
  EXPECT_NE(page.find("@script@ @style@"), std::string::npos) << "a trace's own text is left alone";
  EXPECT_EQ(page.find("@data@"), std::string::npos);
}

TEST(ReportPage, RefersToNothingOutside) {
  const std::string page = report_page(parse_trace(written()), "trace.json");
  for (const char* link : {"http://", "https://", "src=", "@import", "url("}) {
    EXPECT_EQ(page.find(link), std::string::npos) << link;
  }
}

}  // namespace
}  // namespace softcell::tool
