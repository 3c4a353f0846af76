// What `spu run` and `spu explore` are told: buffers, arguments and how they are refused.

#include "kernel_runs/kernel_task.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "kernel_runs/kernel_buffers.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"
#include "verb/deadline.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

std::uint64_t number(const std::string& text) { return std::get<std::uint64_t>(parse_argument(text)); }

TEST(KernelTask, ReadsNumbersAsSixtyFourBits) {
  EXPECT_EQ(number("0"), 0u);
  EXPECT_EQ(number("4096"), 4096u);
  EXPECT_EQ(number("0x1F"), 31u);
  EXPECT_EQ(number("0xFFFFFFFFFFFFFFFF"), 0xFFFFFFFFFFFFFFFFu);
  EXPECT_EQ(number("-1"), 0xFFFFFFFFFFFFFFFFu);
  EXPECT_EQ(number("-9223372036854775808"), 0x8000000000000000u);
  EXPECT_EQ(number("f32:1.5"), 0x3FC00000u);
  EXPECT_EQ(number("f32:-2"), 0xC0000000u);
  EXPECT_EQ(number("f32:1e-3"), 0x3A83126Fu);
}

TEST(KernelTask, ReadsReferencesToBuffers) {
  EXPECT_EQ(std::get<AddressOf>(parse_argument("@x")).buffer, "x");
  EXPECT_EQ(std::get<SizeOf>(parse_argument("#long_name2")).buffer, "long_name2");
}

TEST(KernelTask, ReadsBuffers) {
  const BufferSpec in = parse_file_buffer(BufferSpec::kIn, "x=a=b:c.bin");
  EXPECT_EQ(in.name, "x");
  EXPECT_EQ(in.file, "a=b:c.bin");
  const BufferSpec out = parse_out_buffer("y=c:/y.bin:16K");
  EXPECT_EQ(out.direction, BufferSpec::kOut);
  EXPECT_EQ(out.file, "c:/y.bin");
  EXPECT_EQ(out.bytes, 16384u);
  EXPECT_EQ(parse_out_buffer("y=f:0x20").bytes, 32u);
  EXPECT_EQ(parse_out_buffer("y=f:2M").bytes, 2u << 20);
}

TEST(KernelTask, ReadsMailboxValuesAndDeadlines) {
  EXPECT_EQ(parse_mbox_value("0xFFFFFFFF"), 0xFFFFFFFFu);
  EXPECT_EQ(parse_deadline("2.5"), std::chrono::milliseconds(2500));
}

class KernelTaskRefuses : public testing::TestWithParam<const char*> {};

TEST_P(KernelTaskRefuses, AsAnArgument) { EXPECT_THROW(parse_argument(GetParam()), UsageError); }

INSTANTIATE_TEST_SUITE_P(Words, KernelTaskRefuses,
                         testing::Values("", "@", "#", "@1x", "f32:", "f32:x", "f32:1e60", "0x", "12x", "1.5",
                                         "18446744073709551616", "-9223372036854775809", "--1", " 1"));

TEST(KernelTask, RefusesBuffersThatItCannotRead) {
  for (const char* text : {"", "x", "=f", "x=", "1x=f", "x y=f"})
    EXPECT_THROW(parse_file_buffer(BufferSpec::kIn, text), UsageError) << text;
  for (const char* text : {"y=f", "y=f:", "y=f:0", "y=f:x", "y=:16", "y=f:-1", "y=f:99999999999M", "y=f:16k"})
    EXPECT_THROW(parse_out_buffer(text), UsageError) << text;
  for (const char* text : {"", "-1", "0x100000000", "x"})
    EXPECT_THROW(parse_mbox_value(text), UsageError) << text;
  for (const char* text : {"", "0", "-1", "nan", "inf", "1e9", "soon"})
    EXPECT_THROW(parse_deadline(text), UsageError) << text;
}

TEST(KernelTask, RefusesWhatDoesNotFitTogether) {
  const BufferSpec x = parse_file_buffer(BufferSpec::kIn, "x=f"), y = parse_out_buffer("y=f:16");
  EXPECT_NO_THROW(check({.buffers = {x, y}, .arguments = {AddressOf{"x"}, SizeOf{"y"}}}));
  EXPECT_THROW(check({.buffers = {x, x}}), UsageError);
  EXPECT_THROW(check({.buffers = {y, parse_out_buffer("z=f:16")}}), UsageError);
  EXPECT_THROW(check({.buffers = {x}, .arguments = {AddressOf{"y"}}}), UsageError);
  EXPECT_THROW(check({.buffers = {x}, .arguments = {SizeOf{"y"}}}), UsageError);
  EXPECT_THROW(check({.in_mbox = {1, 2, 3, 4, 5}}), UsageError);
}

TEST(KernelBuffers, HoldTheFilesAtLinesOf128Bytes) {
  const tests::ScratchFolder folder;
  std::ofstream(folder / "x.bin") << "twenty bytes of text";
  const KernelTask task{.buffers = {parse_file_buffer(BufferSpec::kIn, "x=" + (folder / "x.bin")),
                                    parse_out_buffer("y=" + (folder / "y.bin") + ":40")},
                        .arguments = {AddressOf{"x"}, SizeOf{"x"}, AddressOf{"y"}, std::uint64_t{7}}};
  dma::AddressSpace memory;
  KernelBuffers buffers(memory, task);

  ASSERT_EQ(buffers.slots().size(), 2u);
  const auto& x = buffers.slots()[0].memory;
  const auto& y = buffers.slots()[1].memory;
  EXPECT_EQ(x.size_bytes(), 20u);
  EXPECT_EQ(x.ea().value % 128, 0u);
  EXPECT_EQ(memory.mapping_at(x.ea())->spe_access, dma::SpeAccess::kRead);
  EXPECT_EQ(memory.mapping_at(y.ea())->spe_access, dma::SpeAccess::kReadWrite);

  const ls_sim::EntryArguments arguments = buffers.arguments(3);
  EXPECT_EQ(arguments.spe_id, 3u);
  EXPECT_EQ(arguments.envp, 4u);
  const auto words = memory.resolve({arguments.argp}, 32, dma::SpeAccess::kRead);
  const auto* word = reinterpret_cast<const std::uint64_t*>(std::get<std::byte*>(words));
  EXPECT_EQ(word[0], x.ea().value);
  EXPECT_EQ(word[1], 20u);
  EXPECT_EQ(word[2], y.ea().value);
  EXPECT_EQ(word[3], 7u);
}

TEST(KernelBuffers, WithoutArgumentsArgpIsZero) {
  const KernelTask task;
  dma::AddressSpace memory;
  EXPECT_EQ(KernelBuffers(memory, task).arguments(0).argp, 0u);
}

TEST(KernelBuffers, AreWrittenToTheirFilesAndResetBetweenRuns) {
  const tests::ScratchFolder folder;
  std::ofstream(folder / "x.bin") << "before";
  const KernelTask task{.buffers = {parse_file_buffer(BufferSpec::kInOut, "x=" + (folder / "x.bin")),
                                    parse_out_buffer("y=" + (folder / "y.bin") + ":3")}};
  dma::AddressSpace memory;
  KernelBuffers buffers(memory, task);
  const auto write = [&](std::size_t slot, const std::string& text) {
    const auto ea = buffers.slots()[slot].memory.ea();
    auto* host = std::get<std::byte*>(memory.resolve(ea, text.size(), dma::SpeAccess::kWrite));
    std::memcpy(host, text.data(), text.size());
  };
  const auto contents = [&](const std::string& name) { return test::text_of(folder / name); };
  write(0, "after!");
  write(1, "new");
  OutputFiles files(written_files(task));
  buffers.write_files(files);
  EXPECT_EQ(contents("x.bin"), "before") << "until all are committed";
  files.commit();
  EXPECT_EQ(contents("x.bin"), "after!");
  EXPECT_EQ(contents("y.bin"), "new");

  buffers.reset();
  EXPECT_EQ(buffers.slots()[0].memory[0], std::byte{'b'});
  EXPECT_EQ(buffers.slots()[1].memory[0], std::byte{0});
}

TEST(KernelBuffers, RefuseFilesThatAreNone) {
  const tests::ScratchFolder folder;
  std::ofstream(folder / "empty.bin");
  dma::AddressSpace memory;
  const auto refusal = [&](BufferSpec spec) -> std::string {
    const KernelTask task{.buffers = {std::move(spec)}};
    try {
      KernelBuffers(memory, task);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  };
  const auto in = [&](const std::string& file) { return parse_file_buffer(BufferSpec::kIn, "x=" + file); };
  EXPECT_NE(refusal(in(folder / "none.bin")).find("there is no such file"), std::string::npos);
  EXPECT_NE(refusal(in(folder / "empty.bin")).find("empty"), std::string::npos);
  EXPECT_NE(refusal(in(folder.path().string())).find("it is a directory"), std::string::npos);
  EXPECT_NE(refusal(parse_out_buffer("y=f:300M")).find("does not fit"), std::string::npos);
}

}  // namespace
}  // namespace softcell::tool
