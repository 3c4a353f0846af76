#include "kernel_timing.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "softcell/base/text.h"

namespace softcell::tool {
namespace {

using ls_sim::CycleCounts;
using ls_sim::Stall;
using nlohmann::ordered_json;

double microseconds(std::uint64_t cycles) {
  return static_cast<double>(cycles) * 1e6 / static_cast<double>(ls_sim::kCyclesPerSecond);
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<Stall> all_stalls() {
  std::vector<Stall> all;
  for (std::size_t i = 0; i < ls_sim::kStalls; ++i) all.push_back(static_cast<Stall>(i));
  return all;
}

/// The stalls that occur at all, because most of a table's eleven columns would be zero.
std::vector<Stall> stalls_in(const CycleCounts& counts) {
  std::vector<Stall> found = all_stalls();
  std::erase_if(found, [&](Stall stall) { return counts.stalled(stall) == 0; });
  return found;
}

constexpr int kStallWidth = 17;

void print_heading(const char* what, const std::vector<Stall>& stalls) {
  fmt::print("\n{:<4} {:>12} {:>12} {:>6} {:>6}", what, "cycles", "instructions", "CPI", "dual");
  for (const Stall stall : stalls) fmt::print(" {:>{}}", ls_sim::name(stall), kStallWidth);
  fmt::print("\n");
}

void print_counts(const CycleCounts& counts, const std::vector<Stall>& stalls) {
  fmt::print(" {:>12} {:>12} {:>6.2f} {:>5.1f}%", counts.cycles, counts.instructions,
             counts.cycles_per_instruction(), 100 * counts.dual_issue_share());
  for (const Stall stall : stalls) {
    fmt::print(
        " {:>{}}",
        fmt::format("{} {:>4.1f}%", counts.stalled(stall), percent(counts.stalled(stall), counts.cycles)),
        kStallWidth);
  }
}

std::string shown(const ls_sim::FunctionCycles& function) {
  return function.name.empty() ? fmt::format("at 0x{:05X}", function.begin.value) : function.name;
}

void print_details(const ls_sim::Timing& timing, int spe) {
  const ls_sim::PipelineCounts pipeline = timing.pipeline(spe);
  const ls_sim::TransferCounts transfers = timing.transfers(spe);
  if (timing.total(spe).instructions != 0) {
    fmt::print("SPE {}: {} branches, {} taken, {} missed; {} hints, {} used; {} nops;", spe,
               pipeline.branches, pipeline.branches_taken, pipeline.branch_misses, pipeline.hints,
               pipeline.hints_used, pipeline.nops);
    fmt::print(" waits for results of");
    bool any = false;
    for (std::size_t i = 0; i < pipeline.dependency.size(); ++i) {
      if (pipeline.dependency[i] == 0) continue;
      fmt::print("{} {} {}", any ? "," : "", ls_sim::kLatencyClasses[i], pipeline.dependency[i]);
      any = true;
    }
    fmt::print("{}\n", any ? "" : " nothing");
  }
  if (transfers.commands != 0) {
    fmt::print("SPE {}: {}, {}, {:.0f} cycles from issue to end on average; {} for tags, {} for the queue\n",
               spe, base::counted(transfers.commands, "DMA command"), base::counted(transfers.lines, "line"),
               static_cast<double>(transfers.latency) / static_cast<double>(transfers.commands),
               base::counted(transfers.tag_waits, "wait"), transfers.queue_waits);
  }
}

ordered_json details(const ls_sim::Timing& timing, int spe) {
  const ls_sim::PipelineCounts p = timing.pipeline(spe);
  const ls_sim::TransferCounts t = timing.transfers(spe);
  ordered_json dependency;
  for (std::size_t i = 0; i < p.dependency.size(); ++i)
    dependency[std::string(ls_sim::kLatencyClasses[i])] = p.dependency[i];
  return {{"dependency_cycles", std::move(dependency)},
          {"branches", p.branches},
          {"branches_taken", p.branches_taken},
          {"branch_misses", p.branch_misses},
          {"hints", p.hints},
          {"hints_used", p.hints_used},
          {"nops", p.nops},
          {"dma",
           {{"commands", t.commands},
            {"lines", t.lines},
            {"latency_cycles", t.latency},
            {"tag_waits", t.tag_waits},
            {"queue_waits", t.queue_waits},
            {"other_waits", t.other_waits}}}};
}

}  // namespace

void print_functions(const std::string& what, const std::vector<ls_sim::FunctionCycles>& functions) {
  if (functions.empty()) return;
  CycleCounts sum;
  for (const ls_sim::FunctionCycles& function : functions) sum += function.counts;
  const std::vector<Stall> stalls = stalls_in(sum);
  print_heading(what.c_str(), stalls);
  for (const ls_sim::FunctionCycles& function : functions) {
    fmt::print("    ");
    print_counts(function.counts, stalls);
    fmt::print("  {}\n", shown(function));
  }
}

ordered_json to_json(const std::vector<ls_sim::FunctionCycles>& functions) {
  ordered_json rows = ordered_json::array();
  for (const ls_sim::FunctionCycles& function : functions) {
    ordered_json row{{"function", function.name}, {"address", function.begin.value}};
    row.update(to_json(function.counts));
    rows.push_back(std::move(row));
  }
  return rows;
}

void print_timing(const ls_sim::KernelImage& image, const ls_sim::Timing& timing) {
  CycleCounts sum;
  for (int spe = 0; spe < timing.spes(); ++spe) sum += timing.total(spe);
  const std::vector<Stall> stalls = stalls_in(sum);
  print_heading("SPE", stalls);
  for (int spe = 0; spe < timing.spes(); ++spe) {
    const CycleCounts counts = timing.total(spe);
    fmt::print("{:<4}", spe);
    print_counts(counts, stalls);
    fmt::print("  {:.3f} us\n", microseconds(counts.cycles));
  }
  if (image.machine == ls_sim::Machine::kHost)
    fmt::print(
        "The cycles are those of waits for transfers: {} is built for the host, and only a program for the "
        "SPU has instructions that count.\n",
        image.name);
  for (int spe = 0; spe < timing.spes(); ++spe) {
    print_functions(fmt::format("SPE {}", spe), timing.by_function(spe, image));
    print_details(timing, spe);
  }
}

ordered_json to_json(const CycleCounts& counts) {
  ordered_json stalls;
  for (const Stall stall : all_stalls())
    stalls[std::string(ls_sim::json_name(stall))] = counts.stalled(stall);
  return {{"cycles", counts.cycles},
          {"instructions", counts.instructions},
          {"cpi", counts.cycles_per_instruction()},
          {"pairs", counts.pairs},
          {"dual_issue_share", counts.dual_issue_share()},
          {"stalls", std::move(stalls)}};
}

ordered_json to_json(const ls_sim::KernelImage& image, const ls_sim::Timing& timing) {
  ordered_json spes = ordered_json::array();
  for (int spe = 0; spe < timing.spes(); ++spe) {
    ordered_json one{{"spe", spe}, {"end_us", microseconds(timing.now(spe))}};
    one.update(to_json(timing.total(spe)));
    one.update(details(timing, spe));
    one["functions"] = to_json(timing.by_function(spe, image));
    spes.push_back(std::move(one));
  }
  ordered_json parameters;
  for (const ls_sim::TimingParameterInfo& info : ls_sim::timing_parameters())
    parameters[std::string(info.name)] = info.value;
  return {{"cycles_per_second", ls_sim::kCyclesPerSecond},
          {"parameters", std::move(parameters)},
          {"spes", std::move(spes)}};
}

}  // namespace softcell::tool
