#include "kernel_outcome.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kWordBytes = 4;

std::string location_and_rule(const dma::Fault& fault) {
  return fmt::format("{} {}", fault.place.empty() ? fault.kernel : fault.place, dma::name(fault.rule));
}

/// The word that contains a byte, as number and as float; only the byte if the buffer ends within the word.
std::string value_at(std::span<const std::byte> bytes, std::size_t offset) {
  SC_ASSERT(offset < bytes.size(), "byte {} of {}", offset, bytes.size());
  const std::size_t begin = offset / kWordBytes * kWordBytes;
  if (begin + kWordBytes > bytes.size())
    return fmt::format("0x{:02X}", std::to_integer<unsigned>(bytes[offset]));
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + begin, sizeof word);
  return fmt::format("0x{:08X} ({:g})", word, std::bit_cast<float>(word));
}

std::string list_or_none(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? "none" : text;
}

void compare_buffers(const KernelOutcome::Contents& first, const KernelOutcome::Contents& other,
                     std::vector<Difference>& found) {
  SC_ASSERT(first.name == other.name && first.bytes.size() == other.bytes.size(),
            "buffer {} of {} bytes and buffer {} of {}", first.name, first.bytes.size(), other.name,
            other.bytes.size());
  std::uint64_t differing = 0;
  std::size_t offset = 0;
  for (std::size_t i = first.bytes.size(); i-- > 0;) {
    if (first.bytes[i] == other.bytes[i]) continue;
    ++differing;
    offset = i;
  }
  if (differing == 0) return;
  found.push_back({"buffer " + first.name, offset, differing, value_at(first.bytes, offset),
                   value_at(other.bytes, offset)});
}

}  // namespace

KernelOutcome outcome(const KernelRun& run, const KernelBuffers& buffers) {
  KernelOutcome result;
  for (const SpeRun& spe : run.spes) {
    result.ends.push_back(spe.result.fault ? location_and_rule(*spe.result.fault) : describe_end(spe));
  }
  for (const ls_sim::Finding& finding : run.findings)
    result.findings.push_back(location_and_rule(finding.fault));
  for (const KernelBuffers::Slot& slot : buffers.slots()) {
    if (slot.spec->direction == BufferSpec::kIn) continue;
    const auto bytes = slot.memory.span();
    result.buffers.push_back({slot.spec->name, {bytes.begin(), bytes.end()}});
  }
  return result;
}

std::string Difference::sentence(const std::string& first_run, const std::string& other_run) const {
  if (bytes == 0)
    return fmt::format("{}: {} under {}, {} under {}", what, first, first_run, other, other_run);
  return fmt::format("{}, byte {}: {} under {}, {} under {}; {} byte{} differ{}", what, offset, first,
                     first_run, other, other_run, bytes, bytes == 1 ? "" : "s", bytes == 1 ? "s" : "");
}

std::vector<Difference> differences(const KernelOutcome& first, const KernelOutcome& other) {
  SC_ASSERT(first.ends.size() == other.ends.size() && first.buffers.size() == other.buffers.size(),
            "{} SPEs and {} buffers, {} and {}: outcomes of two tasks", first.ends.size(),
            first.buffers.size(), other.ends.size(), other.buffers.size());
  std::vector<Difference> found;
  for (std::size_t spe = 0; spe < first.ends.size(); ++spe) {
    if (first.ends[spe] != other.ends[spe])
      found.push_back({fmt::format("SPE {}", spe), 0, 0, first.ends[spe], other.ends[spe]});
  }
  if (first.findings != other.findings)
    found.push_back({"findings", 0, 0, list_or_none(first.findings), list_or_none(other.findings)});
  for (std::size_t i = 0; i < first.buffers.size(); ++i)
    compare_buffers(first.buffers[i], other.buffers[i], found);
  return found;
}

nlohmann::ordered_json to_json(const Difference& difference) {
  nlohmann::ordered_json document{{"what", difference.what}};
  if (difference.bytes != 0) {
    document["offset"] = difference.offset;
    document["bytes"] = difference.bytes;
  }
  document["first"] = difference.first;
  document["other"] = difference.other;
  return document;
}

}  // namespace softcell::tool
