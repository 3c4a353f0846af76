#include "recording.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"
#include "softcell/base/whole_file.h"

namespace softcell::demos {
namespace {

constexpr int kVersion = 1;
constexpr std::string_view kTitle = "softcell recording";
constexpr std::size_t kMaxSceneName = 255;
// A line is a frame, a name, two numbers of 32 bits and nine floats.
constexpr std::size_t kMaxLine = 220;
constexpr std::size_t kMaxFile = kMaxRecordedEvents * kMaxLine + 4096;

/// How an action is written: its name, then the fields that it uses.
struct ActionSyntax {
  std::string_view name;
  bool hand = false, body = false, value = false, blade = false;
  int lowest_dimension = 2;
};

/// In the order of Action.
constexpr std::array<ActionSyntax, kActions> kSyntax{{
    {.name = "grab", .hand = true, .body = true, .value = true},
    {.name = "move", .hand = true, .value = true},
    {.name = "release", .hand = true},
    {.name = "push", .body = true, .value = true},
    {.name = "gravity", .value = true},
    {.name = "reset"},
    {.name = "pause"},
    {.name = "resume"},
    {.name = "single_step"},
    {.name = "home", .body = true},
    {.name = "tilt", .value = true, .lowest_dimension = 3},
    {.name = "hold", .hand = true, .body = true, .value = true},
    {.name = "hold_rigid", .hand = true, .body = true, .value = true},
    {.name = "time_scale"},
    {.name = "substeps"},
    {.name = "alpha", .body = true},
    {.name = "frequency", .body = true},
    {.name = "modulus", .body = true},
    {.name = "damping", .body = true},
    {.name = "friction", .body = true},
    {.name = "yield", .body = true},
    {.name = "creep", .body = true},
    {.name = "cut", .body = true, .value = true, .blade = true},
    {.name = "pin", .hand = true},
    {.name = "unpin", .body = true},
}};

/// A 32-bit number that has a name.
struct NamedNumber {
  std::string_view name;
  std::uint32_t number;
};
constexpr std::array kHandNames{NamedNumber{"user", kUsersHand}, NamedNumber{"left", kUsersLeftHand},
                                NamedNumber{"right", kUsersRightHand}};
constexpr std::array kBodyNames{NamedNumber{"all", kEveryBody}};

void append_number(std::string& text, std::uint32_t number, std::span<const NamedNumber> names) {
  const auto named = std::ranges::find(names, number, &NamedNumber::number);
  if (named != names.end()) {
    fmt::format_to(std::back_inserter(text), " {}", named->name);
  } else {
    fmt::format_to(std::back_inserter(text), " {}", number);
  }
}

template <int Dimension>
void append_line(std::string& text, const RecordedEvent<Dimension>& recorded) {
  const InputEvent<Dimension>& event = recorded.event;
  const ActionSyntax& syntax = kSyntax.at(static_cast<std::size_t>(event.action));
  SC_ASSERT(Dimension >= syntax.lowest_dimension, "{} in {} dimensions", syntax.name, Dimension);
  fmt::format_to(std::back_inserter(text), "{} {}", recorded.frame, syntax.name);
  if (syntax.hand) append_number(text, event.hand, kHandNames);
  if (syntax.body) append_number(text, event.body, kBodyNames);
  // The shortest text that reads back as the same number.
  const auto append_vector = [&](const auto& vector) {
    for (int i = 0; i < Dimension; ++i) fmt::format_to(std::back_inserter(text), " {}", vector[i]);
  };
  if (syntax.value) append_vector(event.value);
  if (syntax.blade && Dimension == 3) append_vector(event.edge);
  if (syntax.blade) append_vector(event.way);
  if (number_of(event.action) != nullptr) fmt::format_to(std::back_inserter(text), " {}", event.value[0]);
  text += '\n';
}

/// Splits the text into lines, and a line into words with one space between them.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error(fmt::format("line {}: {}", line_number_, what));
  }

  /// Where the line that next_line() read last begins.
  std::size_t line_begin() const { return line_begin_; }
  bool at_end() const { return next_ == text_.size(); }

  void next_line() {
    ++line_number_;
    line_begin_ = next_;
    const std::size_t end = text_.find('\n', next_);
    if (end == std::string_view::npos) refuse("the file ends here, before its line 'end': it was cut off");
    line_ = text_.substr(next_, end - next_);
    next_ = end + 1;
    if (line_.size() > kMaxLine + kMaxSceneName) refuse("is longer than any line of a recording");
  }

  std::string_view rest() { return std::exchange(line_, {}); }

  std::string_view word(std::string_view expected) {
    const std::size_t end = std::min(line_.find(' '), line_.size());
    const std::string_view found = line_.substr(0, end);
    if (found.empty()) refuse(fmt::format("{} is missing", expected));
    line_.remove_prefix(std::min(end + 1, line_.size()));
    return found;
  }

  void key(std::string_view name) {
    if (const std::string_view found = word(name); found != name)
      refuse(fmt::format("'{}' where '{}' belongs", quotable(found), name));
  }

  template <class Integer>
  Integer integer(std::string_view what, Integer low, Integer high) {
    SC_ASSERT(low <= high, "{} is from {} to {}", what, low, high);
    const std::string_view found = word(what);
    Integer value{};
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || end != found.data() + found.size() || value < low || value > high)
      refuse(fmt::format("{} '{}' is not a number from {} to {}", what, quotable(found), low, high));
    return value;
  }

  std::uint64_t hash(std::string_view what) {
    const std::string_view found = word(what);
    std::uint64_t value = 0;
    std::from_chars(found.data(), found.data() + found.size(), value, 16);
    if (fmt::format("{:016x}", value) != found)
      refuse(fmt::format("{} '{}' is not a number of 16 hexadecimal digits", what, quotable(found)));
    return value;
  }

  /// @param names  of the largest numbers; the last of them is the smallest
  std::uint32_t named_number(std::string_view what, std::span<const NamedNumber> names) {
    for (const auto& [name, number] : names) {
      if (line_ == name || line_.starts_with(std::string(name) + ' ')) {
        word(what);
        return number;
      }
    }
    return integer<std::uint32_t>(what, 0, names.back().number - 1);
  }

  float coordinate() {
    const std::string_view found = word("a number");
    float value = 0;
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || end != found.data() + found.size() || !std::isfinite(value))
      refuse(fmt::format("'{}' is no finite number", quotable(found)));
    return value;
  }

  void line_ends() const {
    if (!line_.empty()) refuse(fmt::format("'{}' was not expected here", quotable(line_)));
  }

  /// Text from the file in a form that fits into a message.
  static std::string quotable(std::string_view found) {
    std::string text(found.substr(0, 40));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
  }

 private:
  std::string_view text_, line_;
  std::size_t next_ = 0, line_begin_ = 0;
  int line_number_ = 0;
};

template <int Dimension>
void read_header(Reader& reader, Recording<Dimension>& recording) {
  reader.next_line();
  const std::string_view title = reader.rest();
  if (!title.starts_with(kTitle))
    reader.refuse("this is not a recording: it does not begin with 'softcell recording'");
  if (title.ends_with('\r'))
    reader.refuse("the line ends in CR LF, as of Windows; lines of a recording end in LF");
  if (title != fmt::format("{} {}", kTitle, kVersion)) {
    reader.refuse(fmt::format("a recording of another version, '{}'; this softcell reads '{} {}'",
                              Reader::quotable(title), kTitle, kVersion));
  }
  reader.next_line();
  reader.key("dimension");
  if (const int dimension = reader.integer<int>("the dimension", 2, 3); dimension != Dimension)
    reader.refuse(fmt::format("this is a recording of demo {}d, and this is demo {}d", dimension, Dimension));
  reader.line_ends();
  reader.next_line();
  reader.key("scene");
  const std::string_view scene = reader.rest();
  if (scene.empty() || scene.size() > kMaxSceneName || recordable_name(scene) != scene)
    reader.refuse("the scene has no name, or one with control characters");
  recording.scene = scene;
  reader.next_line();
  reader.key("scene_hash");
  recording.scene_hash = reader.hash("the scene's hash");
  reader.line_ends();
}

template <int Dimension>
InputEvent<Dimension> read_event(Reader& reader) {
  const std::string_view name = reader.word("an action");
  const auto* const found = std::find_if(kSyntax.begin(), kSyntax.end(),
                                         [&](const ActionSyntax& syntax) { return syntax.name == name; });
  if (found == kSyntax.end() || found->lowest_dimension > Dimension)
    reader.refuse(fmt::format("there is no action '{}'", Reader::quotable(name)));
  InputEvent<Dimension> event;
  event.action = static_cast<Action>(found - kSyntax.begin());
  if (found->hand) event.hand = reader.named_number("a hand", kHandNames);
  if (found->body) event.body = reader.named_number("a body", kBodyNames);
  const auto read_vector = [&](auto& vector) {
    for (int i = 0; i < Dimension; ++i) vector[i] = reader.coordinate();
  };
  if (found->value) read_vector(event.value);
  if (found->blade && Dimension == 3) read_vector(event.edge);
  if (found->blade) read_vector(event.way);
  if (const NumberRange* const number = number_of(event.action)) {
    const float value = event.value[0] = reader.coordinate();
    if (value < number->low || value > number->high || (number->whole && value != std::floor(value))) {
      reader.refuse(fmt::format("{} is {}; it must be a {} from {} to {}", name, value,
                                number->whole ? "whole number" : "number", number->low, number->high));
    }
  }
  reader.line_ends();
  return event;
}

}  // namespace

std::string recordable_name(std::string_view name) {
  std::string text(name.substr(0, kMaxSceneName));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '?');
  return text;
}

std::uint64_t recording_checksum(std::string_view lines) { return XXH3_64bits(lines.data(), lines.size()); }

template <int Dimension>
std::string to_text(const Recording<Dimension>& recording) {
  SC_ASSERT(recordable_name(recording.scene) == recording.scene,
            "a scene's name of {} characters cannot be recorded", recording.scene.size());
  SC_ASSERT(std::ranges::is_sorted(recording.events, {}, &RecordedEvent<Dimension>::frame),
            "the {} events of a recording are out of order", recording.events.size());
  SC_ASSERT(recording.events.empty() || recording.events.back().frame < recording.frames,
            "an event of frame {} in a recording of {}", recording.events.back().frame, recording.frames);
  std::string text = fmt::format("{} {}\ndimension {}\nscene {}\nscene_hash {:016x}\n", kTitle, kVersion,
                                 Dimension, recording.scene, recording.scene_hash);
  for (const auto& event : recording.events) append_line(text, event);
  fmt::format_to(std::back_inserter(text), "frames {}\nstate_hash {:016x}\n", recording.frames,
                 recording.state_hash);
  fmt::format_to(std::back_inserter(text), "end {:016x}\n", recording_checksum(text));
  return text;
}

template <int Dimension>
Recording<Dimension> parse_recording(std::string_view text) {
  if (text.size() > kMaxFile) {
    throw std::runtime_error(
        fmt::format("line 1: a file of {} bytes; a recording has at most {}", text.size(), kMaxFile));
  }
  Reader reader(text);
  Recording<Dimension> recording;
  read_header(reader, recording);
  std::int64_t frame = 0;
  constexpr std::string_view kFrames = "frames ";
  for (reader.next_line(); !text.substr(reader.line_begin()).starts_with(kFrames); reader.next_line()) {
    frame = reader.integer<std::int64_t>("the frame", frame, kMaxRecordedFrames - 1);
    if (recording.events.size() == kMaxRecordedEvents)
      reader.refuse(fmt::format("more than {} events", kMaxRecordedEvents));
    recording.events.push_back({frame, read_event<Dimension>(reader)});
  }
  reader.key("frames");
  recording.frames = reader.integer<std::int64_t>(
      "the number of frames", recording.events.empty() ? 0 : frame + 1, kMaxRecordedFrames);
  reader.line_ends();
  reader.next_line();
  reader.key("state_hash");
  recording.state_hash = reader.hash("the state's hash");
  reader.line_ends();
  reader.next_line();
  reader.key("end");
  if (reader.hash("the checksum") != recording_checksum(text.substr(0, reader.line_begin())))
    reader.refuse("the checksum is wrong: the lines above were changed after they were recorded");
  reader.line_ends();
  if (!reader.at_end()) reader.refuse("something follows the last line");
  return recording;
}

template <int Dimension>
void write_recording(const std::filesystem::path& path, const Recording<Dimension>& recording) {
  base::WholeFile file(path);
  file.write(to_text(recording));
  file.commit();
}

template <int Dimension>
Recording<Dimension> read_recording(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = base::read_file(path, kMaxFile);
  try {
    return parse_recording<Dimension>({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const std::runtime_error& refused) {
    throw std::runtime_error(path.string() + ": " + refused.what());
  }
}

#define SOFTCELL_INSTANTIATE(D)                                                        \
  template std::string to_text<D>(const Recording<D>&);                                \
  template Recording<D> parse_recording<D>(std::string_view);                          \
  template void write_recording<D>(const std::filesystem::path&, const Recording<D>&); \
  template Recording<D> read_recording<D>(const std::filesystem::path&)
SOFTCELL_INSTANTIATE(2);
SOFTCELL_INSTANTIATE(3);
#undef SOFTCELL_INSTANTIATE

}  // namespace softcell::demos
