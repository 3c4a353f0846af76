#include "job_calls.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/local_store_bytes.h"

namespace softcell::ls_sim::interpreter {
namespace {

constexpr std::uint32_t kCanaryBytes = 256;
/// The function called keeps its link register in the caller's frame, bytes 16 to 31.  [SPU ABI] documented
constexpr std::uint32_t kSharedFrameBytes = 32;
constexpr const char* kMark = "softcell::spu::job_mark";

std::uint64_t doubleword(const std::byte* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return __builtin_bswap64(value);
}

}  // namespace

JobCalls::JobCalls(const KernelImage& caller, LocalStore& local_store, const SpuState& state,
                   JobObserver* jobs)
    : caller_(caller), local_store_(local_store), state_(state), jobs_(jobs) {
  if (jobs_ == nullptr) return;
  const auto mark = std::ranges::find(caller_.objects, kMark, &ImageObject::name);
  if (mark == caller_.objects.end() || mark->bytes != 2 * sizeof(std::uint64_t))
    jobs_ = nullptr;  // it calls no jobs
  else
    mark_ = mark->begin.value;
}

bool JobCalls::begin() {
  SC_ASSERT(!under_way_, "{} calls a job within a job", caller_.name);
  const std::byte* const mark = local_store_.base() + mark_;
  under_way_ = true;
  job_ = jobs_->on_job_begin({doubleword(mark)}, {doubleword(mark + sizeof(std::uint64_t))});
  last_job_end_ = job_ != nullptr ? job_->sizes.end : stack_limit();
  frames_begin_ =
      std::min((preferred_word(state_.registers[CheckedObserver::kStackRegister]) & dma::kLocalStoreMask) +
                   kSharedFrameBytes,
               caller_.stack_top);
  variables_before_.assign(variables().begin(), variables().end());
  frames_before_.assign(frames().begin(), frames().end());
  fill_canary();
  return true;
}

bool JobCalls::end() {
  SC_ASSERT(under_way_, "{} comes back from no job", caller_.name);
  if (auto broken = jobs_->on_job_returned()) {
    fault_ = std::move(*broken);
    return false;
  }
  if (job_ != nullptr && !std::ranges::all_of(canary(), [](std::byte b) { return b == kFiller; })) {
    return fail(dma::Rule::kStackOverflow, "bytes below the stack were written; the image declares " +
                                               std::to_string(job_->sizes.stack) + " bytes of stack");
  }
  if (auto changed = changed_part()) return fail(dma::Rule::kOutsideObjects, std::move(*changed));
  under_way_ = false;
  job_ = nullptr;
  fill_canary();  // where the job had its stack
  jobs_->on_job_end();
  return true;
}

bool JobCalls::fail(dma::Rule rule, std::string detail) {
  fault_ = dma::Fault{.rule = rule, .detail = std::move(detail)};
  return false;
}

std::uint32_t JobCalls::stack_limit() const {
  const std::uint32_t stacks = caller_.sizes.stack + (job_ == nullptr ? 0 : job_->sizes.stack);
  return caller_.stack_top - std::min(caller_.stack_top, stacks);
}

std::span<std::byte> JobCalls::canary() const {
  const std::uint32_t end = stack_limit();
  const std::uint32_t begin = std::min(end, std::max(last_job_end_, end - std::min(end, kCanaryBytes)));
  return {local_store_.base() + begin, local_store_.base() + end};
}

void JobCalls::fill_canary() { dma::fill_local_store(canary().data(), kFiller, canary().size()); }

std::span<const std::byte> JobCalls::variables() const {
  return {local_store_.base() + caller_.data_begin, caller_.sizes.end - caller_.data_begin};
}

std::span<const std::byte> JobCalls::frames() const {
  return {local_store_.base() + frames_begin_, caller_.stack_top - frames_begin_};
}

/// Nobody but the job can have changed them: they would fail later, in any way at all.
std::optional<std::string> JobCalls::changed_part() const {
  struct Part {
    const char* name;
    std::span<const std::byte> now, before;
  };
  const std::span<const std::byte> code(local_store_.base() + caller_.begin,
                                        caller_.data_begin - caller_.begin);
  const Part parts[] = {{"instructions or constants", code, std::span(caller_.bytes).first(code.size())},
                        {"variables", variables(), variables_before_},
                        {"stack", frames(), frames_before_}};
  for (const Part& part : parts) {
    const auto [now, before] = std::ranges::mismatch(part.now, part.before);
    if (now == part.now.end()) continue;
    return "the job wrote to local-store address " +
           base::hex(static_cast<std::size_t>(std::to_address(now) - local_store_.base()), 5) +
           ", where kernel " + caller_.name + ", which has called it, has its " + part.name;
  }
  return std::nullopt;
}

}  // namespace softcell::ls_sim::interpreter
