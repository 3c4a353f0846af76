#include "statistics.h"

#include <algorithm>
#include <numeric>

namespace softcell::demos {

Summary summarize(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto rank = [&](double share) {
    return samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1) + 0.5)];
  };
  const double sum = std::accumulate(samples.begin(), samples.end(), 0.0);
  return {sum / static_cast<double>(samples.size()), rank(0.5), rank(0.99), samples.back()};
}

}  // namespace softcell::demos
