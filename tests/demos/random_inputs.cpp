// random_inputs COUNT GRAVITY [FOLDER]: plays COUNT random inputs of ten seconds to the scene `man`, with
// gravity of up to GRAVITY m/s^2 along each axis. Nothing may leave the framework. Each input is recorded,
// and its recording must end in the same state for 1 to 6 SPEs and under all kinds of DMA schedules. FOLDER,
// if given, gets the recordings, to be replayed by `softcell demo 2d --replay`; an input that fails is left
// there, or here. Status 0: all is well; 1: not; 2: wrong usage.

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "progress_bar.h"
#include "random_play.h"
#include "recording.h"
#include "scene_file/scene_library.h"
#include "scene_hash.h"

namespace softcell::demos::test {
namespace {

struct Way {
  int spes;
  const char* schedule;
};
/// Each number of SPEs and each kind of schedule.
constexpr std::array<Way, 9> kWays{{{1, "eager"},
                                    {2, "eager"},
                                    {3, "eager"},
                                    {4, "eager"},
                                    {5, "eager"},
                                    {6, "lazy"},
                                    {6, "random:1"},
                                    {4, "random:2"},
                                    {1, "lazy"}}};

struct Options {
  std::uint32_t count = 0;
  float gravity = 0;
  std::filesystem::path folder = ".";
  bool keep = false;  ///< recordings of inputs that do not fail
};

template <class Number>
Number parse_number(std::string_view text, Number high) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value > 0 && value <= high))
    throw std::invalid_argument(fmt::format("'{}' is no number above 0 and up to {}", text, high));
  return value;
}

Options parse(std::span<char*> words) {
  if (words.size() < 3 || words.size() > 4)
    throw std::invalid_argument("usage: random_inputs COUNT GRAVITY [FOLDER]");
  Options options{.count = parse_number<std::uint32_t>(words[1], 1'000'000),
                  .gravity = parse_number<float>(words[2], 1000)};
  if (words.size() == 4) {
    options.folder = words[3];
    options.keep = true;
    std::filesystem::create_directories(options.folder);
  }
  return options;
}

struct Outcome {
  Recording<2> recording;
  float farthest = -std::numeric_limits<float>::infinity();  ///< outside(), of all frames
  std::optional<std::string> wrong;                          ///< something left the framework, or worse
};

Outcome play(const Scene2d& scene, std::uint32_t seed, float gravity) {
  Outcome outcome;
  outcome.recording.scene = scene.name;
  outcome.recording.scene_hash = scene_hash(scene);
  Simulation2d simulation(scene);
  RandomPlay input(seed, gravity);
  for (std::int64_t frame = 0; frame < kTenSeconds && !outcome.wrong; ++frame) {
    try {
      simulation.step(input.next_frame());
    } catch (const std::runtime_error& error) {
      outcome.wrong = fmt::format("frame {} fails: {}", frame, error.what());
    }
    for (const InputEvent<2>& event : simulation.last_events())
      outcome.recording.events.push_back({frame, event});
    outcome.recording.frames = frame + 1;
    const float now = outside(simulation, scene);
    if (now > 0) outcome.wrong = fmt::format("{:.4f} m outside of the framework in frame {}", now, frame);
    outcome.farthest = std::max(outcome.farthest, now);
  }
  outcome.recording.state_hash = simulation.state_hash();
  return outcome;
}

std::uint64_t replay(const Scene2d& scene, const Recording<2>& recording, const Way& way) {
  Simulation2d simulation(scene, {.spes = way.spes, .schedule = dma::parse_schedule(way.schedule)});
  std::vector<InputEvent<2>> events;
  std::size_t next = 0;
  for (std::int64_t frame = 0; frame < recording.frames; ++frame) {
    events.clear();
    for (; next < recording.events.size() && recording.events[next].frame == frame; ++next)
      events.push_back(recording.events[next].event);
    simulation.step(events);
  }
  return simulation.state_hash();
}

/// What is wrong with the input, if anything is; its recording is left then. Raises `farthest`.
std::optional<std::string> try_input(const Scene2d& scene, const Options& options, std::uint32_t seed,
                                     float& farthest) {
  const Outcome outcome = play(scene, seed, options.gravity);
  farthest = std::max(farthest, outcome.farthest);
  std::optional<std::string> wrong = outcome.wrong;
  // As it comes back from its file.
  const auto recording = parse_recording<2>(to_text(outcome.recording));
  for (std::size_t i = 0; i < kWays.size() && !wrong; ++i) {
    const std::uint64_t state = replay(scene, recording, kWays[i]);
    if (state != recording.state_hash)
      wrong = fmt::format("{} SPEs with --dma {} end in the state {:016x}, six in {:016x}", kWays[i].spes,
                          kWays[i].schedule, state, recording.state_hash);
  }
  if (wrong || options.keep) {
    const auto file = options.folder / fmt::format("random_input_{}.rec", seed);
    write_recording<2>(file, outcome.recording);
    if (wrong) return fmt::format("input {}: {}; see {}", seed, *wrong, file.string());
  }
  return std::nullopt;
}

int run(const Options& options) {
  Scene2d scene = load_scene_2d("man");
  float farthest = -std::numeric_limits<float>::infinity();
  std::uint32_t failed = 0;
  ProgressBar bar("random inputs", options.count, false);
  for (std::uint32_t seed = 1; seed <= options.count; ++seed) {
    if (const auto wrong = try_input(scene, options, seed, farthest)) {
      ++failed;
      fmt::print(stderr, "random_inputs: {}\n", *wrong);
    }
    bar.show(seed);
  }
  fmt::print("{} random inputs of ten seconds, gravity up to {} m/s^2 along each axis, each run in {} ways: ",
             options.count, options.gravity, 1 + kWays.size());
  if (failed > 0) {
    fmt::print("{} failed\n", failed);
    return 1;
  }
  fmt::print("nothing left the framework (nearest to its wall: {:.4f} m inside), one state for all ways\n",
             -farthest);
  return 0;
}

}  // namespace
}  // namespace softcell::demos::test

int main(int argc, char** argv) {
  using namespace softcell::demos::test;
  Options options;
  try {
    options = parse({argv, static_cast<std::size_t>(argc)});
  } catch (const std::exception& error) {
    fmt::print(stderr, "random_inputs: {}\n", error.what());
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "random_inputs: {}\n", error.what());
    return 1;
  }
}
