#include "kernel_run.h"

#include <chrono>
#include <fstream>
#include <numeric>
#include <span>
#include <stdexcept>

#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"

namespace softcell::zoo {
namespace {

constexpr std::size_t kWords = 64 * 1024 / sizeof(std::uint32_t);

ls_sim::KernelImage load(const KernelCard& card, Build build, ls_sim::Machine machine) {
  const bool is_spu = machine == ls_sim::Machine::kSpu;
  const std::string path = std::string(ZOO_IMAGES) + "/zoo_" + card.kind + "_" + card.name +
                           (is_spu                     ? ".elf"
                            : build == Build::kChecked ? ".checked.spu.elf"
                                                       : ".spu.elf");
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.empty()) throw std::runtime_error("cannot read " + path);
  if (!is_spu) return ls_sim::load_image(card.name, std::as_bytes(std::span(bytes)));
  ls_sim::KernelImage image = ls_sim::load_spu_program(card.name, std::as_bytes(std::span(bytes)));
  image.checked = build == Build::kChecked;
  return image;
}

dma::BufferOptions options_of(const std::string& envp) {
  if (envp == "read-only") return {.spe_access = dma::SpeAccess::kRead};
  if (envp == "write-only") return {.spe_access = dma::SpeAccess::kWrite};
  if (envp == "video") return {.memory = dma::Memory::kVideo};
  if (envp.empty() || envp == "next-spe") return {};
  throw std::runtime_error("no envp " + envp);
}

/// "in_mbox=42", "signal2=42" or "out_mbox=3": as many messages taken.
void act_as_ppu(const std::string& action, ls_sim::ProblemState& spe) {
  const std::size_t equals = action.find('=');
  const auto value = static_cast<std::uint32_t>(std::stoul(action.substr(equals + 1)));
  const std::string what = action.substr(0, equals);
  if (what == "in_mbox") {
    spe.write_in_mbox(value);
  } else if (what == "signal2") {
    spe.write_signal(2, value);
  } else if (what == "out_mbox") {
    for (std::uint32_t i = 0; i < value; ++i) {
      if (!spe.wait_out_mbox()) throw std::runtime_error("the kernel stopped before it wrote its messages");
    }
  } else {
    throw std::runtime_error("the PPU cannot do " + action);
  }
}

}  // namespace

Observation run(const KernelCard& card, Build build, const dma::Schedule& schedule, ls_sim::Machine machine) {
  dma::AddressSpace memory;
  dma::Buffer<std::uint32_t> data(memory, "data", kWords);
  std::iota(data.span().begin(), data.span().end(), 0u);
  dma::Buffer<std::uint32_t> other(memory, "other", kWords, options_of(card.envp));
  const ls_sim::KernelImage image = load(card, build, machine);

  ls_sim::Findings findings;
  ls_sim::SpeOptions options{.spes = card.spes, .schedule = schedule, .clock = ls_sim::Clock::kSimulated};
  if (build == Build::kChecked) options.findings = &findings;
  if (card.deadline_ms > 0) options.deadline = std::chrono::milliseconds(card.deadline_ms);

  Observation observation;
  ls_sim::SpeGroup spes(memory, options);
  {
    const ls_sim::SpeGroup::Outside ppu(spes);
    for (int spe = 0; spe < card.spes; ++spe) {
      const dma::EffectiveAddress envp =
          card.envp == "next-spe" ? spes.problem_state((spe + 1) % card.spes).local_store_ea() : other.ea();
      spes.prepare(spe, image,
                   {.spe_id = static_cast<std::uint64_t>(spe), .argp = data.ea().value, .envp = envp.value});
    }
    for (int spe = 0; spe < card.spes; ++spe) spes.start(spe);
    if (!card.ppu.empty()) act_as_ppu(card.ppu, spes.problem_state(0));
  }
  for (int spe = 0; spe < card.spes; ++spe) observation.results.push_back(spes.wait(spe));
  observation.findings = findings.list();
  return observation;
}

}  // namespace softcell::zoo
