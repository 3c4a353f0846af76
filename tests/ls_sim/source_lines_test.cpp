#include "softcell/ls_sim/source_lines.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "softcell/ls_sim/engine.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

/// Refuses every command, so that the run stops at the first.
class RefusingPort final : public ChannelPort {
 public:
  ChannelReply read(std::uint32_t) override { return {}; }
  ChannelReply write(std::uint32_t, std::uint32_t) override { return {}; }
  ChannelReply count(std::uint32_t) override { return {}; }
  void sync() override {}
  ChannelReply issue(const dma::MfcCommand&) override {
    return {0, std::make_unique<dma::Fault>(dma::Fault{dma::Rule::kSizeZero})};
  }
};

std::string place_of_first_command(const std::string& kernel) {
  const KernelImage image = test_image(kernel);
  LocalStore local_store;
  const auto engine = make_native_engine(local_store);
  engine->load(image);
  RefusingPort port;
  EXPECT_TRUE(engine->run({}, port).fault);
  return SourceLines(image).place_of(engine->position());
}

TEST(SourceLines, NamesTheUsersLineOfACommandThatTheSdkInlined) {
  EXPECT_EQ(place_of_first_command("bad_dma"), "bad_dma.cpp:8");
  EXPECT_EQ(place_of_first_command("no_wait"), "no_wait.cpp:11");
}

TEST(SourceLines, NamesTheLineOfAnInstructionThatFaulted) {
  const KernelImage image = test_image("illegal_instruction");
  LocalStore local_store;
  const auto engine = make_native_engine(local_store);
  engine->load(image);
  RefusingPort port;
  ASSERT_TRUE(engine->run({}, port).fault);
  EXPECT_EQ(SourceLines(image).place_of(engine->position()), "illegal_instruction.cpp:4");
}

TEST(SourceLines, KnowsTheEntryAndGivesTheSameAnswerAgain) {
  const KernelImage image = test_image("echo_arguments");
  const SourceLines lines(image);
  const std::string first = lines.place_of({image.entry});
  EXPECT_EQ(first.substr(0, 19), "echo_arguments.cpp:");
  EXPECT_EQ(lines.place_of({image.entry}), first);
}

TEST(SourceLines, KnowsNothingOutsideTheText) {
  const KernelImage image = test_image("echo_arguments");
  const SourceLines lines(image);
  EXPECT_EQ(lines.place_of({0}), "");
  EXPECT_EQ(lines.place_of({0x3FFF0}), "");
}

TEST(SourceLines, AnImageWithoutAFileGivesEmptyPlaces) {
  KernelImage image = test_image("echo_arguments");
  image.elf = nullptr;
  EXPECT_EQ(SourceLines(image).place_of({image.entry}), "");
}

}  // namespace
}  // namespace softcell::ls_sim
