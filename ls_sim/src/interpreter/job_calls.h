#pragma once
// The jobs that a resident kernel built for the SPU calls.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "checked_observer.h"
#include "core.h"
#include "image/job_caller.h"
#include "softcell/dma/fault.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"

namespace softcell::ls_sim::interpreter {

/// Tells an observer where jobs begin and end. A call of code below the resident kernel's image begins a job, whose
/// addresses the kernel has stored in its variable `job_mark` (spu_kernels/common/job_mark.h); the return ends it. Then it checks whether
/// the job has changed what it must not change.
class JobCalls {
 public:
  /// @param caller  the resident kernel  @param jobs  null: jobs are not observed
  JobCalls(const KernelImage& caller, LocalStore& local_store, const SpuState& state, JobObserver* jobs);

  /// Whether a jump begins a job, or ends one.
  bool is_border(std::uint32_t from, std::uint32_t to) const {
    return jobs_ != nullptr && (from < caller_.begin) != (to < caller_.begin);
  }
  /// A jump was taken. @return  false when the run ends, by poll_fault().
  bool on_jump(std::uint32_t from, std::uint32_t to) {
    if (!is_border(from, to)) return true;
    const HostArithmetic host;
    return to < caller_.begin ? begin() : end();
  }

  bool are_watched() const { return jobs_ != nullptr; }
  bool under_way() const { return under_way_; }
  std::optional<dma::Fault> poll_fault() { return std::exchange(fault_, std::nullopt); }
  /// The local store below this has been the image of a job, or may have been; 0: no job was called.
  std::uint32_t last_job_end() const { return last_job_end_; }

 private:
  bool begin();
  bool end();
  std::uint32_t stack_limit() const;
  std::span<std::byte> canary() const;
  void fill_canary();

  const KernelImage& caller_;
  LocalStore& local_store_;
  const SpuState& state_;
  JobObserver* jobs_;
  std::uint32_t mark_ = 0;  ///< local-store address of job_mark
  bool under_way_ = false;
  const KernelImage* job_ = nullptr;  ///< null when it is not known
  std::uint32_t last_job_end_ = 0;
  JobCaller watched_;  ///< caller_, while a job is under way
  std::optional<dma::Fault> fault_;
};

/// Passes everything on to an observer of instructions, and watches where jobs begin and end.
template <class Observer>
class WithJobs {
 public:
  WithJobs(JobCalls& jobs, Observer& observer) : jobs_(jobs), observer_(observer) {}
  void on_instruction(const Operation& op, std::uint32_t pc) { observer_.on_instruction(op, pc); }
  void on_load(std::uint32_t lsa, std::uint32_t pc) { observer_.on_load(lsa, pc); }
  void on_store(std::uint32_t lsa, std::uint32_t pc) { observer_.on_store(lsa, pc); }
  bool on_jump(std::uint32_t from, std::uint32_t to) {
    if constexpr (HasClock<Observer>) {
      if (jobs_.is_border(from, to)) observer_.bring_clock();
    }
    return jobs_.on_jump(from, to);
  }
  void bring_clock() requires HasClock<Observer> { observer_.bring_clock(); }

 private:
  JobCalls& jobs_;
  Observer& observer_;
};

/// Passes on the accesses of jobs, but not those of the kernel that calls them, which is not checked.
class JobAccesses final : public AccessObserver {
 public:
  JobAccesses(const JobCalls& jobs, AccessObserver& to) : jobs_(jobs), to_(to) {}
  void on_access(const Access& access) override {
    if (jobs_.under_way()) to_.on_access(access);
  }
  void on_instruction(const ExecutedInstruction& instruction) override {
    if (jobs_.under_way()) to_.on_instruction(instruction);
  }
  UndefinedBits undefined_bits(dma::LocalStoreAddress quadword) override {
    return jobs_.under_way() ? to_.undefined_bits(quadword) : UndefinedBits{};
  }

 private:
  const JobCalls& jobs_;
  AccessObserver& to_;
};

}  // namespace softcell::ls_sim::interpreter
