#pragma once
// Makes pieces of broken bodies on a thread of its own.

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <queue>
#include <span>
#include <thread>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// A piece with what takes long to make for it.
struct PreparedPiece {
  PlannedPiece piece;
  std::unique_ptr<ContactModel> contact;  ///< null: it is not made ahead
};

/// Used by one thread. Its own thread begins with the first break, and takes one after the other.
class PieceWorkshop {
 public:
  /// What else pieces need. Of any thread; changes no result.
  using Prepare = std::function<void(const std::shared_ptr<const SoftBodyModel<3>>&)>;

  explicit PieceWorkshop(Prepare prepare) : prepare_(std::move(prepare)) {}
  /// Waits for the break that is made; others are given up.
  ~PieceWorkshop();
  PieceWorkshop(const PieceWorkshop&) = delete;
  PieceWorkshop& operator=(const PieceWorkshop&) = delete;

  /// @param whole  of the body that was never broken, for contact models of pieces; null: none are made. Outlives this
  std::future<std::vector<PreparedPiece>> begin(std::shared_ptr<const SoftBodyModel<3>> model,
                                                std::span<const std::uint32_t> faces,
                                                const ContactModel* whole);
  /// The same at once, on the calling thread.
  std::vector<PreparedPiece> make(const std::shared_ptr<const SoftBodyModel<3>>& model,
                                  std::span<const std::uint32_t> faces, const ContactModel* whole) const;

 private:
  using Task = std::packaged_task<std::vector<PreparedPiece>()>;

  void work();

  Prepare prepare_;
  std::mutex mutex_;
  std::condition_variable has_changed_;
  std::queue<Task> tasks_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace softcell::ppu
