#include "all_verbs.h"

#include "bench/bench_verb.h"
#include "bench/body_samples.h"
#include "demo_verb/demo_verbs.h"
#include "report/report_verb.h"
#include "spu/spu_verbs.h"

namespace softcell::tool {

Verbs all_verbs() {
  std::vector<KernelSample> samples(plain_samples().begin(), plain_samples().end());
  samples.insert(samples.end(), body_samples().begin(), body_samples().end());
  Verbs verbs;
  verbs.push_back(demo_verbs());
  verbs.push_back(spu_verbs(samples));
  verbs.push_back(scenes_verb());
  verbs.push_back(bench_verb());
  verbs.push_back(report_verb());
  return verbs;
}

std::span<const std::string_view> left_out_verbs() { return {}; }

}  // namespace softcell::tool
