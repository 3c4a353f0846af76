#pragma once
// What a trace keeps in memory until it is written.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "event_log.h"
#include "image/local_store_map.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {

/// What an image declares, copied so that the image need not outlive its runs.
struct TracedImage {
  std::string name;
  bool checked = false;
  std::uint32_t budget = 0;
  std::vector<LocalStoreSection> sections;
  std::vector<ImageObject> objects;
  std::optional<std::uint32_t> stack_used;  ///< bytes

  /// The same image, whatever stack its runs were seen to use.
  bool is(const TracedImage& other) const;
};

struct TracedJob {
  TraceTime begin, end;
  std::uint64_t number;
  std::uint32_t image;  ///< index into images
  bool failed;
};

struct TracedWait {
  TraceTime begin, end;
  std::uint32_t channel;
};

/// 40 bytes, because a run has millions of them.
struct TracedCommand {
  TraceTime issue, complete;
  std::uint64_t ea;
  std::uint32_t lsa, size, bytes;
  std::uint16_t opcode;
  std::uint8_t tag;
  bool completed;
};
static_assert(sizeof(TracedCommand) == 40);

/// All occurrences of one mistake (is_same_mistake()).
struct TracedFinding {
  TraceTime when;  ///< of the first
  dma::Fault first;
  std::uint64_t count;
};

struct SpeEvents {
  explicit SpeEvents(std::size_t most) : jobs(most), waits(most), commands(most), most_findings(most) {}

  std::uint32_t image_index(const KernelImage& image);

  EventLog<TracedJob> jobs;
  EventLog<TracedWait> waits;
  EventLog<TracedCommand> commands;

  std::size_t most_findings, dropped_findings = 0;
  std::vector<TracedFinding> findings;  // in order of the first

  std::vector<TracedImage> images;
  const KernelImage* last_image = nullptr;  // so that a run of the same image finds it at once
  std::uint32_t last_index = 0;

  struct InFlight {
    std::uint64_t number;  // as the MFC counts
    std::size_t index;     // in commands
  };
  std::vector<InFlight> in_flight;  // about as many as the queue holds
};

}  // namespace softcell::ls_sim
