// What a trace records, and the file that it writes.

#include "softcell/ls_sim/trace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "image/local_store_map.h"

namespace softcell::ls_sim {
namespace {

using nlohmann::json;

/// A file in the temporary folder, which is removed with this object.
class ScratchFile {
 public:
  ScratchFile()
      : path_(std::filesystem::temp_directory_path() /
              ("softcell_trace_" + std::to_string(trace_now()) + ".json")) {}
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(path_, std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path path_;
};

std::string text_of(const Trace& trace) {
  const ScratchFile file;
  trace.write(file.path());
  return file.text();
}

json written(const Trace& trace) { return json::parse(text_of(trace)); }

/// The events of a category, in the order of the file.
std::vector<json> events(const json& file, const std::string& category) {
  std::vector<json> found;
  for (const json& event : file["traceEvents"]) {
    if (event.value("cat", "") == category) found.push_back(event);
  }
  return found;
}

KernelImage saxpy() {
  KernelImage image;
  image.name = "saxpy";
  image.text_begin = 0x80, image.text_end = 0x480;
  image.rodata_begin = 0x480, image.rodata_end = 0x4A0;
  image.data_begin = 0x4A0, image.data_end = 0x4A8;
  image.sizes = {
      .text = 0x400, .rodata = 0x20, .data = 8, .bss = 0x8004, .stack = 2048, .budget = 65536, .end = 0x8510};
  image.objects = {{"sums", {0x4A0}, 8}, {"buffers", {0x500}, 0x8000}};
  return image;
}

dma::MfcCommand get(std::uint32_t lsa, std::uint32_t size, std::uint32_t tag) {
  return {.word = static_cast<std::uint32_t>(dma::MfcOpcode::get),
          .lsa = {lsa},
          .ea = dma::kMainMemoryBase + 0x80,
          .size = size,
          .tag = tag};
}

TEST(LocalStoreMap, CoversTheLocalStoreButForAlignment) {
  const std::vector<LocalStoreSection> expected{
      {"environment", 0, 0x80}, {"text", 0x80, 0x400},  {"rodata", 0x480, 0x20},
      {"data", 0x4A0, 8},       {"bss", 0x500, 0x8004}, {"free", 0x8510, 0x40000 - 2048 - 0x8510},
      {"stack", 0x3F800, 2048},
  };
  EXPECT_EQ(local_store_map(saxpy()), expected);
}

TEST(LocalStoreMap, LeavesOutWhatIsEmpty) {
  KernelImage image = saxpy();
  image.rodata_end = image.rodata_begin;
  image.sizes.bss = 0;
  image.sizes.end = image.data_end = 0x4A0;
  for (const LocalStoreSection& section : local_store_map(image)) {
    EXPECT_NE(section.bytes, 0u) << section.kind;
    EXPECT_NE(section.kind, "bss");
  }
}

TEST(Trace, WritesJobsInMicrosecondsSinceItsBeginning) {
  const TraceTime before = trace_now();
  Trace trace(2);
  const TraceTime after = trace_now();
  const KernelImage image = saxpy();
  trace.spe(1).on_job(image, 17, after + 1'234'567, after + 2'000'067, true);
  const std::vector<json> jobs = events(written(trace), "job");
  ASSERT_EQ(jobs.size(), 1u);
  EXPECT_EQ(jobs[0]["ph"], "X");
  EXPECT_EQ(jobs[0]["pid"], 2);
  EXPECT_EQ(jobs[0]["name"], "saxpy");
  EXPECT_EQ(jobs[0]["args"]["job"], 17);
  EXPECT_EQ(jobs[0]["args"]["failed"], true);
  EXPECT_DOUBLE_EQ(jobs[0]["dur"], 765.5);
  EXPECT_GE(jobs[0]["ts"].get<double>(), 1234.567);
  EXPECT_LE(jobs[0]["ts"].get<double>(), 1234.567 + static_cast<double>(after - before) / 1000);
}

TEST(Trace, NamesEveryProcessAndRow) {
  Trace trace(6);
  trace.spe(3).on_issue(1, get(0x1000, 128, 0), 128);
  trace.spe(3).on_issue(2, get(0x2000, 128, 1), 128);
  trace.spe(3).on_complete(1);
  trace.spe(3).on_complete(2);
  std::set<std::string> processes, rows;
  std::set<int> numbers;
  const json file = written(trace);
  for (const json& event : file["traceEvents"]) {
    if (event["name"] == "process_name") processes.insert(event["args"]["name"].get<std::string>());
    if (event["name"] != "thread_name") continue;
    EXPECT_TRUE(numbers.insert(event["tid"].get<int>()).second)
        << "a row's number is its own in the whole file";
    if (event["pid"] == 4) rows.insert(event["args"]["name"].get<std::string>());
  }
  EXPECT_EQ(processes, (std::set<std::string>{"SPE 0", "SPE 1", "SPE 2", "SPE 3", "SPE 4", "SPE 5"}));
  EXPECT_EQ(rows, (std::set<std::string>{"jobs", "waits", "DMA 1", "DMA 2"}));
}

TEST(Trace, GivesNoBytesToAPutllcThatMovedNone) {
  Trace trace(1);
  dma::MfcCommand command = get(0x1000, 128, 0);
  command.word = static_cast<std::uint32_t>(dma::MfcOpcode::putllc);
  trace.spe(0).on_issue(1, command, 128);
  trace.spe(0).on_reservation_lost(1);
  trace.spe(0).on_issue(2, command, 128);
  trace.spe(0).on_complete(2);
  const std::vector<json> commands = events(written(trace), "dma");
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0]["args"]["bytes"], 0);
  EXPECT_EQ(commands[0]["args"]["size"], 128);
  EXPECT_EQ(commands[0]["args"]["completed"], true);
  EXPECT_EQ(commands[1]["args"]["bytes"], 128);
}

TEST(Trace, PutsCommandsInFlightAtTheSameTimeOnRowsOfTheirOwn) {
  Trace trace(1);
  SpeTrace& spe = trace.spe(0);
  spe.on_issue(1, get(0x1000, 16, 3), 16);
  spe.on_issue(2, get(0x2000, 32, 4), 32);
  std::this_thread::sleep_for(std::chrono::microseconds(10));
  spe.on_complete(2);
  spe.on_complete(1);
  std::this_thread::sleep_for(std::chrono::microseconds(10));
  spe.on_issue(3, get(0x3000, 64, 5), 64);
  spe.on_complete(3);
  const std::vector<json> commands = events(written(trace), "dma");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_NE(commands[0]["tid"], commands[1]["tid"]);
  EXPECT_EQ(commands[0]["tid"], commands[2]["tid"]) << "the first row is free again";
  EXPECT_GT(commands[0]["dur"].get<double>(), commands[1]["dur"].get<double>());
  const json expected{{"tag", 4},   {"lsa", "0x02000"}, {"ea", "0x5EA010000080"},
                      {"size", 32}, {"bytes", 32},      {"completed", true}};
  EXPECT_EQ(commands[1]["name"], "get");
  EXPECT_EQ(commands[1]["args"], expected);
}

TEST(Trace, DrawsACommandThatNeverCompletesToTheEndOfItsJob) {
  Trace trace(1);
  SpeTrace& spe = trace.spe(0);
  spe.on_issue(1, get(0x1000, 16, 3), 16);
  const TraceTime end = trace_now() + 5'000'000;
  spe.on_job(saxpy(), 0, trace_now(), end, true);
  spe.on_complete(1);  // too late: its job has ended
  const json file = written(trace);
  const json command = events(file, "dma").at(0), job = events(file, "job").at(0);
  EXPECT_EQ(command["args"]["completed"], false);
  EXPECT_NEAR(command["ts"].get<double>() + command["dur"].get<double>(),
              job["ts"].get<double>() + job["dur"].get<double>(), 0.01);
}

TEST(Trace, NamesTheChannelOfAWait) {
  Trace trace(1);
  const TraceTime now = trace_now();
  trace.spe(0).on_wait(24, now, now + 2500);
  trace.spe(0).on_wait(99, now + 2500, now + 2600);
  const std::vector<json> waits = events(written(trace), "wait");
  ASSERT_EQ(waits.size(), 2u);
  EXPECT_EQ(waits[0]["name"], "MFC_RdTagStat");
  EXPECT_EQ(waits[0]["args"]["channel"], 24);
  EXPECT_DOUBLE_EQ(waits[0]["dur"], 2.5);
  EXPECT_EQ(waits[1]["name"], "channel 99");
}

TEST(Trace, KeepsAFindingWithItsWholeMessage) {
  Trace trace(1);
  const dma::Fault fault{.rule = dma::kAllRules[0],
                         .spe = 0,
                         .kernel = "say \"x\"",
                         .place = "a\\b\n.cpp:4",
                         .detail = "odd \x80 byte"};
  trace.spe(0).on_finding(fault, trace_now());
  const json finding = events(written(trace), "finding").at(0);
  EXPECT_EQ(finding["ph"], "i");
  EXPECT_EQ(finding["name"], dma::name(fault.rule));
  EXPECT_EQ(finding["args"]["kernel"], "say \"x\"");
  EXPECT_EQ(finding["args"]["place"], "a\\b\n.cpp:4");
  EXPECT_NE(finding["args"]["message"].get<std::string>().find("odd ? byte"), std::string::npos);
}

TEST(Trace, HasTheSameMistakeOnceWithItsFirstTimeAndItsCount) {
  Trace trace(2);
  const TraceTime now = trace_now();
  dma::Fault fault{.rule = dma::kAllRules[0], .kernel = "skin", .place = "skin.cpp:4", .detail = "first"};
  for (int i = 0; i < 500; ++i) {
    trace.spe(0).on_finding(fault, now + i * 1000);
    fault.detail = "again";
  }
  dma::Fault elsewhere = fault;
  elsewhere.place = "skin.cpp:5";
  trace.spe(0).on_finding(elsewhere, now + 2000);
  trace.spe(1).on_finding(fault, now + 3000);
  const std::vector<json> findings = events(written(trace), "finding");
  ASSERT_EQ(findings.size(), 3u);
  EXPECT_EQ(findings[0]["args"]["count"], 500);
  EXPECT_NE(findings[0]["args"]["message"].get<std::string>().find("first"), std::string::npos);
  EXPECT_EQ(findings[1]["args"]["place"], "skin.cpp:5");
  EXPECT_EQ(findings[1]["args"]["count"], 1);
  EXPECT_NEAR(findings[1]["ts"].get<double>() - findings[0]["ts"].get<double>(), 2, 1e-6);
  EXPECT_EQ(findings[2]["args"]["count"], 1) << "each SPE counts for itself";
}

TEST(Trace, ListsEachImageOnceWithTheMostStackThatAnySpeUsed) {
  Trace trace(2);
  const TraceTime now = trace_now();
  {
    const KernelImage image = saxpy();
    trace.spe(0).on_job(image, 0, now, now + 1, false);
    trace.spe(0).on_stack_used(image, 300);
    trace.spe(1).on_job(image, 1, now, now + 1, false);
    trace.spe(1).on_stack_used(image, 500);
    trace.spe(1).on_stack_used(image, 400);
    KernelImage other = saxpy();
    other.name = "other";
    other.checked = true;
    trace.spe(1).on_job(other, 2, now, now + 1, false);
  }  // the trace outlives its images
  const json images = written(trace)["softcell"]["images"];
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0]["name"], "other");
  EXPECT_EQ(images[0]["checked"], true);
  EXPECT_TRUE(images[0]["stack_used"].is_null());
  EXPECT_EQ(images[1]["stack_used"], 500);
  EXPECT_EQ(images[1]["budget"], 65536);
  EXPECT_EQ(images[1]["sections"][1], (json{{"kind", "text"}, {"begin", 0x80}, {"bytes", 0x400}}));
  EXPECT_EQ(images[1]["objects"][1], (json{{"name", "buffers"}, {"begin", 0x500}, {"bytes", 0x8000}}));
}

TEST(Trace, CountsWhatItDropsPastItsLimit) {
  Trace trace(1, 3);
  const TraceTime now = trace_now();
  for (std::uint64_t i = 1; i <= 5; ++i) {
    trace.spe(0).on_issue(i, get(0x1000, 16, 0), 16);
    trace.spe(0).on_complete(i);
    trace.spe(0).on_wait(24, now, now);
    trace.spe(0).on_job(saxpy(), i, now, now, false);
    trace.spe(0).on_finding({.rule = dma::kAllRules[0], .place = "a.cpp:" + std::to_string(i)}, now);
  }
  const json file = written(trace);
  EXPECT_EQ(file["softcell"]["dropped"][0],
            (json{{"jobs", 2}, {"waits", 2}, {"commands", 2}, {"findings", 2}}));
  for (const char* category : {"job", "wait", "dma", "finding"}) {
    EXPECT_EQ(events(file, category).size(), 3u) << category;
  }
}

TEST(Trace, KeepsEventsInOrderPastTheFirstChunkOfMemory) {
  Trace trace(1);
  const TraceTime now = trace_now();
  constexpr int kJobs = 20'000;
  const KernelImage image = saxpy();
  for (int i = 0; i < kJobs; ++i)
    trace.spe(0).on_job(image, static_cast<std::uint64_t>(i), now + i, now + i + 1, false);
  const std::vector<json> jobs = events(written(trace), "job");
  ASSERT_EQ(jobs.size(), static_cast<std::size_t>(kJobs));
  for (int i = 0; i < kJobs; ++i) ASSERT_EQ(jobs[static_cast<std::size_t>(i)]["args"]["job"], i);
}

TEST(Trace, SaysWhatWroteIt) {
  const json about = written(Trace(3))["softcell"];
  EXPECT_EQ(about["format"], 1);
  EXPECT_EQ(about["spes"], 3);
  EXPECT_TRUE(about["version"].is_string());
  EXPECT_NE(about["time"].get<std::string>().find("microseconds"), std::string::npos);
}

TEST(Trace, WritesTheSameFileTwice) {
  Trace trace(2);
  const TraceTime now = trace_now();
  trace.spe(0).on_job(saxpy(), 0, now, now + 12'345, false);
  trace.spe(1).on_wait(24, now, now + 10);
  EXPECT_EQ(text_of(trace), text_of(trace));
}

TEST(Trace, SaysWhyItsFileCannotBeWritten) {
  try {
    Trace(1).write("/nowhere/at/all.json");
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.json"), std::string::npos) << error.what();
  }
  EXPECT_THROW(Trace(0), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ls_sim
