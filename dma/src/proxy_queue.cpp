#include "softcell/dma/proxy_queue.h"

#include <string>
#include <utility>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_rules.h"

namespace softcell::dma {
namespace {

constexpr std::uint32_t kStartBit = 0x08;  // of the opcode [CBEA, MFC commands] documented

/// Refuses commands that only the SPU itself can issue.
std::optional<Fault> check_proxy(const MfcCommand& command) {
  const bool is_list = command.kind() == CommandKind::kList;
  if (!is_list && command.kind() != CommandKind::kLine) return std::nullopt;
  return Fault{.rule = Rule::kNotOnProxyQueue,
               .command = command,
               .detail = std::string(name(command.opcode())) +
                         (is_list ? " is a list" : " answers at a channel") +
                         "; only the SPU itself can issue it"};
}

}  // namespace

ProxyQueue::ProxyQueue(LocalStorePort& spe, AddressSpace& space, Schedule schedule,
                       std::uint64_t stream_number, std::function<void()> start_spu)
    : spe_(spe), start_spu_(std::move(start_spu)), mfc_(spe.local_store(), space, schedule, stream_number) {
  SC_ASSERT(start_spu_ != nullptr, "nothing to start the SPU by, in proxy queue {}", stream_number);
  mfc_.set_observer(this);
}

void ProxyQueue::set_big_endian(bool is_big_endian) {
  const std::lock_guard lock(mutex_);
  mfc_.set_big_endian(is_big_endian);
}

// Runs step() with the MFC to itself, then starts the SPU if that has completed a command with start.
template <class Step>
auto ProxyQueue::with_mfc(Step&& step) -> decltype(step()) {
  std::unique_lock lock(mutex_);
  decltype(step()) result{};
  try {
    result = step();
  } catch (StorageLost& lost) {
    drop_all(std::move(lost.fault));
  }
  const int starts = std::exchange(starts_due_, 0);
  lock.unlock();
  for (int i = 0; i < starts; ++i) start_spu_();
  return result;
}

void ProxyQueue::drop_all(Fault&& why) {
  mfc_.begin_job(0);
  queued_.store(0, std::memory_order_release);
  starting_.clear();
  failure_ = std::move(why);
}

std::optional<Fault> ProxyQueue::poll_fault() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

std::optional<Fault> ProxyQueue::issue(const MfcCommand& command) {
  if (std::optional<Fault> fault = check_proxy(command)) return fault;
  const bool starts = command.kind() == CommandKind::kStart;
  MfcCommand moved = command;
  if (starts) moved.word &= ~kStartBit;

  std::optional<Fault> fault = with_mfc([&] {
    while (queued_.load(std::memory_order_relaxed) == kSlots) mfc_.advance();
    SC_ASSERT(queued_ < kSlots, "{} commands are queued in {} slots", queued_.load(), kSlots);
    issuing_start_ = starts;
    return mfc_.issue(moved);
  });
  if (!fault) fault = poll_fault();
  if (fault) fault->command = command;
  return fault;
}

std::uint32_t ProxyQueue::complete_tags(std::uint32_t tag_mask) {
  return tag_status(tag_mask, Condition::kImmediate);
}

std::uint32_t ProxyQueue::wait_all(std::uint32_t tag_mask) { return tag_status(tag_mask, Condition::kAll); }

std::uint32_t ProxyQueue::wait_any(std::uint32_t tag_mask) {
  return tag_mask == 0 ? 0 : tag_status(tag_mask, Condition::kAny);
}

std::uint32_t ProxyQueue::tag_status(std::uint32_t tag_mask, Condition condition) {
  return with_mfc([&] {
    mfc_.write_tag_mask(tag_mask);
    mfc_.write_tag_update(static_cast<std::uint32_t>(condition));
    return std::get<std::uint32_t>(mfc_.read_tag_status());  // without lists, nothing stalls or fails
  });
}

int ProxyQueue::free_slots() {
  visit();
  return kSlots - queued_.load(std::memory_order_acquire);
}

void ProxyQueue::visit() {
  if (queued_.load(std::memory_order_acquire) == 0) return;
  with_mfc([&] {
    mfc_.visit();
    return true;
  });
}

bool ProxyQueue::advance() {
  if (queued_.load(std::memory_order_acquire) == 0) return false;
  return with_mfc([&] { return mfc_.advance(); });
}

// The bytes of a get count as written from here on: nothing can come before them that sees them.
void ProxyQueue::on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) {
  queued_.fetch_add(1, std::memory_order_release);
  if (std::exchange(issuing_start_, false)) starting_.push_back(number);
  if (command.is_get()) spe_.on_external_write(command.lsa, static_cast<std::uint32_t>(bytes));
}

void ProxyQueue::on_complete(std::uint64_t number) {
  const int before = queued_.fetch_sub(1, std::memory_order_release);
  SC_ASSERT(before > 0, "command {} completes and none is queued", number);
  starts_due_ += static_cast<int>(std::erase(starting_, number));
}

void ProxyQueue::on_reservation_lost(std::uint64_t number) { on_complete(number); }

}  // namespace softcell::dma
