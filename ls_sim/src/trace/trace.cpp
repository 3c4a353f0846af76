#include "softcell/ls_sim/trace.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"
#include "softcell/ls_sim/findings.h"
#include "trace_events.h"
#include "trace_writer.h"

namespace softcell::ls_sim {
namespace {

TracedImage describe(const KernelImage& image) {
  return {image.name, image.checked, image.sizes.budget, local_store_map(image), image.objects, {}};
}

}  // namespace

TraceTime trace_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

bool TracedImage::is(const TracedImage& other) const {
  const auto same_object = [](const ImageObject& a, const ImageObject& b) {
    return a.name == b.name && a.begin == b.begin && a.bytes == b.bytes;
  };
  return name == other.name && checked == other.checked && budget == other.budget &&
         sections == other.sections &&
         std::equal(objects.begin(), objects.end(), other.objects.begin(), other.objects.end(), same_object);
}

std::uint32_t SpeEvents::image_index(const KernelImage& image) {
  // An image that is gone may have left its address to another: the name tells them apart.
  if (&image == last_image && image.name == images[last_index].name) return last_index;
  TracedImage described = describe(image);
  const auto known =
      std::find_if(images.begin(), images.end(), [&](const TracedImage& i) { return i.is(described); });
  last_image = &image;
  last_index = static_cast<std::uint32_t>(known - images.begin());
  if (known == images.end()) images.push_back(std::move(described));
  SC_ASSERT(last_index < images.size(), "image {} is number {} of {}", image.name, last_index, images.size());
  return last_index;
}

SpeTrace::SpeTrace(std::size_t most_events, TraceClock clock)
    : events_(std::make_unique<SpeEvents>(most_events)), clock_(clock) {
  events_->in_flight.reserve(64);
}

SpeTrace::~SpeTrace() = default;

std::size_t SpeTrace::last_command() const { return last_command_; }

void SpeTrace::complete_at(std::size_t command, TraceTime when) {
  if (command == EventLog<TracedCommand>::kDropped) return;
  TracedCommand& traced = events_->commands[command];
  SC_ASSERT(traced.issue <= when, "a command is issued at {} and complete at {}", traced.issue, when);
  traced.complete = when;
}

void SpeTrace::on_job(const KernelImage& image, std::uint64_t job_number, TraceTime begin, TraceTime end,
                      bool failed) {
  SC_ASSERT(begin <= end, "job {} of {} begins at {} and ends at {}", job_number, image.name, begin, end);
  SpeEvents& e = *events_;
  e.jobs.append({begin, end, job_number, e.image_index(image), failed});
  for (const auto& left : e.in_flight)
    e.commands[left.index].complete = std::max(end, e.commands[left.index].issue);
  e.in_flight.clear();
}

void SpeTrace::on_stack_used(const KernelImage& image, std::uint32_t bytes) {
  SC_ASSERT(bytes <= dma::kLocalStoreBytes, "{} has used {} bytes of stack", image.name, bytes);
  auto& used = events_->images[events_->image_index(image)].stack_used;
  used = std::max(used.value_or(0), bytes);
}

void SpeTrace::on_wait(std::uint32_t channel, TraceTime begin, TraceTime end) {
  SC_ASSERT(begin <= end, "a wait at channel {} begins at {} and ends at {}", channel, begin, end);
  events_->waits.append({begin, end, channel});
}

void SpeTrace::on_finding(const dma::Fault& fault, TraceTime when) {
  SpeEvents& e = *events_;
  // There are as many as a kernel has lines that are wrong: a few.
  const auto known = std::ranges::find_if(
      e.findings, [&](const TracedFinding& finding) { return is_same_mistake(finding.first, fault); });
  if (known != e.findings.end()) {
    ++known->count;
  } else if (e.findings.size() < e.most_findings) {
    e.findings.push_back({when, fault, 1});
  } else {
    ++e.dropped_findings;
  }
}

void SpeTrace::on_issue(std::uint64_t number, const dma::MfcCommand& command, std::uint64_t bytes) {
  const TraceTime now = this->now();
  SC_ASSERT(bytes <= 0xFFFF'FFFFu, "command {} moves {} bytes", number, bytes);
  const std::size_t index = events_->commands.append({.issue = now,
                                                      .complete = now,
                                                      .ea = command.ea.value,
                                                      .lsa = command.lsa.value,
                                                      .size = command.size,
                                                      .bytes = static_cast<std::uint32_t>(bytes),
                                                      .opcode = static_cast<std::uint16_t>(command.opcode()),
                                                      .tag = static_cast<std::uint8_t>(command.tag),
                                                      .completed = false});
  last_command_ = index;
  if (index != EventLog<TracedCommand>::kDropped) events_->in_flight.push_back({number, index});
}

void SpeTrace::on_complete(std::uint64_t number) { complete(number); }

void SpeTrace::on_reservation_lost(std::uint64_t number) {
  if (TracedCommand* command = complete(number)) command->bytes = 0;
}

TracedCommand* SpeTrace::complete(std::uint64_t number) {
  auto& in_flight = events_->in_flight;
  // From the newest: what completes is often what was issued last.
  for (std::size_t i = in_flight.size(); i-- > 0;) {
    if (in_flight[i].number != number) continue;
    SC_ASSERT(!events_->commands[in_flight[i].index].completed, "command {} completes a second time", number);
    TracedCommand& command = events_->commands[in_flight[i].index];
    if (clock_ == TraceClock::kHost) command.complete = trace_now();
    command.completed = true;
    in_flight[i] = in_flight.back();
    in_flight.pop_back();
    return &command;
  }
  return nullptr;
}

Trace::Trace(int spes, std::size_t most_events, TraceClock clock)
    : begin_(clock == TraceClock::kHost ? trace_now() : 0), clock_(clock) {
  if (spes < 1) throw std::invalid_argument("a trace needs at least 1 SPE, not " + std::to_string(spes));
  for (int i = 0; i < spes; ++i) {
    spes_.push_back(std::unique_ptr<SpeTrace>(new SpeTrace(most_events, clock)));
  }
}

Trace::~Trace() = default;

SpeTrace& Trace::spe(int number) {
  SC_ASSERT(number >= 0 && number < spes(), "SPE {} in a trace of {}", number, spes());
  return *spes_[static_cast<std::size_t>(number)];
}
int Trace::spes() const { return static_cast<int>(spes_.size()); }

void Trace::write(const std::filesystem::path& path) const {
  base::WholeFile file(path);
  write(file);
  file.commit();
}

void Trace::write(base::WholeFile& file) const {
  TraceWriter writer(file, begin_, clock_);
  std::vector<const SpeEvents*> spes;
  for (const auto& spe : spes_) spes.push_back(spe->events_.get());
  // The SPEs of a console are shown even if they were idle. Those beyond are contexts that a program did not need.
  const auto idle = [](const SpeEvents& e) {
    return e.jobs.size() + e.waits.size() + e.commands.size() == 0;
  };
  while (spes.size() > dma::kSpeCount && idle(*spes.back())) spes.pop_back();
  writer.write(spes);
  file.finish();
}

}  // namespace softcell::ls_sim
