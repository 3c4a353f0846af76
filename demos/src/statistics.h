#pragma once

#include <cstddef>
#include <vector>

namespace softcell::demos {

/// Mean and order statistics of a series of measurements, in the unit of the measurements.
struct Summary {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};

/// All zero for an empty series.
Summary summarize(std::vector<double> samples);

}  // namespace softcell::demos
