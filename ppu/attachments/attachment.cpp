#include "softcell/soft_bodies/attachment.h"
#include "softcell/base/text.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace softcell::ppu {
namespace {

void require(bool holds, const char* name, double value, const char* range) {
  if (holds) return;
  throw std::invalid_argument(std::string("an attachment's ") + name + " is " + base::shortest(value) +
                              "; it must be " + range);
}

}  // namespace

template <int kDimension>
void validate(const AttachmentSettings<kDimension>& s) {
  require(s.compliance >= 0 && std::isfinite(s.compliance), "compliance", double{s.compliance},
          "in m/N, 0 or above, and finite");
  require(s.break_force > 0, "break_force", double{s.break_force}, "in newtons and above 0");
  if (s.length) {
    require(*s.length > 0 && std::isfinite(*s.length), "length", double{*s.length},
            "in metres, above 0, and finite");
    if (s.kind != AttachmentKind::kRope)
      throw std::invalid_argument("an attachment has a length and is no rope; only ropes have one");
  }
  if (s.point && s.kind == AttachmentKind::kWeld)
    throw std::invalid_argument("an attachment has a point and is a weld; only hinges and ropes have one");
  if (s.point && !s.point->allFinite())
    throw std::invalid_argument(
        "an attachment's point is not finite; it must be a place in the world, in metres");
  if (s.kind == AttachmentKind::kHinge && (!s.axis.allFinite() || !(s.axis.norm() > 0)))
    throw std::invalid_argument("a hinge's axis has no direction; it must be finite and longer than 0");
}

template void validate(const AttachmentSettings<2>& settings);
template void validate(const AttachmentSettings<3>& settings);

}  // namespace softcell::ppu
