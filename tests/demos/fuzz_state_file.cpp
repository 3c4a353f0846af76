// libFuzzer target: any bytes give a state that keeps its promises and is written as it was read, or a
// std::runtime_error. The checksum is put right for a second try, else hardly anything would get past it.

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "scene_file/state_file.h"

namespace {

using namespace softcell::demos;

void require(bool condition) {
  if (!condition) std::abort();
}

template <int Dimension>
void try_dimension(const std::string& text) {
  try {
    const Beginning<Dimension> state = parse_state<Dimension>(text);
    for (const auto& body : state.soft_bodies) {
      require(body.positions.size() == body.velocities.size());
      for (const auto& x : body.positions) require(x.allFinite() && x.cwiseAbs().maxCoeff() <= 1e4f);
      for (const auto& v : body.velocities) require(v.allFinite());
    }
    const std::string again = state_to_text(state);
    require(state_to_text(parse_state<Dimension>(again)) == again);
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string mended = text + fmt::format("end {:016x}\n", state_checksum(text));
  for (const std::string& each : {text, mended}) {
    try_dimension<2>(each);
    try_dimension<3>(each);
  }
  return 0;
}
