// The verbs of a command without demos: nothing here needs a physics engine, a renderer or a mesh.

#include "all_verbs.h"

#include <span>
#include <string_view>
#include "report/report_verb.h"
#include "run/run_verb.h"
#include "spu/spu_verbs.h"

namespace softcell::tool {

Verbs all_verbs() {
  Verbs verbs;
  verbs.push_back(spu_verbs({plain_samples().begin(), plain_samples().end()}));
  verbs.push_back(run_verb());
  verbs.push_back(report_verb());
  return verbs;
}

std::span<const std::string_view> left_out_verbs() {
  static constexpr std::string_view kLeftOut[] = {"demo", "scenes", "bench"};
  return kLeftOut;
}

}  // namespace softcell::tool
