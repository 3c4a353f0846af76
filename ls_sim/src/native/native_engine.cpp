#include <pthread.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "assisted/assisted_calls.h"
#include "debugger_symbols.h"
#include "image/job_caller.h"
#include "kernel_context.h"
#include "signals.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "trap_fault.h"

namespace softcell::ls_sim {

void require_vector_units(bool avx2, bool fma) {
  if (avx2 && fma) return;
  throw std::runtime_error(
      std::string("this processor lacks ") +
      (avx2  ? "FMA"
       : fma ? "AVX2"
             : "AVX2 and FMA") +
      ": the native engine needs a processor with AVX2 and FMA (Intel since 2013, AMD since 2015)");
}

namespace {

/// Whether a load from there would succeed. A host that forbids the question says no.
bool can_be_read(std::uint32_t address) {
  std::byte byte{};
  const iovec to{&byte, 1}, from{reinterpret_cast<void*>(std::uintptr_t{address}), 1};
  return process_vm_readv(getpid(), &to, 1, &from, 1, 0) == 1;
}

using native::KernelContext;
using native::Operation;
using native::Told;

constexpr bool is_filler(std::byte b) { return b == kFiller; }
constexpr std::uint32_t kCanaryBytes = 256;  // watched below the declared stack
// Of the gate's frame: its caller's frame pointer and return address.
constexpr std::uint32_t kGateLinkBytes = 16;
constexpr std::size_t kLandingStackBytes = 16 * 1024;

constexpr std::uint32_t number(Channel channel) { return static_cast<std::uint32_t>(channel); }

std::string describe_stack(const ImageSizes& sizes) {
  return "the declared stack has " + std::to_string(sizes.stack) + " bytes";
}

class NativeEngine final : public Engine {
 public:
  NativeEngine(LocalStore& local_store, const NativeOptions& options)
      : local_store_(local_store),
        main_memory_bytes_(options.main_memory_bytes),
        landing_stack_(std::make_unique<std::byte[]>(kLandingStackBytes)) {
    require_vector_units(__builtin_cpu_supports("avx2") != 0, __builtin_cpu_supports("fma") != 0);
    native::install_signal_handlers();
    context_.arena = arena();
    context_.engine = this;
    context_.serve = [](KernelContext* context) noexcept {
      return static_cast<NativeEngine*>(context->engine)->serve_request();
    };
    SC_ASSERT(arena() + dma::kLocalStoreBytes <= std::uint64_t{1} << 32,
              "a local store at {}, which kernels' pointers do not reach", local_store_.base());
    const auto top = reinterpret_cast<std::uintptr_t>(landing_stack_.get()) + kLandingStackBytes;
    context_.landing_stack_top = top & ~std::uintptr_t{15};
    context_.stepper = options.debugger;
    context_.spe = options.spe;
    context_.repeat_what_failed = !debugger_wanted_ && context_.stepper == nullptr;
  }

  void load(const KernelImage& image) override {
    SC_ASSERT(!running_, "{} is loaded while {} runs", image.name, image_->name);
    SC_ASSERT(image.begin >= kEnvironmentBytes && image.begin + image.bytes.size() <= image.sizes.end &&
                  image.sizes.end <= dma::kLocalStoreBytes,
              "{} has {} bytes from {} on and ends at {}", image.name, image.bytes.size(), image.begin,
              image.sizes.end);
    SC_ASSERT(image.data_begin >= image.begin && image.data_end <= image.sizes.end,
              "{} has its data at {} to {}", image.name, image.data_begin, image.data_end);
    image_ = &image;
    debugger_symbols_.reset();
    std::byte* const base = local_store_.base();
    linked_ = image.bytes;
    for (const dma::LocalStoreAddress word : image.relocations)
      relocate_word(linked_, word.value - image.begin);
    native::Environment environment;
    environment.gate = native::gate_below_4_gb();
    dma::copy_to_local_store(base, reinterpret_cast<const std::byte*>(&environment), sizeof environment);
    dma::fill_local_store(base + kEnvironmentBytes, kFiller, dma::kLocalStoreBytes - kEnvironmentBytes);
    dma::copy_to_local_store(base + image.begin, linked_.data(), linked_.size());
    // Another program's data may have come here since these bytes were code last.
    dma::flush_local_store(base + image.begin, image.data_begin - image.begin);
    const std::size_t bss = image.begin + image.bytes.size();
    dma::fill_local_store(base + bss, std::byte{0}, image.sizes.end - bss);
    if (debugger_wanted_) debugger_symbols_ = std::make_unique<native::DebuggerSymbols>(image, base);
    data_as_linked_ = true;
    last_job_end_ = 0;
  }

  RunResult run(const EntryArguments& arguments, ChannelPort& channels, AccessObserver* accesses,
                JobObserver* jobs) override;
  dma::LocalStoreAddress position() const override {
    return {static_cast<std::uint32_t>(context_.caller - arena()) & dma::kLocalStoreMask};
  }
  dma::LocalStoreAddress stack_pointer() const override {
    return {static_cast<std::uint32_t>(context_.stack_pointer - arena()) & dma::kLocalStoreMask};
  }
  void interrupt() override;
  std::uint32_t stack_high_water() const override;

 private:
  /// Converts what a kernel writes as a local-store address: on an SPU it is the same as a pointer, which here lies in the host's
  /// memory.
  std::uint32_t local_store_address(std::uint32_t value) const {
    const std::uint32_t offset = value - static_cast<std::uint32_t>(arena());
    return offset < dma::kLocalStoreBytes ? offset : value;
  }

  std::uintptr_t arena() const { return reinterpret_cast<std::uintptr_t>(local_store_.base()); }
  /// Read it field by field. A copy of the whole in wide pieces would have to wait until the kernel's narrow stores have left the
  /// processor's store queue, which costs as much as the rest of a command.
  const native::Environment& environment() const {
    return *reinterpret_cast<const native::Environment*>(local_store_.base());
  }
  native::Environment& environment() { return *reinterpret_cast<native::Environment*>(local_store_.base()); }
  std::uint32_t stack_limit() const {
    return image_->stack_top - image_->sizes.stack - (job_image_ == nullptr ? 0 : job_image_->sizes.stack);
  }
  std::uint32_t free_begin() const {
    if (image_->program) return stack_limit() - std::min(stack_limit(), kCanaryBytes);  // below lies its heap
    const KernelImage& lowest = job_image_ == nullptr ? *image_ : *job_image_;
    return lowest.begin < stack_limit() ? lowest.sizes.end : std::max(kEnvironmentBytes, last_job_end_);
  }

  /// Relocates a word that holds an address in the image: makes it the address in the host's memory.
  void relocate_word(std::vector<std::byte>& bytes, std::uint32_t offset) const {
    std::uint32_t word = 0;
    SC_ASSERT(bytes.size() >= sizeof word && offset <= bytes.size() - sizeof word, "a relocation at {} of {}",
              offset, bytes.size());
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    word += static_cast<std::uint32_t>(arena());  // which lies below 4 GB
    std::memcpy(bytes.data() + offset, &word, sizeof word);
  }

  void prepare(const EntryArguments& arguments);
  void run_kernel();
  bool serve_request() noexcept;
  std::optional<RunResult> answer();
  std::optional<RunResult> answer_assist();
  std::optional<dma::Fault> tell_of_access();
  std::optional<dma::Fault> mark_job();
  std::optional<dma::Fault> end_job();
  /// Breakpoints of a debugger are written into the code.
  std::optional<dma::Fault> check_caller() const { return caller_.damage(!debugger_wanted_); }
  Access requested_access() const;
  ChannelReply answer_channel();
  std::optional<dma::Fault> check_stack() const;
  std::span<std::byte> canary() const;
  void fill_canary() { dma::fill_local_store(canary().data(), kFiller, canary().size()); }
  bool written_below_stack() const { return !std::ranges::all_of(canary(), is_filler); }
  dma::Fault classify_trap() const;
  dma::Fault cause_of_trap() const;
  std::string describe_damaged_code() const;
  dma::Fault stack_overflow(std::string detail) const;

  static dma::Fault fault(dma::Rule rule, std::string detail) {
    dma::Fault result{rule};
    result.detail = std::move(detail);
    return result;
  }

  LocalStore& local_store_;
  const std::uint64_t main_memory_bytes_;
  std::unique_ptr<std::byte[]> landing_stack_;
  const KernelImage* image_ = nullptr;
  std::vector<std::byte> linked_;           ///< the bytes of image_ as they lie in this local store
  const KernelImage* job_image_ = nullptr;  ///< that image_ has called; null when it is not known
  bool job_under_way_ = false;              ///< also if its image is not known
  std::uint32_t last_job_end_ = 0;  ///< where the image ends that was called last, which stays; 0: none was
  const bool debugger_wanted_ = native::debugger_wanted();
  std::unique_ptr<native::DebuggerSymbols> debugger_symbols_;  ///< of the image; null when nobody debugs
  std::unique_ptr<native::DebuggerSymbols> debugger_job_symbols_;
  bool data_as_linked_ = false;  ///< nothing has run since load()
  JobCaller caller_;             ///< image_, when it called job_image_
  KernelContext context_;
  ChannelPort* channels_ = nullptr;  // these five: of the run
  AccessObserver* accesses_ = nullptr;
  JobObserver* jobs_ = nullptr;
  RunResult result_;
  std::exception_ptr failure_;
  std::uint32_t tag_mask_ = 0;  ///< as last written to the channel; the kernel's is in the environment
  std::mutex running_mutex_;    // guards the two below
  bool running_ = false;
  pthread_t runner_{};
};

void NativeEngine::prepare(const EntryArguments& arguments) {
  SC_ASSERT(image_ != nullptr, "run({}) before load()", arguments.spe_id);
  // The initialised data start every run as they were linked, so that no job sees what another left. Right
  // after load() they are so already, and others may have written to them since.
  if (!std::exchange(data_as_linked_, false) && arguments.data_as_linked) {
    const std::uint32_t data_offset = image_->data_begin - image_->begin;
    dma::copy_to_local_store(local_store_.base() + image_->data_begin, linked_.data() + data_offset,
                             image_->data_end - image_->data_begin);
    SC_ASSERT(linked_.size() <= image_->sizes.end - image_->begin, "{} has {} bytes and ends at {}",
              image_->name, linked_.size(), image_->sizes.end);
    if (image_->program) {  // its bss is zero at the beginning of each run
      dma::fill_local_store(local_store_.base() + image_->begin + linked_.size(), std::byte{0},
                            image_->sizes.end - image_->begin - linked_.size());
    }
  }
  environment().mfc_tag_mask = tag_mask_ = 0;
  job_image_ = nullptr;
  job_under_way_ = false;
  caller_.forget();
  context_.entry = arena() + image_->entry;
  context_.arguments[0] = arguments.spe_id;
  context_.arguments[1] = arguments.argp;
  context_.arguments[2] = arguments.envp;
  context_.arguments[3] = arguments.fourth;
  for (std::size_t i = 0; i < std::size(context_.vectors); ++i) {
    auto& words = context_.vectors[i];
    if (arguments.registers) {
      std::copy_n(arguments.registers->begin() + 4 * static_cast<std::ptrdiff_t>(i), 4, words);
    } else {  // a number of 64 bits is in the first two words, the upper half first
      words[0] = static_cast<std::uint32_t>(context_.arguments[i] >> 32);
      words[1] = static_cast<std::uint32_t>(context_.arguments[i]);
      words[2] = words[3] = 0;
    }
  }
  context_.interrupted = 0;
  context_.landing = 0;
  context_.stepping = 0;
  context_.trap = {};
}

/// Comes back when the run has ended; what the kernel asks for meanwhile is served by serve_request().
void NativeEngine::run_kernel() {
  SC_ASSERT(image_->sizes.stack <= image_->stack_top && image_->stack_top <= dma::kLocalStoreBytes,
            "{} has a stack of {} bytes below {}", image_->name, image_->sizes.stack, image_->stack_top);
  const auto kernel = boost::context::detail::make_fcontext(local_store_.base() + image_->stack_top,
                                                            image_->sizes.stack, native::kernel_start);
  context_.in_kernel = 1;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  native::step(context_, true);
  boost::context::detail::jump_fcontext(kernel, &context_);
  native::step(context_, false);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  context_.in_kernel = 0;
  if (context_.operation() == Operation::kFault) {
    if (const auto call = native::call_outside(context_.trap, local_store_.base()))
      context_.caller = arena() + *call;
    result_ = {0, classify_trap()};
  }
}

RunResult NativeEngine::run(const EntryArguments& arguments, ChannelPort& channels, AccessObserver* accesses,
                            JobObserver* jobs) {
  static thread_local const native::SignalStack signal_stack;  // as long as the thread: a run takes less time
  SC_ASSERT(!running_ && native::current_context() == nullptr, "a run within the run of {}", image_->name);
  SC_ASSERT(!failure_, "SPE {} has an exception that the last run left", arguments.spe_id);
  prepare(arguments);
  native::current_context() = &context_;
  {
    const std::scoped_lock lock(running_mutex_);
    runner_ = pthread_self();
    running_ = true;
  }
  channels_ = &channels;
  accesses_ = accesses;
  jobs_ = jobs;
  run_kernel();
  {
    const std::scoped_lock lock(running_mutex_);
    running_ = false;
  }
  native::current_context() = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::move(result_);
}

void NativeEngine::interrupt() {
  const std::scoped_lock lock(running_mutex_);
  if (running_) pthread_kill(runner_, native::kInterruptSignal);
}

/// Called by the gate, on this thread's own stack below run_kernel().
bool NativeEngine::serve_request() noexcept {
  native::step(context_, false);
  context_.in_kernel = 0;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  try {
    if (auto end = answer()) {
      result_ = std::move(*end);
      return false;
    }
  } catch (...) {  // no exception finds its way through the kernel's frames
    failure_ = std::current_exception();
    return false;
  }
  std::atomic_signal_fence(std::memory_order_seq_cst);
  context_.in_kernel = 1;
  native::step(context_, true);
  return true;
}

/// @return  how the run ends, or nothing when the kernel goes on with context_.reply.
std::optional<RunResult> NativeEngine::answer() {
  SC_ASSERT(image_ != nullptr && channels_ != nullptr, "request {} outside a run", context_.request);
  if (context_.operation() == Operation::kAccess)
    context_.caller = arena() + requested_access().instruction.value;
  if (auto overflow = check_stack()) return RunResult{0, std::move(overflow)};
  if (context_.interrupted != 0)
    return RunResult{0, fault(dma::Rule::kDeadlineExceeded, "the kernel did not end in time")};
  switch (context_.operation()) {
    case Operation::kStop: {
      RunResult end{context_.value & 0x3FFFu, std::nullopt};
      if (!end.ended_normally() && channels_->stop(end.stop_code, {})) return std::nullopt;
      return end;
    }
    case Operation::kAssist:
      return answer_assist();
    case Operation::kHalt:
      return RunResult{
          0, fault(dma::Rule::kKernelHalt, "a halt-on-condition instruction found its condition true")};
    case Operation::kAccess:
      if (auto elsewhere = tell_of_access()) return RunResult{0, std::move(elsewhere)};
      return std::nullopt;
    case Operation::kJob:
      if (auto overflow = mark_job()) return RunResult{0, std::move(overflow)};
      return std::nullopt;
    case Operation::kSync:  // the gate serialises the processor on the way back
      channels_->sync();
      return std::nullopt;
    default:  // of a channel
      break;
  }
  ChannelReply reply = answer_channel();
  if (reply.fault) {
    // If the job has damaged its caller's code, the caller may do anything, such as break a rule here.
    if (job_under_way_)
      if (auto damage = check_caller()) return RunResult{0, std::move(damage)};
    return RunResult{0, std::move(*reply.fault)};
  }
  context_.reply = reply.value;
  return std::nullopt;
}

/// The host serves calls of the C library itself; others are stops for the PPU side.
std::optional<RunResult> NativeEngine::answer_assist() {
  const std::uint32_t code = kAssistedCalls | context_.channel();
  if (code == assisted::kC99Call || code == assisted::kPosixCall) {
    assisted::AssistedCalls calls(assisted::files_of_process(), local_store_.bytes(),
                                  assisted::CallerKind::kHost);
    if (accesses_ != nullptr)
      calls.set_listener([this](std::uint32_t lsa, std::uint32_t bytes, bool is_store) {
        accesses_->on_host_access({lsa}, bytes, is_store);
      });
    context_.reply = calls.serve(code, context_.value);
    return std::nullopt;
  }
  environment().assist = context_.value;
  if (channels_->stop(code, {offsetof(native::Environment, assist)})) return std::nullopt;
  return RunResult{code, std::nullopt, {}};
}

/// Of a checked kernel. What the processor would let pass, and an SPU would not do, ends the run.
std::optional<dma::Fault> NativeEngine::tell_of_access() {
  const auto what = static_cast<Told>(context_.channel());
  if (what == Told::kLoadElsewhere || what == Told::kStoreElsewhere) {
    if (!can_be_read(context_.value)) return std::nullopt;  // the processor stops it
    return fault(
        dma::Rule::kOutsideLocalStore,
        std::string(what == Told::kStoreElsewhere ? "a store to" : "a load from") + " address " +
            base::hex(context_.value, 8) +
            ", which is not in the local store: an SPU reaches the memory of the PPU side by DMA only");
  }
  if (accesses_ == nullptr) return std::nullopt;
  if (what == Told::kHeapBlock || what == Told::kFreedBlock)
    accesses_->on_heap_block(requested_access(), what == Told::kFreedBlock);
  else
    accesses_->on_access(requested_access());
  return std::nullopt;
}

/// The kernel marks that it calls a job, or that the job has returned. A job's image lies at the bottom of the local store, its stack below
/// its caller's.
std::optional<dma::Fault> NativeEngine::mark_job() {
  if (jobs_ == nullptr) return std::nullopt;
  if (context_.channel() == 0) return end_job();
  const native::Environment& environment = this->environment();
  const KernelImage* const last = job_image_;
  job_under_way_ = true;
  job_image_ = jobs_->on_job_begin({environment.job_image_ea}, {environment.job_ea});
  // An image that is not known may end anywhere below its caller's stack.
  last_job_end_ = job_image_ != nullptr ? job_image_->sizes.end : stack_limit();
  tag_mask_ = ~environment.mfc_tag_mask;  // so that the channels get the mask with which the job begins
  // Where the gate returns to, which is another place each time, lies below.
  const auto frames_begin = static_cast<std::uint32_t>(context_.stack_pointer - arena()) + kGateLinkBytes;
  caller_.remember(*image_, linked_, local_store_.base(), frames_begin);
  if (job_image_ == nullptr) return std::nullopt;
  if (debugger_wanted_ && job_image_ != last) {
    debugger_job_symbols_ = std::make_unique<native::DebuggerSymbols>(*job_image_, local_store_.base());
  }
  fill_canary();
  return std::nullopt;
}

std::optional<dma::Fault> NativeEngine::end_job() {
  if (!std::exchange(job_under_way_, false)) {
    return fault(dma::Rule::kIllegalChannel,
                 "the kernel marked the end of a job, and no job was in progress");
  }
  if (auto broken = jobs_->on_job_returned()) return broken;
  if (job_image_ != nullptr && written_below_stack())
    return stack_overflow("bytes below the stack were written");
  if (auto damage = check_caller()) return damage;
  job_image_ = nullptr;
  caller_.forget();
  fill_canary();  // where the job had its stack
  jobs_->on_job_end();
  return std::nullopt;
}

Access NativeEngine::requested_access() const {
  const native::Environment& environment = this->environment();
  return {.lsa = {context_.value & dma::kLocalStoreMask},
          .bytes = environment.access_bytes & dma::kLocalStoreMask,
          .is_store = context_.channel() != 0,
          .instruction = {environment.access_instruction & dma::kLocalStoreMask},
          .stack_pointer = {environment.access_stack_pointer & dma::kLocalStoreMask}};
}

ChannelReply NativeEngine::answer_channel() {
  const native::Environment& environment = this->environment();
  if (context_.request == native::request_of(Operation::kWrite, number(Channel::kMfcCmd))) {
    // Reads the words one by one, as the kernel stored them, because the processor cannot forward two stores to one load. The volatile
    // keeps the compiler from joining two loads.
    const auto word = [](const std::uint32_t& stored) {
      return static_cast<const volatile std::uint32_t&>(stored);
    };
    dma::MfcCommand command{
        .word = context_.value,
        .lsa = {local_store_address(word(environment.mfc_lsa))},
        .ea = {std::uint64_t{word(environment.mfc_eah)} << 32 | word(environment.mfc_eal)},
        .size = word(environment.mfc_size),
        .tag = word(environment.mfc_tag)};
    if (command.kind() == dma::CommandKind::kList)
      command.ea.value =
          (command.ea.value & ~std::uint64_t{UINT32_MAX}) | local_store_address(command.list_address().value);
    return channels_->issue(command);
  }
  if (environment.mfc_tag_mask != tag_mask_) {
    tag_mask_ = environment.mfc_tag_mask;
    ChannelReply reply = channels_->write(number(Channel::kMfcWrTagMask), tag_mask_);
    if (reply.fault) return reply;
  }
  switch (context_.operation()) {
    case Operation::kRead:
      return channels_->read(context_.channel());
    case Operation::kWrite:
      return channels_->write(context_.channel(), context_.value);
    case Operation::kCount:
      return channels_->count(context_.channel());
    case Operation::kTagStatus: {
      ChannelReply reply = channels_->write(number(Channel::kMfcWrTagUpdate), context_.value);
      return reply.fault ? std::move(reply) : channels_->read(number(Channel::kMfcRdTagStat));
    }
    default:
      return {
          0, std::make_unique<dma::Fault>(fault(
                 dma::Rule::kIllegalChannel, "the kernel called the environment with an unknown operation"))};
  }
}

dma::Fault NativeEngine::stack_overflow(std::string detail) const {
  return fault(
      dma::Rule::kStackOverflow,
      std::move(detail) + "; " + describe_stack((job_image_ == nullptr ? image_ : job_image_)->sizes));
}

std::optional<dma::Fault> NativeEngine::check_stack() const {
  const auto pointer = context_.stack_pointer - arena();
  if (pointer < stack_limit())
    return stack_overflow("the stack pointer is at local-store address " + base::hex(pointer, 5));
  if (context_.operation() == Operation::kStop && written_below_stack()) {
    return stack_overflow("bytes below the stack were written");
  }
  return std::nullopt;
}

/// Bytes below the stack of the kernel or job that runs, which it must not write.
std::span<std::byte> NativeEngine::canary() const {
  const std::uint32_t end = stack_limit();
  SC_ASSERT(end <= dma::kLocalStoreBytes, "the stack of {} is limited at {}", image_->name, end);
  const std::uint32_t begin = std::max(free_begin(), end - std::min(end, kCanaryBytes));
  return {local_store_.base() + begin, local_store_.base() + end};
}

dma::Fault NativeEngine::classify_trap() const {
  dma::Fault cause = cause_of_trap();
  cause.detail += describe_damaged_code();
  return cause;
}

/// Says whether code was overwritten, which may be the reason of any other fault. Empty: it was not.
std::string NativeEngine::describe_damaged_code() const {
  const KernelImage* const image = job_under_way_ ? job_image_ : image_;
  if (image == nullptr || debugger_wanted_) return {};  // breakpoints of a debugger are written into the code
  const std::byte* const code = local_store_.base() + image->begin;
  const std::byte* const end = local_store_.base() + image->data_begin;
  const std::vector<std::byte>& linked = image == image_ ? linked_ : image->bytes;
  const std::byte* const damaged = std::mismatch(code, end, linked.begin()).first;
  if (damaged == end) return {};
  return "; the kernel's instructions or constants have been overwritten, from local-store address " +
         base::hex(static_cast<std::uint64_t>(damaged - local_store_.base()), 5) + " on";
}

dma::Fault NativeEngine::cause_of_trap() const {
  const native::Trap& trap = context_.trap;
  const std::byte* const local_store = local_store_.base();
  const std::uintptr_t at = trap.instruction - arena();
  if (trap.stale) {
    return fault(dma::Rule::kStaleInstructions,
                 "the instruction at local-store address " + base::hex(at, 5) +
                     " failed, and did not fail when it was executed once more: the processor ran stale "
                     "instructions, not those that the local store holds");
  }
  if (job_image_ != nullptr) {
    if (auto damage = check_caller()) return *damage;  // the reason, whatever the trap was
  }
  const std::string where = native::place_of(trap, local_store, native::call_outside(trap, local_store));
  if (trap.signal == native::kInterruptSignal) {
    return fault(dma::Rule::kDeadlineExceeded,
                 "the kernel did not end in time; it was at local-store address " + base::hex(at, 5));
  }
  const std::uintptr_t stack = trap.stack - (arena() - LocalStore::kGuardBytes);
  if (stack < LocalStore::kGuardBytes + stack_limit()) {
    return stack_overflow("the stack pointer is " + std::to_string(arena() + stack_limit() - trap.stack) +
                          " bytes below its limit at " + where);
  }
  // A stack that has grown into the kernel's own code may be the reason of any other fault.
  if (written_below_stack())
    return stack_overflow("bytes below the stack were written before " + where + " failed");
  return native::fault_of_instruction(trap, local_store, where, main_memory_bytes_);
}

std::uint32_t NativeEngine::stack_high_water() const {
  if (image_ == nullptr) return 0;
  const std::byte* const base = local_store_.base();
  const std::byte* const top = base + image_->stack_top;
  SC_ASSERT(free_begin() <= image_->stack_top, "the space of {}'s stack begins at {} and ends at {}",
            image_->name, free_begin(), image_->stack_top);
  const std::byte* const used = std::find_if_not(base + free_begin(), top, is_filler);
  return static_cast<std::uint32_t>(top - used);
}

}  // namespace

std::unique_ptr<Engine> make_native_engine(LocalStore& local_store, const NativeOptions& options) {
  return std::make_unique<NativeEngine>(local_store, options);
}

}  // namespace softcell::ls_sim
