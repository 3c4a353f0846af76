#pragma once
// Cancellation, by pthread_cancel(), of threads that wait for SPE contexts.

namespace softcell::ls_sim {

/// While an object of this class exists, the waits of its thread in SpeContexts::wait(), SpeContext::run() and SpeContext::resume() are
/// cancellation points; otherwise they are not. If the thread is cancelled, its run is ended.
class MayBeCancelled {
 public:
  MayBeCancelled();
  ~MayBeCancelled();
  MayBeCancelled(const MayBeCancelled&) = delete;
  MayBeCancelled& operator=(const MayBeCancelled&) = delete;

  /// Whether the calling thread may be cancelled in such waits.
  static bool is_allowed();

 private:
  const bool before_;
};

}  // namespace softcell::ls_sim
