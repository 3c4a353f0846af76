#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assisted/assisted_calls.h"
#include "checked_observer.h"
#include "debug_observer.h"
#include "disassembler.h"
#include "engine_channels.h"
#include "image/function_names.h"
#include "job_calls.h"
#include "pipeline.h"
#include "run_loop.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/source_lines.h"

namespace softcell::ls_sim {
namespace {

using namespace interpreter;

constexpr std::uint32_t kStackTop = 0x3FFF0;  // [libspe2, lv2] second-hand
constexpr int kStackRegister = CheckedObserver::kStackRegister,
              kFirstArgument = CheckedObserver::kFirstArgument;

/// A 64-bit argument as main() finds it.
Quadword in_first_doubleword(std::uint64_t value) {
  return from_words(static_cast<std::uint32_t>(value >> 32), static_cast<std::uint32_t>(value), 0, 0);
}

/// Tells two observers, in this order.
template <class First, class Second>
class BothObservers {
 public:
  BothObservers(First first, Second& second) : first_(std::move(first)), second_(second) {}
  void on_instruction(const Operation& op, std::uint32_t pc) {
    first_.on_instruction(op, pc);
    second_.on_instruction(op, pc);
  }
  void on_load(std::uint32_t lsa, std::uint32_t pc) {
    first_.on_load(lsa, pc);
    second_.on_load(lsa, pc);
  }
  void on_store(std::uint32_t lsa, std::uint32_t pc) {
    first_.on_store(lsa, pc);
    second_.on_store(lsa, pc);
  }
  void bring_clock() requires HasClock<Second> { second_.bring_clock(); }

 private:
  First first_;
  Second& second_;
};

class InterpreterEngine final : public Engine {
 public:
  InterpreterEngine(LocalStore& local_store, dma::EffectiveAddress local_store_ea,
                    const InterpreterOptions& options)
      : local_store_(local_store),
        local_store_ea_(local_store_ea),
        debugger_(options.debugger),
        spe_(options.spe) {
    if (options.timer != nullptr && debugger_ == nullptr)
      issue_model_ = std::make_unique<IssueModel>(*options.timer, &state_);
    if (options.host_calls != nullptr) {
      files_ = std::make_unique<assisted::FilesInFolder>(*options.host_calls, stop_wanted_);
      calls_ =
          std::make_unique<assisted::AssistedCalls>(*files_, local_store.bytes(), assisted::CallerKind::kSpu);
    }
    require_vector_units(__builtin_cpu_supports("avx2") != 0, __builtin_cpu_supports("fma") != 0);
  }

  void load(const KernelImage& image) override;
  RunResult run(const EntryArguments& arguments, ChannelPort& channels, AccessObserver* accesses,
                JobObserver* jobs) override;
  dma::LocalStoreAddress position() const override { return {state_.pc}; }
  dma::LocalStoreAddress stack_pointer() const override {
    return {preferred_word(state_.registers[kStackRegister]) & dma::kLocalStoreMask};
  }
  void interrupt() override { stop_wanted_.store(true, std::memory_order_relaxed); }
  std::uint32_t stack_high_water() const override;
  std::uint64_t instructions() const override { return instructions_; }

 private:
  void copy_program();
  void set_entry_state(const EntryArguments& arguments);
  /// The observers of a checked run.
  struct Checks {
    AccessObserver& accesses;
    UndefinedValues values;
  };
  void execute(Core& core, Checks* checks, JobCalls& jobs);
  template <class Observer>
  void run(Core& core, Observer& observer, JobCalls& jobs);
  bool serve_call(const Core& core);
  RunResult result_of(const Core& core, ChannelAccess& access, JobCalls& jobs);
  dma::Fault fault_of(const Core& core, ChannelAccess& access, JobCalls& jobs) const;
  std::string describe(std::uint32_t address) const;
  std::vector<std::string> last_instructions() const;

  LocalStore& local_store_;
  const dma::EffectiveAddress local_store_ea_;
  Debugger* const debugger_;  ///< may be null
  const int spe_;
  const KernelImage* image_ = nullptr;
  bool as_loaded_ = false;  ///< nothing has run since load()
  SpuState state_;
  DecodedStore decoded_;
  std::unique_ptr<IssueModel> issue_model_;  ///< null: nothing is timed
  Trail trail_;
  std::unique_ptr<assisted::FilesInFolder> files_;  ///< null: the host does nothing for programs
  std::unique_ptr<assisted::AssistedCalls> calls_;  ///< null likewise
  std::uint64_t instructions_ = 0;
  std::uint32_t last_job_end_ = 0;  ///< as JobCalls'
  std::atomic<bool> stop_wanted_{false};
};

void InterpreterEngine::load(const KernelImage& image) {
  SC_ASSERT(image.machine == Machine::kSpu, "{} is no program for the SPU", image.name);
  SC_ASSERT(image.begin + image.bytes.size() <= image.sizes.end && image.sizes.end <= dma::kLocalStoreBytes,
            "{} has {} bytes from {} on and ends at {}", image.name, image.bytes.size(), image.begin,
            image.sizes.end);
  image_ = &image;
  dma::fill_local_store(local_store_.base(), kFiller, dma::kLocalStoreBytes);
  copy_program();
  const std::size_t bss = image.begin + image.bytes.size();
  dma::fill_local_store(local_store_.base() + bss, std::byte{0}, image.sizes.end - bss);
  as_loaded_ = true;
  last_job_end_ = 0;
}

void InterpreterEngine::copy_program() {
  dma::copy_to_local_store(local_store_.base() + image_->begin, image_->bytes.data(), image_->bytes.size());
}

void InterpreterEngine::set_entry_state(const EntryArguments& arguments) {
  state_ = SpuState{};
  state_.pc = image_->entry;
  const bool is_libspe2 = arguments.entry_state == EntryState::kLibspe2;
  Quadword* const first = &state_.registers[kFirstArgument];
  first[0] = in_first_doubleword(arguments.spe_id);
  first[1] = in_first_doubleword(arguments.argp);
  first[2] = in_first_doubleword(arguments.envp);
  first[3] = in_first_doubleword(is_libspe2 ? local_store_ea_.value : arguments.fourth);
  // An image above the bottom of the local store has its stack below itself.
  const bool is_above = image_->stack_top != dma::kLocalStoreBytes;
  const std::uint32_t top = is_above ? image_->stack_top - dma::kQuadwordBytes : kStackTop;
  const std::uint32_t used = is_above ? image_->stack_top - image_->sizes.stack : image_->sizes.end;
  const std::uint32_t available = is_libspe2 ? top - std::min(top, used) : 0;
  state_.registers[kStackRegister] = from_words(top, available, 0, 0);
  // The outermost back chain. [SPU ABI] documented
  if (is_above || image_->sizes.end <= top)
    dma::fill_local_store(local_store_.base() + top, std::byte{0}, dma::kQuadwordBytes);
}

RunResult InterpreterEngine::run(const EntryArguments& arguments, ChannelPort& channels,
                                 AccessObserver* accesses, JobObserver* jobs) {
  SC_ASSERT(image_ != nullptr, "run({}) before load()", arguments.spe_id);
  // As with the native engine, a run finds what was linked, and in bss what the last run left.
  if (!std::exchange(as_loaded_, false) && arguments.data_as_linked) copy_program();
  set_entry_state(arguments);
  stop_wanted_.store(false, std::memory_order_relaxed);
  trail_.start(state_.pc);
  if (issue_model_ != nullptr) issue_model_->begin_run(state_.pc);
  StandingSpe standing(state_, local_store_.bytes());
  if (debugger_ != nullptr) debugger_->on_begin(spe_, standing);
  EngineChannels access(state_, channels, accesses != nullptr);
  Core core{.state = state_, .local_store = local_store_.base(), .surroundings = access};
  JobCalls job_calls(*image_, local_store_, state_, jobs);
  std::optional<Checks> checks;
  if (accesses != nullptr) checks.emplace(Checks{*accesses, UndefinedValues(arguments.entry_state)});
  if (calls_ != nullptr && accesses != nullptr)
    calls_->set_listener([accesses](std::uint32_t lsa, std::uint32_t bytes, bool is_store) {
      accesses->on_host_access({lsa}, bytes, is_store);
    });
  do {
    execute(core, checks ? &*checks : nullptr, job_calls);
  } while (serve_call(core));
  if (calls_ != nullptr) calls_->set_listener({});
  if (issue_model_ != nullptr) issue_model_->bring_clock();
  if (debugger_ != nullptr) debugger_->on_end(spe_);
  if (files_ != nullptr) files_->close_all();
  last_job_end_ = job_calls.last_job_end();
  return result_of(core, access, job_calls);
}

void InterpreterEngine::execute(Core& core, Checks* checks, JobCalls& jobs) {
  const SpuArithmetic arithmetic;
  /// Runs with the checks before each instruction, if there are any.
  const auto run_checked = [&](auto& observer) {
    if (checks == nullptr) return run(core, observer, jobs);
    JobAccesses of_jobs(jobs, checks->accesses);
    AccessObserver& accesses = jobs.are_watched() ? of_jobs : checks->accesses;
    BothObservers both(CheckedObserver(state_, checks->values, accesses), observer);
    run(core, both, jobs);
  };
  if (debugger_ != nullptr) {
    DebugObserver observer(state_, *debugger_, spe_, stop_wanted_);
    run_checked(observer);
  } else if (issue_model_ != nullptr) {
    run_checked(*issue_model_);
  } else {
    NoObserver nobody;
    run_checked(nobody);
  }
}

/// Each kind of observer has a loop of its own, so that a program that is not observed runs at full speed.
template <class Observer>
void InterpreterEngine::run(Core& core, Observer& observer, JobCalls& jobs) {
  if (jobs.are_watched()) {
    WithJobs with_jobs(jobs, observer);
    instructions_ += run_until_end(core, decoded_, trail_, stop_wanted_, with_jobs);
  } else {
    instructions_ += run_until_end(core, decoded_, trail_, stop_wanted_, observer);
  }
}

/// Serves a call of the C library. The word after the stop instruction is the call, and execution goes on after it.
/// [libspe2, newlib] second-hand
bool InterpreterEngine::serve_call(const Core& core) {
  const bool is_call = core.ending == Ending::kStop &&
                       (core.stop_code == assisted::kC99Call || core.stop_code == assisted::kPosixCall);
  if (!is_call || calls_ == nullptr) return false;
  calls_->serve(core.stop_code, assisted::CallMemory(local_store_.bytes()).word(state_.pc));
  state_.pc = (state_.pc + 4) & kInstructionMask;
  trail_.add(core.last_pc, state_.pc);
  return true;
}

RunResult InterpreterEngine::result_of(const Core& core, ChannelAccess& access, JobCalls& jobs) {
  RunResult result;
  if (core.ending == Ending::kStop && core.stop_code != 0) {
    result.stop_code = core.stop_code;
    return result;
  }
  result.fault = fault_of(core, access, jobs);
  // A mistake is reported where it was made.
  state_.pc = core.last_pc;
  result.last_instructions = last_instructions();
  return result;
}

dma::Fault InterpreterEngine::fault_of(const Core& core, ChannelAccess& access, JobCalls& jobs) const {
  const std::string where = "the instruction at local-store address " + describe(core.last_pc);
  const auto fault = [](dma::Rule rule, std::string detail) {
    dma::Fault result{rule};
    result.detail = std::move(detail);
    return result;
  };
  switch (core.ending) {
    case Ending::kStop:
      return fault(dma::Rule::kStopZero, where + " is a word of zeros");
    case Ending::kHalt:
      return fault(dma::Rule::kKernelHalt, where + ", a halt-on-condition, found its condition true");
    case Ending::kInterrupted:
      return fault(dma::Rule::kDeadlineExceeded,
                   "the kernel did not end in time; it was at local-store address " + describe(core.last_pc));
    case Ending::kChannelFault:
      if (auto broken = jobs.poll_fault()) return std::move(*broken);
      if (auto broken = access.poll_fault()) return std::move(*broken);
      break;
    default:
      break;
  }
  SC_ASSERT(core.ending == Ending::kInvalid, "a run of {} has ended with {}", image_->name,
            static_cast<int>(core.ending));
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, local_store_.base() + core.last_pc, sizeof bytes);
  return fault(dma::Rule::kIllegalInstruction,
               where + " is " + base::hex(__builtin_bswap32(bytes), 8) + ", which is none of the SPU's");
}

std::string InterpreterEngine::describe(std::uint32_t address) const {
  const std::string function = function_at(*image_, {address});
  return base::hex(address, 5) + (function.empty() ? "" : ", " + function);
}

/// "0x00120  main + 0x20  ai $3,$4,-1  saxpy.cpp:41"
std::vector<std::string> InterpreterEngine::last_instructions() const {
  const SourceLines lines(*image_);
  std::vector<std::string> texts;
  for (const std::uint32_t address : trail_.last(state_.pc)) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, local_store_.base() + address, sizeof bytes);
    std::string text = base::hex(address, 5);
    for (const std::string& part :
         {function_at(*image_, {address}), disassemble(decode(__builtin_bswap32(bytes)), address),
          lines.place_of({address})}) {
      if (!part.empty()) text += "  " + part;
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

std::uint32_t InterpreterEngine::stack_high_water() const {
  if (image_ == nullptr) return 0;
  const std::byte* const base = local_store_.base();
  const std::uint32_t top = image_->stack_top;
  const std::uint32_t free =
      image_->begin < top ? image_->sizes.end : std::min(top, std::max(kEnvironmentBytes, last_job_end_));
  const std::byte* const used =
      std::find_if(base + free, base + top, [](std::byte b) { return b != kFiller; });
  return static_cast<std::uint32_t>(base + top - used);
}

}  // namespace

std::unique_ptr<Engine> make_interpreter_engine(LocalStore& local_store, dma::EffectiveAddress local_store_ea,
                                                const InterpreterOptions& options) {
  return std::make_unique<InterpreterEngine>(local_store, local_store_ea, options);
}

}  // namespace softcell::ls_sim
