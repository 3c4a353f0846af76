#include "rigid_body.h"

#include <cmath>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// Interpolates between two stops, slowly at both ends.
double eased(double share) { return share * share * (3 - 2 * share); }

Motion::Stop stop_at(const std::vector<Motion::Stop>& stops, double time) {
  Motion::Stop before;
  for (const Motion::Stop& next : stops) {
    if (double{next.time} <= time) {
      before = next;
      continue;
    }
    const auto share =
        static_cast<float>(eased((time - double{before.time}) / (double{next.time} - double{before.time})));
    before.offset += share * (next.offset - before.offset);
    before.angle += share * (next.angle - before.angle);
    break;
  }
  return before;
}

}  // namespace

Placement placement_at(const RigidBody& body, double time) {
  SC_ASSERT(body.motion && body.motion->period > 0, "body '{}' does not move, or in a period of 0 s",
            body.name);
  const Motion& motion = *body.motion;
  const Motion::Stop stop = stop_at(motion.stops, time);
  Placement placement{.position = body.position + stop.offset, .rotation = body.rotation};
  if (!motion.swing.isZero(0))
    placement.position +=
        static_cast<float>(ppu::sine(2 * ppu::kPi * std::fmod(time / double{motion.period}, 1.0))) *
        motion.swing;
  const double half = std::fmod(0.5 * (double{motion.spin} * time + double{stop.angle}), 2 * ppu::kPi);
  if (half != 0) {
    const auto sine = static_cast<float>(ppu::sine(half)), cosine = static_cast<float>(ppu::cosine(half));
    const Eigen::Vector3f turn = sine * motion.axis;
    placement.rotation = Eigen::Quaternionf(cosine, turn.x(), turn.y(), turn.z()) * body.rotation;
    placement.rotation.normalize();
  }
  return placement;
}

}  // namespace softcell::demos
