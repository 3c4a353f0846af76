#include "all_verbs.h"

#include <algorithm>
#include <vector>

#include "bench/bench_verb.h"
#include "bench/body_samples.h"
#include "demo_verb/demo_verbs.h"
#include "report/report_verb.h"
#include "run/run_verb.h"
#include "softcell/base/assert.h"
#include "spu/spu_verbs.h"

namespace softcell::tool {

Verbs all_verbs() {
  std::vector<KernelSample> samples(plain_samples().begin(), plain_samples().end());
  samples.insert(samples.end(), body_samples().begin(), body_samples().end());
  SC_ASSERT(samples.size() == plain_samples().size() + body_samples().size(), "{} samples of kernels",
            samples.size());
  Verbs verbs;
  verbs.push_back(demo_verbs());
  verbs.push_back(spu_verbs(samples));
  verbs.push_back(run_verb());
  verbs.push_back(scenes_verb());
  verbs.push_back(bench_verb());
  verbs.push_back(report_verb());
  SC_ASSERT(std::ranges::none_of(verbs, [](const auto& verb) { return verb == nullptr; }),
            "one of {} verbs is none", verbs.size());
  return verbs;
}

std::span<const std::string_view> left_out_verbs() { return {}; }

}  // namespace softcell::tool
