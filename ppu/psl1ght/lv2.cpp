#include "lv2.h"

#include <string>

namespace softcell::psl1ght {

Lv2& Lv2::get() {
  static auto* const lv2 = new Lv2;
  return *lv2;
}

std::shared_ptr<Queue> Lv2::queue(u32 number) {
  const auto found = queues.find(number);
  return found == queues.end() ? nullptr : found->second;
}

std::shared_ptr<Group> Lv2::group(u32 number) {
  const auto found = groups.find(number);
  return found == groups.end() ? nullptr : found->second;
}

std::uint32_t Lv2::send(Queue& queue, const sys_event_t& event) {
  if (queue.events.size() >= queue.room) return kBusy;
  queue.events.push_back(event);
  changed.notify_all();
  return kOk;
}

void report_fault(const dma::Fault& fault, bool handled) {
  Machine& machine = Machine::get();
  if (machine.is_ending()) return;  // the end of the program has ended it
  machine.report(fault);
  if (handled) return;
  Machine::complain("the program ends here, as lv2 ends one whose SPU program fails");
  machine.end_process(1);
}

std::uint32_t refuse(std::string_view function, std::string_view reason) {
  Machine::complain(std::string(function) + "() is not supported: " + std::string(reason));
  return kNotSupported;
}

}  // namespace softcell::psl1ght
