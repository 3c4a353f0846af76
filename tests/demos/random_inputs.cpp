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
#include <vector>

#include "input/recording.h"
#include "random_play.h"
#include "scene/scene_hash.h"
#include "scene_file/scene_library.h"
#include "verb/progress_bar.h"

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

std::filesystem::path file_of(const Options& options, std::uint32_t seed) {
  return options.folder / fmt::format("random_input_{}.rec", seed);
}

/// Says what is wrong with an input, and leaves it.
void complain(const Options& options, std::uint32_t seed, const Recording<2>& recording,
              const std::string& wrong) {
  const auto file = file_of(options, seed);
  write_recording<2>(file, recording);
  fmt::print(stderr, "random_inputs: input {}: {}; see {}\n", seed, wrong, file.string());
}

/// Plays all inputs. @return their recordings; none when one of them failed
std::vector<Recording<2>> play_all(const Scene2d& scene, const Options& options) {
  std::vector<Recording<2>> recordings;
  float farthest = -std::numeric_limits<float>::infinity();
  std::uint32_t failed = 0;
  tool::ProgressBar bar("playing", options.count, false);
  for (std::uint32_t seed = 1; seed <= options.count; ++seed) {
    const Outcome outcome = play(scene, seed, options.gravity);
    farthest = std::max(farthest, outcome.farthest);
    if (outcome.wrong) {
      ++failed;
      complain(options, seed, outcome.recording, *outcome.wrong);
    } else if (options.keep) {
      write_recording<2>(file_of(options, seed), outcome.recording);
    }
    // As it comes back from its file.
    recordings.push_back(parse_recording<2>(to_text(outcome.recording)));
    bar.show(seed);
  }
  fmt::print("{} random inputs of ten seconds, gravity up to {} m/s^2 along each axis: ", options.count,
             options.gravity);
  if (failed > 0) {
    fmt::print("{} failed\n", failed);
    return {};
  }
  fmt::print("nothing left the framework, all stayed {:.4f} m and more inside\n", -farthest);
  return recordings;
}

/// @return whether all recordings end in their states.
bool replay_all(const Scene2d& scene, const Options& options, const std::vector<Recording<2>>& recordings,
                const Way& way) {
  std::uint32_t failed = 0;
  const std::string name = fmt::format("--spes {} --dma {}", way.spes, way.schedule);
  tool::ProgressBar bar(name, recordings.size(), false);
  for (std::uint32_t i = 0; i < recordings.size(); ++i) {
    const std::uint64_t state = replay(scene, recordings[i], way);
    if (state != recordings[i].state_hash) {
      ++failed;
      complain(options, i + 1, recordings[i],
               fmt::format("with {} it ends in the state {:016x}, not in {:016x}", name, state,
                           recordings[i].state_hash));
    }
    bar.show(i + 1);
  }
  fmt::print("replayed with {}: {}\n", name,
             failed == 0 ? "the same states" : fmt::format("{} end in other states", failed));
  std::fflush(stdout);
  return failed == 0;
}

int run(const Options& options) {
  const Scene2d scene = load_scene_2d("man");
  const auto recordings = play_all(scene, options);
  std::fflush(stdout);
  if (recordings.empty()) return 1;
  bool good = true;
  for (const Way& way : kWays) good = replay_all(scene, options, recordings, way) && good;
  return good ? 0 : 1;
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
