// Kernels built for the SPU, as images and as jobs that go wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "job_chain.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/spu_kernels/images.h"
#include "softcell/spu_kernels/load_kernel.h"
#include "transfers_job.h"

namespace softcell {
namespace {

using ls_sim::KernelImage;
using ls_sim::Machine;

KernelImage spu_kernel(const std::string& name) {
  return spu_kernels::load_kernel(name, false, Machine::kSpu);
}

TEST(SpuElf, EveryKernelDeclaresTheSameOnBothMachinesAndFits) {
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files()) {
    if (file.spu_elf.empty()) continue;  // kernels.py check tells of it
    SCOPED_TRACE(file.name);
    const KernelImage host = ls_sim::load_image(file.name, file.elf),
                      spu = spu_kernel(std::string(file.name));
    EXPECT_EQ(spu.machine, Machine::kSpu);
    EXPECT_EQ(spu.sizes.stack, host.sizes.stack);
    EXPECT_EQ(spu.sizes.budget, host.sizes.budget);
    EXPECT_EQ(spu.begin, host.begin);
    EXPECT_EQ(spu.stack_top, host.stack_top);
    EXPECT_LE(spu.sizes.total(), spu.sizes.budget);
    EXPECT_NE(spu.main, spu.entry) << "start-up code calls main";
  }
}

/// The file of `transfers` with another word in its declaration, which begins "SCK2".
std::string refusal_of_declaration(std::size_t word, std::uint32_t value) {
  const auto file = spu_kernels::spu_image_file("transfers");
  std::vector<std::byte> bytes(file.begin(), file.end());
  constexpr char kMagic[] = {'S', 'C', 'K', '2'};
  const auto magic = std::as_bytes(std::span(kMagic));
  const auto declaration = std::search(bytes.begin(), bytes.end(), magic.begin(), magic.end());
  const std::uint32_t swapped = __builtin_bswap32(value);
  std::memcpy(std::to_address(declaration) + 4 * word, &swapped, sizeof swapped);
  try {
    ls_sim::load_spu_program("transfers", bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "taken";
}

TEST(SpuElf, ADeclarationThatCannotBeIsRefused) {
  EXPECT_EQ(refusal_of_declaration(0, 0x53434B31),
            "SPU program transfers: its .softcell.kernel section is of another version of "
            "softcell_add_spu_kernel");
  EXPECT_EQ(
      refusal_of_declaration(1, 24),
      "SPU program transfers: its declared stack of 24 bytes is not a positive multiple of 16 that fits "
      "beside the image in 256 KB");
  EXPECT_NE(refusal_of_declaration(1, 256 * 1024).find("its declared stack of 262144 bytes"),
            std::string::npos);
  EXPECT_EQ(refusal_of_declaration(3, 0x1000),
            "SPU program transfers: its sections do not end where _end says");
  EXPECT_EQ(refusal_of_declaration(5, 0x81), "SPU program transfers: its main at 129 is no instruction");
}

TEST(SpuElf, AProgramOfItsOwnBeginsInItsStartUpCode) {
  dma::AddressSpace memory;
  constexpr dma::ElementRun kRecord[] = {{8, 8}, {120, 4}};
  dma::Buffer<std::uint32_t> data(memory, "data", 256);
  dma::Buffer<spu::TransfersJob> job(memory, "job", 1, {.record = kRecord});
  job[0] = {data.ea().value, 128, 8, 8, spu::kTransferGet, {}};
  const KernelImage image = spu_kernel("transfers");
  ls_sim::SpeGroup spes(memory, {.spes = 1});
  for (const ls_sim::EntryState state : {ls_sim::EntryState::kLibspe2, ls_sim::EntryState::kThreadGroup}) {
    spes.start(0, image, {.argp = job.ea().value, .entry_state = state});
    EXPECT_EQ(spes.wait(0).stop_code, 0x2000u);
  }
  job[0].in_flight = 17;
  spes.start(0, image, {.argp = job.ea().value});
  EXPECT_EQ(spes.wait(0).stop_code, 0x2000u + spu::kTransfersTooManyInFlight) << "main's status";
}

// Instruction words. [SPU-ISA] documented
std::uint32_t ila(std::uint32_t rt, std::uint32_t immediate) { return 0x42000000u | immediate << 7 | rt; }
std::uint32_t stqd(std::uint32_t rt, std::uint32_t ra) { return 0x24000000u | ra << 7 | rt; }
constexpr std::uint32_t kReturn0[] = {0x40800003u /* il $3,0 */, 0x35000000u /* bi $0 */};

/// A system whose jobs' main is made of these words, and returns 0 behind them.
struct BrokenJobs {
  explicit BrokenJobs(const std::vector<std::uint32_t>& words) {
    std::byte* at = kernel.bytes.data() + (kernel.main - kernel.begin);
    const auto put = [&](std::uint32_t word) {
      const std::uint32_t swapped = __builtin_bswap32(word);
      std::memcpy(at, &swapped, sizeof swapped);
      at += sizeof swapped;
    };
    for (const std::uint32_t word : words) put(word);
    for (const std::uint32_t word : kReturn0) put(word);
  }

  /// The failure of a first job that does as its words say. The same system runs a second one: loops that a job has broken start anew.
  std::string failure() {
    const ppu::JobImage broken = jobs.load(kernel), whole = jobs.load(sound);
    std::string message = "none";
    ppu::JobChain chain(jobs, "jobs", 1);
    constexpr dma::ElementRun kRecord[] = {{8, 8}, {120, 4}};
    const dma::Buffer<std::uint32_t> data(memory, "data", 256);
    dma::Buffer<spu::TransfersJob> job(memory, "job", 1, {.record = kRecord});
    job[0] = {data.ea().value, 128, 8, 8, spu::kTransferGet, {}};
    for (const ppu::JobImage& image : {broken, whole}) {
      chain.clear();
      chain.add({image, job.ea()});
      chain.kick();
      chain.wait();
      if (&image.kernel() == &sound) {
        EXPECT_TRUE(chain.failures().empty());
      } else if (!chain.failures().empty()) {
        message = chain.failures().front().message;
      }
    }
    return message;
  }

  dma::AddressSpace memory;
  const KernelImage job_loop = spu_kernel("job_loop"), sound = spu_kernel("transfers");
  KernelImage kernel = sound;
  ppu::JobSystem jobs{memory, {.spes = 1}, job_loop};
};

TEST(SpuElfJobs, EndWell) { EXPECT_EQ(BrokenJobs({}).failure(), "none"); }

TEST(SpuElfJobs, ThatWriteToTheJobLoopFail) {
  const KernelImage loop = spu_kernel("job_loop");
  const auto failure_of_write_to = [](std::uint32_t address) {
    return BrokenJobs({ila(4, address), stqd(4, 4)}).failure();
  };
  const std::string code = failure_of_write_to(loop.begin + 256);
  EXPECT_NE(code.find("outside-objects"), std::string::npos) << code;
  EXPECT_NE(code.find("has its instructions or constants"), std::string::npos) << code;
  EXPECT_NE(code.find("kernel transfers"), std::string::npos) << code;
  const std::string variables = failure_of_write_to(loop.sizes.end - 16);
  EXPECT_NE(variables.find("has its variables"), std::string::npos) << variables;
  const std::string stack = failure_of_write_to(loop.stack_top - 32);
  EXPECT_NE(stack.find("has its stack"), std::string::npos) << stack;
}

TEST(SpuElfJobs, ThatWriteBelowTheirStackFail) {
  const KernelImage loop = spu_kernel("job_loop"), kernel = spu_kernel("transfers");
  const std::uint32_t limit = loop.stack_top - loop.sizes.stack - kernel.sizes.stack;
  const std::string below = BrokenJobs({ila(4, limit - 16), stqd(4, 4)}).failure();
  EXPECT_NE(below.find("stack-overflow"), std::string::npos) << below;
  EXPECT_NE(below.find("bytes below the stack were written"), std::string::npos) << below;
  EXPECT_EQ(BrokenJobs({ila(4, limit), stqd(4, 4)}).failure(), "none") << "the last quadword of its stack";
}

TEST(SpuElfJobs, ThatExecuteZerosFail) {
  const std::string failure = BrokenJobs({0}).failure();
  EXPECT_NE(failure.find("stop-zero"), std::string::npos) << failure;
}

std::string refusal_of_place(Machine loop_machine, const KernelImage& image) {
  dma::AddressSpace memory;
  const KernelImage loop = spu_kernels::load_kernel("job_loop", false, loop_machine);
  ppu::JobSystem jobs(memory, {.spes = 1}, loop);
  try {
    jobs.load(image);
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  }
  return "taken";
}

TEST(SpuElfJobs, AreBuiltAsTheirLoopIs) {
  EXPECT_EQ(refusal_of_place(Machine::kHost, spu_kernel("skin")),
            "kernel skin is built for the SPU, and the job loop for the host: a job is built as its loop is");
  EXPECT_EQ(refusal_of_place(Machine::kSpu, spu_kernels::load_kernel("skin")),
            "kernel skin is built for the host, and the job loop for the SPU: a job is built as its loop is");
  KernelImage unknown = spu_kernel("skin");
  unknown.main = 0;
  EXPECT_EQ(refusal_of_place(Machine::kSpu, unknown),
            "kernel skin is a program of another kind: build a job with softcell_add_spu_kernel");
}

TEST(SpuElf, AResidentKernelIsOneOfSoftcells) {
  dma::AddressSpace memory;
  ls_sim::SpeGroup spes(memory, {.spes = 1});
  KernelImage unknown = spu_kernel("job_loop");
  unknown.main = 0;
  EXPECT_THROW(spes.start_resident(0, unknown, {}), std::invalid_argument);
}

}  // namespace
}  // namespace softcell
