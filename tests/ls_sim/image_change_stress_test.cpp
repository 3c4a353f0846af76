// SPEs execute the code that has just arrived: six SPEs change images as fast as they can, in every way in which code
// can come into a local store, while the host moves their threads from processor to processor.
//
// SOFTCELL_STRESS_CHANGES is the number of changes in each way; without it the test takes some seconds.

#include <dirent.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "kernels/stress_code.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"
#include "support/slow_build.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

constexpr int kSpes = 6;

/// The number of changes in each way, by all SPEs together.
std::uint32_t changes(std::uint32_t usual) {
  if (const char* const asked = std::getenv("SOFTCELL_STRESS_CHANGES")) {
    return static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10));
  }
  return kSlowBuild ? usual / 20 : usual;
}

/// Moves all threads of the process from processor to processor while this object lives.
class Migrations {
 public:
  Migrations() : thread_([this] { run(); }) {}
  ~Migrations() {
    stop_ = true;
    thread_.join();
    for_each_task([&](pid_t task) { sched_setaffinity(task, sizeof everywhere_, &everywhere_); });
  }

 private:
  void run() {
    sched_getaffinity(0, sizeof everywhere_, &everywhere_);
    for (unsigned int turn = 0; !stop_; ++turn) {
      unsigned int thread = turn;
      for_each_task([&](pid_t task) { pin(task, thread++); });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// Moves a thread to one of the processors that the process may use.
  void pin(pid_t task, unsigned int number) {
    const auto allowed = static_cast<unsigned int>(CPU_COUNT(&everywhere_));
    unsigned int left = number % allowed;
    for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (!CPU_ISSET(cpu, &everywhere_) || left-- != 0) continue;
      cpu_set_t one;
      CPU_ZERO(&one);
      CPU_SET(cpu, &one);
      sched_setaffinity(task, sizeof one, &one);
      return;
    }
  }
  template <class Visit>
  static void for_each_task(Visit visit) {
    DIR* const tasks = opendir("/proc/self/task");
    if (tasks == nullptr) return;
    while (const dirent* const entry = readdir(tasks)) {
      const pid_t task = std::atoi(entry->d_name);
      if (task > 0) visit(task);
    }
    closedir(tasks);
  }

  cpu_set_t everywhere_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

template <std::size_t... kSeed>
stress::Expected expected_results(std::index_sequence<kSeed...>) {
  stress::Expected expected{};
  for (std::uint32_t input = 0; input < stress::kInputs; ++input) {
    ((expected.of[kSeed][input] = stress::run<kSeed>(input)), ...);
  }
  return expected;
}

class ImageChanges : public testing::Test {
 protected:
  struct Post {
    stress::Task task;
    stress::Expected expected;
  };

  ImageChanges() {
    for (std::uint32_t i = 0; i < stress::kImages; ++i) {
      images_[i] = test_image("stress_" + std::to_string(i));
      std::vector<std::byte>& bytes = images_[i].bytes;
      const std::size_t room = (bytes.size() + 127) / 128 * 128;
      code_.emplace_back(memory_, images_[i].name, room);
      std::ranges::copy(bytes, code_.back().span().begin());
    }
  }

  Post post(stress::Way way, std::uint32_t rounds, std::uint32_t seed) const {
    Post post{.task = {}, .expected = expected_};
    post.task.way = static_cast<std::uint32_t>(way);
    post.task.rounds = rounds;
    post.task.seed = seed;
    post.task.syncs = 1;
    for (std::uint32_t i = 0; i < stress::kImages; ++i) {
      post.task.image_ea[i] = code_[i].ea().value;
      post.task.image_bytes[i] = static_cast<std::uint32_t>(code_[i].span().size());
      post.task.entry[i] = images_[i].entry;
    }
    return post;
  }

  /// Runs `changes_images` on all SPEs. @param arrange  returns the parameters of an SPE
  template <class Arrange>
  void run_residents(const SpeOptions& options, Arrange arrange) {
    const KernelImage resident = test_image("changes_images");
    dma::Buffer<Post> posts(memory_, "posts", kSpes);
    dma::Buffer<stress::Outcome> outcomes(memory_, "outcomes", kSpes);
    SpeGroup group(memory_, options);
    for (int spe = 0; spe < kSpes; ++spe) {
      posts.span()[static_cast<std::size_t>(spe)] = arrange(group, spe);
    }
    {
      const Migrations migrations;
      // In each pair the SPE that receives the puts starts first, so it is loaded before the other puts anything there.
      for (const int spe : {1, 3, 5, 0, 2, 4}) {
        group.start_resident(
            spe, resident,
            {.argp = posts.ea().value + static_cast<std::uint64_t>(spe) * sizeof(Post),
             .envp = outcomes.ea().value + static_cast<std::uint64_t>(spe) * sizeof(stress::Outcome)});
      }
      for (int spe = 0; spe < kSpes; ++spe) {
        const RunResult result = group.wait(spe);
        EXPECT_FALSE(result.fault) << result.fault->message();
        const stress::Outcome& outcome = outcomes.span()[static_cast<std::size_t>(spe)];
        EXPECT_EQ(result.status(), 0u)
            << "SPE " << spe << ", change " << outcome.rounds << ": image " << outcome.image << " made of "
            << outcome.input << " " << outcome.result << ", expected "
            << expected_.of[outcome.image % stress::kImages][outcome.input % stress::kInputs];
      }
    }
  }

  dma::AddressSpace memory_;
  std::array<KernelImage, stress::kImages> images_;
  std::vector<dma::Buffer<std::byte>> code_;
  const stress::Expected expected_ = expected_results(std::make_index_sequence<stress::kImages>());
};

TEST_F(ImageChanges, ByGetsRunWhatHasArrived) {
  run_residents({.spes = kSpes}, [&](SpeGroup&, int spe) {
    return post(stress::Way::kGets, changes(300'000) / kSpes, static_cast<std::uint32_t>(spe) * 77u + 1u);
  });
}

TEST_F(ImageChanges, ByGetsUnderTheRandomScheduleRunWhatHasArrived) {
  run_residents({.spes = kSpes, .schedule = dma::parse_schedule("random:5")}, [&](SpeGroup&, int spe) {
    return post(stress::Way::kGets, changes(60'000) / kSpes, static_cast<std::uint32_t>(spe) * 77u + 2u);
  });
}

TEST_F(ImageChanges, ByListsRunWhatHasArrived) {
  run_residents({.spes = kSpes}, [&](SpeGroup&, int spe) {
    return post(stress::Way::kList, changes(200'000) / kSpes, static_cast<std::uint32_t>(spe) * 77u + 3u);
  });
}

// SPE 0 puts to SPE 1, 2 to 3, 4 to 5: code that another thread has written.
TEST_F(ImageChanges, ByPutsOfAnotherSpeRunWhatHasArrived) {
  run_residents({.spes = kSpes}, [&](SpeGroup& group, int spe) {
    Post pair = post(stress::Way::kPutsOfNeighbour, changes(60'000) / kSpes,
                     static_cast<std::uint32_t>(spe / 2) + 4u);
    pair.task.neighbour = group.problem_state(spe ^ 1).local_store_ea().value;
    pair.task.fetches_only = spe % 2 == 0;
    return pair;
  });
}

// The PPU loads a program, the SPE runs it, and the PPU loads another program in its place.
TEST_F(ImageChanges, ByLoadingRunWhatHasBeenLoaded) {
  SpeGroup group(memory_, {.spes = kSpes});
  const Migrations migrations;
  const std::uint32_t rounds = changes(12'000) / kSpes;
  const auto image_of = [](std::uint32_t round, std::uint32_t spe) {
    return (round + spe) % stress::kImages;
  };
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const std::uint32_t input = round % stress::kInputs;
    for (std::uint32_t spe = 0; spe < kSpes; ++spe) {
      group.start(static_cast<int>(spe), images_[image_of(round, spe)], {.argp = input});
    }
    for (std::uint32_t spe = 0; spe < kSpes; ++spe) {
      const RunResult result = group.wait(static_cast<int>(spe));
      ASSERT_FALSE(result.fault) << result.fault->message();
      ASSERT_EQ(result.status(), expected_.of[image_of(round, spe)][input] & 0xFF)
          << "round " << round << ", SPE " << spe;
    }
  }
}

TEST_F(ImageChanges, ByWritesOfThePpuRunWhatWasWritten) {
  SpeGroup group(memory_, {.spes = kSpes});
  const Migrations migrations;
  const std::uint32_t rounds = changes(12'000) / kSpes;
  // The images must have the same entry: a run is prepared for the first image and executes another one.
  for (const KernelImage& image : images_) ASSERT_EQ(image.entry, images_[0].entry);
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const std::uint32_t input = round % stress::kInputs, written = (round + 1) % stress::kImages;
    for (int spe = 0; spe < kSpes; ++spe) {
      group.prepare(spe, images_[0], {.argp = input});
      group.problem_state(spe).write_local_store({images_[0].begin}, images_[written].bytes);
      group.start(spe);
    }
    for (int spe = 0; spe < kSpes; ++spe) {
      const RunResult result = group.wait(spe);
      ASSERT_FALSE(result.fault) << result.fault->message();
      ASSERT_EQ(result.status(), expected_.of[written][input] & 0xFF) << "round " << round << ", SPE " << spe;
    }
  }
}

}  // namespace
}  // namespace softcell::ls_sim
