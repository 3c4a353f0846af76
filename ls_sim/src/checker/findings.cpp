#include "softcell/ls_sim/findings.h"

#include <algorithm>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {
namespace {

auto key(const dma::Fault& fault) { return std::tie(fault.rule, fault.kernel, fault.place); }

}  // namespace

bool is_same_mistake(const dma::Fault& a, const dma::Fault& b) { return key(a) == key(b); }

void Findings::add(const dma::Fault& fault) {
  const std::scoped_lock lock(mutex_);
  const auto at =
      std::lower_bound(findings_.begin(), findings_.end(), fault,
                       [](const Finding& f, const dma::Fault& wanted) { return key(f.fault) < key(wanted); });
  if (at != findings_.end() && is_same_mistake(at->fault, fault)) {
    ++at->count;
  } else {
    SC_ASSERT(!fault.kernel.empty(), "a finding of rule {} without its kernel", dma::name(fault.rule));
    findings_.insert(at, Finding{fault, 1});
  }
}

std::vector<Finding> Findings::list() const {
  const std::scoped_lock lock(mutex_);
  return findings_;
}

std::size_t Findings::size() const {
  const std::scoped_lock lock(mutex_);
  return findings_.size();
}

bool Findings::empty() const {
  const std::scoped_lock lock(mutex_);
  return findings_.empty();
}

}  // namespace softcell::ls_sim
