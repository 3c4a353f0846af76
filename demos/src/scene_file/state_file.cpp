#include "state_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <vector>

#include "document/field_reader.h"
#include "read_common.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::demos {
namespace {

constexpr std::string_view kStateTitle = "softcell state 1";
// Faster than a body that is thrown through a whole scene in one frame.
constexpr double kMaxStateSpeed = 1e5;  // m/s, and rad/s

/// The length of a row of numbers: position and velocity of a particle, or the whole state of a rigid body.
template <int Dimension>
constexpr std::size_t kParticleNumbers = 2 * static_cast<std::size_t>(Dimension);
template <int Dimension>
constexpr std::size_t kRigidNumbers = Dimension == 3 ? 13 : 6;

/// Writes the shortest text that reads back as the same numbers.
void append_numbers(std::string& text, std::span<const float> numbers) {
  fmt::format_to(std::back_inserter(text), "{}\n", fmt::join(numbers, " "));
}

void check_range(std::span<const float> numbers, double most, const std::string& what,
                 std::string_view unit) {
  for (const float number : numbers) {
    if (!(std::abs(double{number}) <= most))
      throw std::runtime_error(
          fmt::format("{} cannot be saved: it has the value {} {}, and a scene has none beyond {}", what,
                      number, unit, most));
  }
}

template <int Dimension>
std::array<float, kRigidNumbers<Dimension>> numbers_of(const typename Beginning<Dimension>::RigidBody& body) {
  if constexpr (Dimension == 3) {
    const auto& [number, p, q, v, w] = body;
    return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  } else {
    const auto& [number, p, angle, v, w] = body;
    return {p.x(), p.y(), angle, v.x(), v.y(), w};
  }
}

/// Splits the text into lines, and a line into words with one space between them.
class StateReader {
 public:
  explicit StateReader(std::string_view text) : text_(text) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error(fmt::format("line {}: {}", number_, what));
  }
  /// Goes on to the next line. @return false: there is none
  bool next_line() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    line_begin_ = at_;
    at_ = end + 1;
    ++number_;
    return true;
  }
  void require_line(const char* expected) {
    if (!next_line()) {
      ++number_;
      refuse(fmt::format("the file ends here; expected {}", expected));
    }
  }
  std::string_view word() {
    const std::size_t end = std::min(line_.find(' '), line_.size());
    const std::string_view word = line_.substr(0, end);
    line_.remove_prefix(std::min(end + 1, line_.size()));
    return word;
  }
  std::uint32_t whole(std::string_view name, std::uint32_t most) {
    const std::string_view text = word();
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > most)
      refuse(fmt::format("{} is '{}'; it must be a whole number from 0 to {}", name, quotable(text), most));
    return value;
  }
  float number(std::string_view name, double most) {
    const std::string_view text = word();
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(std::abs(double{value}) <= most))
      refuse(fmt::format("{} is '{}'; it must be a number from {} to {}", name, quotable(text), -most, most));
    return value;
  }
  void end_line() const {
    if (!line_.empty()) refuse(fmt::format("'{}' was not expected here", quotable(line_)));
  }
  bool is_last() const { return at_ >= text_.size(); }
  std::string_view rest() const { return line_; }
  std::string_view before_line() const { return text_.substr(0, line_begin_); }

 private:
  /// Text from the file in a form that fits into a message.
  static std::string quotable(std::string_view found) { return base::one_line(found.substr(0, 40)); }

  std::string_view text_, line_;
  std::size_t at_ = 0, line_begin_ = 0;
  int number_ = 0;
};

template <int Dimension>
typename Beginning<Dimension>::SoftBody read_particles(StateReader& reader, std::uint32_t count) {
  typename Beginning<Dimension>::SoftBody body;
  for (std::uint32_t i = 0; i < count; ++i) {
    reader.require_line("a particle");
    auto& x = body.positions.emplace_back();
    auto& v = body.velocities.emplace_back();
    for (int axis = 0; axis < Dimension; ++axis) x[axis] = reader.number("a particle's position", kFar);
    for (int axis = 0; axis < Dimension; ++axis)
      v[axis] = reader.number("a particle's velocity", kMaxStateSpeed);
    reader.end_line();
  }
  return body;
}

template <int Dimension>
void read_rest(StateReader& reader, typename Beginning<Dimension>::SoftBody& body) {
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    reader.require_line("a particle's position at rest");
    auto& x = body.rest.emplace_back();
    for (int axis = 0; axis < Dimension; ++axis) x[axis] = reader.number("a position at rest", kFar);
    reader.end_line();
  }
}

template <int Dimension>
typename Beginning<Dimension>::Pin read_pin(
    StateReader& reader, const std::vector<typename Beginning<Dimension>::SoftBody>& bodies) {
  typename Beginning<Dimension>::Pin pin;
  pin.body = reader.whole("the number of a soft body", static_cast<std::uint32_t>(kMaxSoftBodies));
  if (pin.body >= bodies.size())
    reader.refuse(
        fmt::format("a pin of soft body {}; there are {}, counted from 0", pin.body, bodies.size()));
  for (int axis = 0; axis < Dimension; ++axis) pin.point[axis] = reader.number("a pin's point", kFar);
  pin.radius = reader.number("a pin's radius", kFar);
  if (!(pin.radius > 0)) reader.refuse(fmt::format("a pin's radius is {}; it must be above 0", pin.radius));
  const std::size_t count = bodies[pin.body].positions.size();
  while (!reader.rest().empty()) {
    const std::uint32_t particle = reader.whole("a pin's particle", kMaxParticlesOfScene);
    if (particle >= count)
      reader.refuse(
          fmt::format("a pin of particle {}; the soft body has {}, counted from 0", particle, count));
    if (!pin.particles.empty() && particle <= pin.particles.back())
      reader.refuse("the particles of a pin must be in ascending order");
    pin.particles.push_back(particle);
  }
  if (pin.particles.empty()) reader.refuse("a pin needs particles");
  return pin;
}

template <int Dimension>
typename Beginning<Dimension>::RigidBody read_rigid(StateReader& reader) {
  typename Beginning<Dimension>::RigidBody body;
  body.body = reader.whole("the number of a rigid body", static_cast<std::uint32_t>(4 * kMaxRigidBodies));
  for (int axis = 0; axis < Dimension; ++axis)
    body.position[axis] = reader.number("a rigid body's position", kFar);
  if constexpr (Dimension == 3) {
    const auto component = [&reader] { return reader.number("a rigid body's rotation", 1.01); };
    const float w = component(), x = component(), y = component(), z = component();
    body.rotation = Eigen::Quaternionf(w, x, y, z);
    if (!(std::abs(body.rotation.norm() - 1) < 1e-3f))
      reader.refuse(fmt::format("a rigid body's rotation is a quaternion of length {}; it must be 1",
                                body.rotation.norm()));
  } else {
    body.rotation = reader.number("a rigid body's angle", kMaxStateSpeed);
  }
  for (int axis = 0; axis < Dimension; ++axis)
    body.velocity[axis] = reader.number("a rigid body's velocity", kMaxStateSpeed);
  const auto angular = [&reader] { return reader.number("a rigid body's angular velocity", kMaxStateSpeed); };
  if constexpr (Dimension == 3) {
    for (int axis = 0; axis < 3; ++axis) body.angular_velocity[axis] = angular();
  } else {
    body.angular_velocity = angular();
  }
  reader.end_line();
  return body;
}

}  // namespace

std::uint64_t state_checksum(std::string_view lines) { return XXH3_64bits(lines.data(), lines.size()); }

template <int Dimension>
std::string state_to_text(const Beginning<Dimension>& moment) {
  std::string text = fmt::format("{}\ndimension {}\n", kStateTitle, Dimension);
  for (std::size_t b = 0; b < moment.soft_bodies.size(); ++b) {
    const auto& [positions, velocities, rest] = moment.soft_bodies[b];
    SC_ASSERT(positions.size() == velocities.size() && (rest.empty() || rest.size() == positions.size()),
              "{} positions, {} velocities and {} at rest", positions.size(), velocities.size(), rest.size());
    const std::string what = fmt::format("soft body {}", b + 1);
    fmt::format_to(std::back_inserter(text), "soft_body {}", positions.size());
    text += '\n';
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const auto& x = positions[i];
      const auto& v = velocities[i];
      check_range({x.data(), static_cast<std::size_t>(Dimension)}, kFar, what, "m");
      check_range({v.data(), static_cast<std::size_t>(Dimension)}, kMaxStateSpeed, what, "m/s");
      std::array<float, kParticleNumbers<Dimension>> numbers;
      for (int axis = 0; axis < Dimension; ++axis) {
        numbers[static_cast<std::size_t>(axis)] = x[axis];
        numbers[static_cast<std::size_t>(Dimension + axis)] = v[axis];
      }
      append_numbers(text, numbers);
    }
    if (rest.empty()) continue;
    text += "rest_shape\n";
    for (const auto& x : rest) {
      check_range({x.data(), static_cast<std::size_t>(Dimension)}, kFar, what, "m");
      append_numbers(text, {x.data(), static_cast<std::size_t>(Dimension)});
    }
  }
  for (const auto& body : moment.rigid_bodies) {
    const auto numbers = numbers_of<Dimension>(body);
    const std::string what = fmt::format("rigid body {}", body.body);
    check_range({body.position.data(), static_cast<std::size_t>(Dimension)}, kFar, what, "m");
    check_range(numbers, kMaxStateSpeed, what, "m/s or rad/s");
    fmt::format_to(std::back_inserter(text), "rigid_body {} ", body.body);
    append_numbers(text, numbers);
  }
  for (const std::uint32_t number : moment.ended_attachments)
    fmt::format_to(std::back_inserter(text), "ended_attachment {}\n", number);
  for (const auto& pin : moment.pins) {
    const std::size_t axes = Dimension;
    check_range({pin.point.data(), axes}, kFar, "a pin", "m");
    fmt::format_to(std::back_inserter(text), "pin {} {} {} {}\n", pin.body,
                   fmt::join(std::span(pin.point.data(), axes), " "), pin.radius,
                   fmt::join(pin.particles, " "));
  }
  fmt::format_to(std::back_inserter(text), "end {:016x}\n", state_checksum(text));
  return text;
}

template <int Dimension>
Beginning<Dimension> parse_state(std::string_view text) {
  StateReader reader(text);
  reader.require_line("'softcell state 1'");
  if (reader.rest() != kStateTitle)
    reader.refuse("no saved state: a file that begins with 'softcell state 1' is expected");
  reader.require_line("the dimension");
  if (reader.rest() != fmt::format("dimension {}", Dimension))
    reader.refuse(fmt::format("expected 'dimension {}'", Dimension));
  Beginning<Dimension> moment;
  std::uint32_t particles = 0;
  for (;;) {
    reader.require_line("'end' and the checksum");
    const std::string_view kind = reader.word();
    if (kind == "soft_body") {
      if (moment.soft_bodies.size() == kMaxSoftBodies)
        reader.refuse(fmt::format("more than {} soft bodies", kMaxSoftBodies));
      const std::uint32_t count = reader.whole("the number of particles", kMaxParticlesOfScene - particles);
      reader.end_line();
      particles += count;
      moment.soft_bodies.push_back(read_particles<Dimension>(reader, count));
    } else if (kind == "rest_shape") {
      reader.end_line();
      if (moment.soft_bodies.empty() || !moment.soft_bodies.back().rest.empty())
        reader.refuse("a rest shape must follow a soft body's particles");
      read_rest<Dimension>(reader, moment.soft_bodies.back());
    } else if (kind == "rigid_body") {
      auto body = read_rigid<Dimension>(reader);
      if (!moment.rigid_bodies.empty() && body.body <= moment.rigid_bodies.back().body)
        reader.refuse("rigid bodies must be in ascending order");
      moment.rigid_bodies.push_back(body);
    } else if (kind == "ended_attachment") {
      const std::uint32_t number =
          reader.whole("the number of an attachment", static_cast<std::uint32_t>(kMaxAttachments));
      reader.end_line();
      if (!moment.ended_attachments.empty() && number <= moment.ended_attachments.back())
        reader.refuse("attachments must be in ascending order");
      moment.ended_attachments.push_back(number);
    } else if (kind == "pin") {
      if (moment.pins.size() == kMostPins) reader.refuse(fmt::format("more than {} pins", kMostPins));
      moment.pins.push_back(read_pin<Dimension>(reader, moment.soft_bodies));
    } else if (kind == "end") {
      if (!reader.is_last()) reader.refuse("expected nothing behind the line 'end'");
      if (reader.rest() != fmt::format("{:016x}", state_checksum(reader.before_line())))
        reader.refuse("the checksum is wrong: the file was changed, or a part of it is missing");
      return moment;
    } else {
      reader.refuse("expected soft_body, rest_shape, rigid_body, ended_attachment, pin or end");
    }
  }
}

template std::string state_to_text(const Beginning<2>&);
template std::string state_to_text(const Beginning<3>&);
template Beginning<2> parse_state(std::string_view);
template Beginning<3> parse_state(std::string_view);

}  // namespace softcell::demos
