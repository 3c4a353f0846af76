#include "job_caller.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

void JobCaller::remember(const KernelImage& image, std::span<const std::byte> linked,
                         const std::byte* local_store, std::uint32_t frames_begin) {
  image_ = &image;
  linked_ = linked;
  local_store_ = local_store;
  frames_begin_ = frames_begin;
  const std::span<const std::byte> variables = this->variables(), frames = this->frames();
  SC_ASSERT(variables.size() <= dma::kLocalStoreBytes, "{} has {} bytes of variables", image.name,
            variables.size());
  variables_before_.assign(variables.begin(), variables.end());
  frames_before_.assign(frames.begin(), frames.end());
}

void JobCaller::forget() {
  image_ = nullptr;
  variables_before_.clear();
  frames_before_.clear();
}

std::span<const std::byte> JobCaller::variables() const {
  return {local_store_ + image_->data_begin, image_->sizes.end - image_->data_begin};
}

std::span<const std::byte> JobCaller::frames() const {
  const std::uint32_t top = image_->stack_top;
  return {local_store_ + std::min(frames_begin_, top), local_store_ + top};
}

std::optional<dma::Fault> JobCaller::damage(bool checks_code) const {
  SC_ASSERT(image_ != nullptr, "a caller that was not remembered, of {} bytes", linked_.size());
  struct Part {
    const char* name;
    std::span<const std::byte> now, before;
  };
  const std::size_t code_bytes = image_->data_begin - image_->begin;
  const Part parts[] = {
      {"instructions or constants", {local_store_ + image_->begin, code_bytes}, linked_.first(code_bytes)},
      {"variables", variables(), variables_before_},
      {"stack", frames(), frames_before_}};
  for (const Part& part : std::span(parts).subspan(checks_code ? 0 : 1)) {
    SC_ASSERT(part.now.size() == part.before.size(), "{} of {}: {} bytes now, {} before the job", part.name,
              image_->name, part.now.size(), part.before.size());
    if (std::memcmp(part.now.data(), part.before.data(), part.before.size()) == 0) continue;
    const std::byte* const at = std::to_address(std::ranges::mismatch(part.now, part.before).in1);
    return dma::Fault{.rule = dma::Rule::kOutsideObjects,
                      .detail = "the job wrote to local-store address " +
                                base::hex(static_cast<std::uint64_t>(at - local_store_), 5) +
                                ", where kernel " + image_->name + ", which has called it, has its " +
                                part.name};
  }
  return std::nullopt;
}

}  // namespace softcell::ls_sim
