#include "job_calls.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "softcell/base/assert.h"
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
  const std::uint32_t stack_pointer = preferred_word(state_.registers[CheckedObserver::kStackRegister]);
  watched_.remember(caller_, caller_.bytes, local_store_.base(),
                    (stack_pointer & dma::kLocalStoreMask) + kSharedFrameBytes);
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
    fault_ = dma::Fault{.rule = dma::Rule::kStackOverflow,
                        .detail = "bytes below the stack were written; the image declares " +
                                  std::to_string(job_->sizes.stack) + " bytes of stack"};
    return false;
  }
  if (auto damage = watched_.damage(true)) {
    fault_ = std::move(*damage);
    return false;
  }
  watched_.forget();
  under_way_ = false;
  job_ = nullptr;
  fill_canary();  // where the job had its stack
  jobs_->on_job_end();
  return true;
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

}  // namespace softcell::ls_sim::interpreter
