#include "ppu/bullet/piece_workshop.h"

#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

PieceWorkshop::~PieceWorkshop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  has_changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::vector<PreparedPiece> PieceWorkshop::make(const std::shared_ptr<const SoftBodyModel<3>>& model,
                                               std::span<const std::uint32_t> faces,
                                               const ContactModel* whole) const {
  std::vector<PreparedPiece> made;
  for (PlannedPiece& piece : plan_pieces(model, faces)) {
    prepare_(piece.model);
    std::unique_ptr<ContactModel> contact;
    if (whole != nullptr) contact = std::make_unique<ContactModel>(piece.model, *whole);
    made.push_back({std::move(piece), std::move(contact)});
  }
  return made;
}

std::future<std::vector<PreparedPiece>> PieceWorkshop::begin(std::shared_ptr<const SoftBodyModel<3>> model,
                                                             std::span<const std::uint32_t> faces,
                                                             const ContactModel* whole) {
  SC_ASSERT(model != nullptr, "{} faces of no body break", faces.size());
  Task task([this, model = std::move(model), own = std::vector<std::uint32_t>(faces.begin(), faces.end()),
             whole] { return make(model, own, whole); });
  std::future<std::vector<PreparedPiece>> pieces = task.get_future();
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  {
    const std::lock_guard lock(mutex_);
    tasks_.push(std::move(task));
  }
  has_changed_.notify_one();
  return pieces;
}

void PieceWorkshop::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    has_changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
    if (ends_) return;
    Task task = std::move(tasks_.front());
    tasks_.pop();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace softcell::ppu
