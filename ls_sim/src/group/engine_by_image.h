#pragma once
// The engine of an SPE, which runs images of either machine.

#include <atomic>
#include <cstdint>
#include <memory>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"

namespace softcell::ls_sim {

/// The engine that the loaded image needs; each is made when the first image needs it, the native one at once.
class EngineByImage final : public Engine {
 public:
  /// @param main_memory_bytes  as in NativeOptions
  EngineByImage(LocalStore& local_store, dma::EffectiveAddress local_store_ea,
                const InterpreterOptions& options, std::uint64_t main_memory_bytes)
      : local_store_(local_store),
        local_store_ea_(local_store_ea),
        options_(options),
        native_(make_native_engine(
            local_store,
            {.debugger = options.debugger, .spe = options.spe, .main_memory_bytes = main_memory_bytes})),
        current_(native_.get()) {}

  /// The engine that an image needs is made here, so that no run allocates it.
  void load(const KernelImage& image) override {
    if (image.machine == Machine::kSpu && interpreter_ == nullptr)
      interpreter_ = make_interpreter_engine(local_store_, local_store_ea_, options_);
    Engine* const engine = image.machine == Machine::kSpu ? interpreter_.get() : native_.get();
    SC_ASSERT(engine != nullptr, "{} is for machine {}, which has no engine", image.name, image.machine);
    current_.store(engine, std::memory_order_release);
    engine->load(image);
  }

  RunResult run(const EntryArguments& arguments, ChannelPort& channels, AccessObserver* accesses,
                JobObserver* jobs) override {
    return current().run(arguments, channels, accesses, jobs);
  }
  dma::LocalStoreAddress position() const override { return current().position(); }
  dma::LocalStoreAddress stack_pointer() const override { return current().stack_pointer(); }
  void interrupt() override { current().interrupt(); }
  std::uint32_t stack_high_water() const override { return current().stack_high_water(); }
  std::uint64_t instructions() const override {
    return interpreter_ == nullptr ? 0 : interpreter_->instructions();
  }

 private:
  Engine& current() const { return *current_.load(std::memory_order_acquire); }

  LocalStore& local_store_;
  const dma::EffectiveAddress local_store_ea_;
  const InterpreterOptions options_;
  const std::unique_ptr<Engine> native_;
  std::unique_ptr<Engine> interpreter_;
  std::atomic<Engine*> current_;  ///< interrupt() may be called while an image is loaded
};

}  // namespace softcell::ls_sim
