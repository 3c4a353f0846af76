#include "kernel_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kernel_runs/kernel_file.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

using nlohmann::ordered_json;

/// One kind of DMA command. Kinds that have no amount leave out the second count.
struct TrafficRow {
  const char* kind;
  std::uint64_t commands = 0;
  std::uint64_t bytes = 0;
  const char* second_name = nullptr;
  std::uint64_t second = 0;
};

std::vector<TrafficRow> traffic(const dma::MfcStatistics& s) {
  return {{"get", s.get.commands, s.get.bytes},
          {"put", s.put.commands, s.put.bytes},
          {"get_list", s.get_list.commands, s.get_list.bytes, "elements", s.get_list.elements},
          {"put_list", s.put_list.commands, s.put_list.bytes, "elements", s.put_list.elements},
          {"getllar", s.getllar, s.getllar * dma::kLineBytes},
          {"putllc", s.putllc, (s.putllc - s.putllc_failed) * dma::kLineBytes, "failed", s.putllc_failed},
          {"putlluc", s.putlluc, s.putlluc * dma::kLineBytes},
          {"putqlluc", s.putqlluc, s.putqlluc * dma::kLineBytes},
          {"signals", s.signals, s.signals * 4},
          {"ordering", s.ordering, 0},
          {"hints", s.hints, 0}};
}

std::vector<TrafficRow> traffic(const KernelRun& run) {
  std::vector<TrafficRow> sum = traffic(dma::MfcStatistics{});
  for (const SpeRun& spe : run.spes) {
    const std::vector<TrafficRow> rows = traffic(spe.statistics.dma);
    SC_ASSERT(rows.size() == sum.size(), "{} kinds of commands of {}", rows.size(), sum.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      sum[i].commands += rows[i].commands;
      sum[i].bytes += rows[i].bytes;
      sum[i].second += rows[i].second;
    }
  }
  return sum;
}

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

std::uint32_t stack_used(const KernelRun& run) {
  std::uint32_t most = 0;
  for (const SpeRun& spe : run.spes) most = std::max(most, spe.statistics.stack_high_water);
  return most;
}

void print_traffic(const KernelRun& run) {
  fmt::print("{:<10} {:>12} {:>14}\n", "DMA", "commands", "bytes");
  TrafficRow all{"all"};
  for (const TrafficRow& row : traffic(run)) {
    all.commands += row.commands;
    all.bytes += row.bytes;
    if (row.commands == 0) continue;
    fmt::print("{:<10} {:>12} {:>14}", row.kind, row.commands, row.bytes);
    if (row.second_name != nullptr) fmt::print("  {} {}", row.second, row.second_name);
    fmt::print("\n");
  }
  fmt::print("{:<10} {:>12} {:>14}\n", all.kind, all.commands, all.bytes);
}

void print_spes(const KernelRun& run) {
  fmt::print("\n{:<4} {:<22} {:>9} {:>9} {:>11} {:>6} {:>6} {:>6} {:>6} {:>9} {:>6}\n", "SPE", "end",
             "busy ms", "commands", "bytes", "mean q", "max q", "q full", "waits", "wait ms", "stack");
  for (std::size_t number = 0; number < run.spes.size(); ++number) {
    const ls_sim::SpeStatistics& s = run.spes[number].statistics;
    fmt::print("{:<4} {:<22} {:>9.3f} {:>9} {:>11} {:>6.1f} {:>6} {:>6} {:>6} {:>9.3f} {:>6}\n", number,
               describe_end(run.spes[number]), milliseconds(s.busy), s.dma.commands(), s.dma.bytes(),
               s.dma.mean_queue_occupancy(), s.dma.highest_queue_occupancy, s.dma.queue_full_stalls,
               s.channel_waits, milliseconds(s.channel_waiting), s.stack_high_water);
  }
}

void print_instructions(const KernelRun& run) {
  for (std::size_t number = 0; number < run.spes.size(); ++number) {
    const ls_sim::SpeStatistics& s = run.spes[number].statistics;
    if (s.instructions != 0) fmt::print("SPE {} executed {} instructions\n", number, s.instructions);
  }
}

void print_mail(const KernelRun& run) {
  for (std::size_t number = 0; number < run.spes.size(); ++number) {
    const auto print = [&](const char* mailbox, const std::optional<std::uint32_t>& value) {
      if (value) fmt::print("SPE {} left 0x{:08X} in its {}\n", number, *value, mailbox);
    };
    print("outbound mailbox", run.spes[number].out_mbox);
    print("outbound interrupt mailbox", run.spes[number].out_intr_mbox);
  }
}

void print_local_store(const ls_sim::KernelImage& image, const KernelRun& run) {
  const ls_sim::ImageSizes& s = image.sizes;
  const std::string checks = stack_for_checks(image) != 0
                                 ? fmt::format(" (the kernel's {} and {} for the checks)",
                                               s.stack - stack_for_checks(image), stack_for_checks(image))
                                 : "";
  fmt::print(
      "\nlocal store: text {}, rodata {}, data {}, bss {} bytes; stack {} used of {} declared{}; {} of {} "
      "bytes free\n",
      s.text, s.rodata, s.data, s.bss, stack_used(run), s.stack, checks, dma::kLocalStoreBytes - s.total(),
      dma::kLocalStoreBytes);
}

ordered_json to_json(const std::vector<TrafficRow>& rows) {
  ordered_json document;
  for (const TrafficRow& row : rows) {
    ordered_json& kind = document[row.kind] = {{"commands", row.commands}, {"bytes", row.bytes}};
    if (row.second_name != nullptr) kind[row.second_name] = row.second;
  }
  return document;
}

ordered_json to_json(const dma::Fault& fault) {
  return {{"rule", dma::name(fault.rule)},
          {"kernel", fault.kernel},
          {"spe", fault.spe},
          {"place", fault.place},
          {"message", fault.message()},
          {"explanation", dma::explanation(fault.rule)}};
}

template <class T>
ordered_json value_or_null(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json to_json(int number, const SpeRun& spe) {
  const ls_sim::SpeStatistics& s = spe.statistics;
  const bool normal = spe.result.ended_normally();
  return {{"spe", number},
          {"status", normal ? ordered_json(spe.result.status()) : ordered_json(nullptr)},
          {"stop_code", spe.result.fault ? ordered_json(nullptr) : ordered_json(spe.result.stop_code)},
          {"fault", spe.result.fault ? to_json(*spe.result.fault) : ordered_json(nullptr)},
          {"out_mbox", value_or_null(spe.out_mbox)},
          {"out_intr_mbox", value_or_null(spe.out_intr_mbox)},
          {"last_instructions", spe.result.last_instructions},
          {"instructions", s.instructions},
          {"busy_ms", milliseconds(s.busy)},
          {"dma", to_json(traffic(s.dma))},
          {"dma_commands", s.dma.commands()},
          {"dma_bytes", s.dma.bytes()},
          {"queue_occupancy_mean", s.dma.mean_queue_occupancy()},
          {"queue_occupancy_highest", s.dma.highest_queue_occupancy},
          {"queue_full_stalls", s.dma.queue_full_stalls},
          {"tag_waits", s.dma.tag_waits},
          {"channel_waits", s.channel_waits},
          {"channel_waiting_ms", milliseconds(s.channel_waiting)},
          {"stack_used", s.stack_high_water}};
}

}  // namespace

void print_statistics(const ls_sim::KernelImage& image, const KernelRun& run) {
  print_traffic(run);
  print_spes(run);
  print_instructions(run);
  print_mail(run);
  print_local_store(image, run);
}

void print_findings(std::span<const ls_sim::Finding> findings) {
  for (const ls_sim::Finding& finding : findings) {
    fmt::print(stderr, "softcell: {}{}\n    {}\n", base::one_line(finding.fault.message()),
               finding.count == 1 ? "" : fmt::format(" ({} times)", finding.count),
               dma::explanation(finding.fault.rule));
  }
}

void print_problems(const ls_sim::KernelImage& image, const KernelRun& run) {
  print_findings(run.findings);
  for (const std::string& failure : run.failures(image))
    fmt::print(stderr, "softcell: {}\n", base::one_line(failure));
  for (std::size_t number = 0; number < run.spes.size(); ++number) {
    const std::vector<std::string>& last = run.spes[number].result.last_instructions;
    if (!last.empty()) fmt::print(stderr, "    the last instructions of SPE {}:\n", number);
    for (const std::string& instruction : last) fmt::print(stderr, "    {}\n", base::one_line(instruction));
  }
}

ordered_json to_json(std::span<const ls_sim::Finding> findings) {
  ordered_json document = ordered_json::array();
  for (const ls_sim::Finding& finding : findings) {
    document.push_back(to_json(finding.fault));
    document.back()["count"] = finding.count;
  }
  return document;
}

ordered_json to_json(const ls_sim::KernelImage& image, const KernelRun& run) {
  const ls_sim::ImageSizes& s = image.sizes;
  ordered_json spes = ordered_json::array();
  for (std::size_t number = 0; number < run.spes.size(); ++number)
    spes.push_back(to_json(static_cast<int>(number), run.spes[number]));
  return {{"kernel", image.name},
          {"checked", image.checked},
          {"exit_status", exit_status(image, run)},
          {"dma", to_json(traffic(run))},
          {"local_store",
           {{"text", s.text},
            {"rodata", s.rodata},
            {"data", s.data},
            {"bss", s.bss},
            {"stack", s.stack},
            {"stack_for_checks", stack_for_checks(image)},
            {"stack_used", stack_used(run)},
            {"budget", s.budget},
            {"free", dma::kLocalStoreBytes - s.total()}}},
          {"spes", std::move(spes)},
          {"findings", to_json(std::span(run.findings))}};
}

int exit_status(const ls_sim::KernelImage& image, const KernelRun& run) {
  if (!run.failures(image).empty()) return kExitFailed;
  return run.findings.empty() ? 0 : kExitFindings;
}

}  // namespace softcell::tool
