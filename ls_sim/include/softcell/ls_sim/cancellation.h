#pragma once
// Threads that wait for SPE contexts and are cancelled meanwhile, by pthread_cancel().

namespace softcell::ls_sim {

/// While an object of this class exists, the waits of its thread in SpeContexts::wait(), SpeContext::run() and SpeContext::resume() are
/// points at which the thread may be cancelled; else they are none. A run whose thread is cancelled is ended.
class MayBeCancelled {
 public:
  MayBeCancelled();
  ~MayBeCancelled();
  MayBeCancelled(const MayBeCancelled&) = delete;
  MayBeCancelled& operator=(const MayBeCancelled&) = delete;

  /// Of the thread that asks.
  static bool is_allowed();

 private:
  const bool before_;
};

}  // namespace softcell::ls_sim
