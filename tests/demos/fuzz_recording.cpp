// libFuzzer target: any bytes give a recording that keeps its promises and is written as it was read, or a
// std::runtime_error. The checksum is put right for a second try, else hardly anything would get past it.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "input/recording.h"

namespace {

using namespace softcell::demos;

void require(bool condition) {
  if (!condition) std::abort();
}

template <int Dimension>
void try_dimension(const std::string& text) {
  try {
    const Recording<Dimension> recording = parse_recording<Dimension>(text);
    std::int64_t frame = 0;
    for (const RecordedEvent<Dimension>& recorded : recording.events) {
      require(recorded.frame >= frame && recorded.frame < recording.frames);
      frame = recorded.frame;
      for (const float value : recorded.event.value) require(std::isfinite(value));
    }
    require(recording.frames <= kMaxRecordedFrames && recording.events.size() <= kMaxRecordedEvents);
    require(recordable_name(recording.scene) == recording.scene);
    require(parse_recording<Dimension>(to_text(recording)) == recording);
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string mended = text + fmt::format("end {:016x}\n", recording_checksum(text));
  for (const std::string& each : {text, mended}) {
    try_dimension<2>(each);
    try_dimension<3>(each);
  }
  return 0;
}
