// Fuzz target: a program of one SPE against its MFC. The input's first byte chooses the schedule; each
// further byte, with the parameters behind it, is one thing that a kernel can do. Whatever it does, the MFC
// must answer, keep its books, stay inside what the program may touch, and do the same again when asked
// again.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fake_spe.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/mfc.h"

namespace softcell::dma {
namespace {

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "the MFC broke a promise: %s\n", what);
  std::abort();
}

/// The input, followed by zeros without end.
class Input {
 public:
  Input(const unsigned char* data, std::size_t size) : at_(data), end_(data + size) {}
  bool empty() const { return at_ == end_; }
  std::uint32_t byte() { return empty() ? 0u : *at_++; }
  std::uint32_t half() {
    const std::uint32_t high = byte();
    return high << 8 | byte();
  }

 private:
  const unsigned char* at_;
  const unsigned char* end_;
};

/// Counts what comes and goes.
class Books final : public MfcObserver {
 public:
  void on_issue(std::uint64_t number, const MfcCommand&, std::uint64_t) override {
    require(under_way.insert(number).second, "each command has its own number");
    ++issued;
  }
  void on_complete(std::uint64_t number) override {
    require(under_way.erase(number) == 1, "a command ends once, after its issue");
  }
  void on_reservation_lost(std::uint64_t number) override { on_complete(number); }
  std::set<std::uint64_t> under_way;
  std::uint64_t issued = 0;
};

/// What the program may touch, and what it must not change. To be fast, programs work on windows: the first
/// bytes of each place in main storage, the last ones of their local store.
class World {
 public:
  static constexpr std::size_t kBytes = 32768;
  static constexpr std::uint32_t kOwnWindow = kLocalStoreBytes - kBytes;

  World()
      : shared(space, "shared", kBytes),
        input(space, "input", 4096, {.spe_access = SpeAccess::kRead}),
        output(space, "output", 4096, {.spe_access = SpeAccess::kWrite}),
        video(space, "video", 4096, {.memory = Memory::kVideo}) {
    space.map_local_store(0, own);
    space.map_local_store(1, other);
    std::fill(input.span().begin(), input.span().end(), std::byte{0x11});
    std::fill(video.span().begin(), video.span().end(), std::byte{0x22});
  }

  void reset() {
    for (FakeSpe* spe : {&own, &other}) {
      spe->writes.clear();
      spe->registers.clear();
    }
    for (const std::span<std::byte> window : windows())
      std::fill(window.begin(), window.end(), std::byte{0x33});
  }

  /// All that a program may change.
  std::array<std::span<std::byte>, 5> windows() {
    return {std::span(own.store).first(kBytes), std::span(own.store).subspan(kOwnWindow),
            std::span(other.store).first(kBytes), shared.span(), output.span()};
  }

  void check_what_must_not_change() const {
    const auto all = [](std::span<const std::byte> bytes, std::byte value) {
      return std::all_of(bytes.begin(), bytes.end(), [value](std::byte b) { return b == value; });
    };
    require(all(input.span(), std::byte{0x11}), "a read-only buffer keeps its bytes");
    require(all(video.span(), std::byte{0x22}), "video memory keeps its bytes");
  }

  /// Where a command may go: mostly somewhere.
  EffectiveAddress place(std::uint32_t choice) const {
    switch (choice % 8) {
      case 0:
      case 1:
        return shared.ea();
      case 2:
        return input.ea();
      case 3:
        return output.ea();
      case 4:
        return video.ea();
      case 5:
        return local_store_ea(0);
      case 6:
        return local_store_ea(1);
      default:
        return local_store_ea(1) + (static_cast<std::uint32_t>(SpeRegister::kSignal1) - 12);
    }
  }

  AddressSpace space;
  FakeSpe own, other;
  Buffer<std::byte> shared, input, output, video;
};

/// What one run of a program came to: every answer, and the bytes it left.
struct Outcome {
  std::vector<std::uint32_t> answers;
  std::vector<unsigned char> bytes;
  bool operator==(const Outcome&) const = default;
};

class Program {
 public:
  Program(World& world, Input input)
      : world_(world), input_(input), mfc_(world.own.store, world.space, schedule()) {
    mfc_.set_observer(&books_);
  }

  Outcome run() {
    world_.reset();
    while (!input_.empty() && !over_) step();
    finish();
    Outcome outcome{std::move(answers_), {}};
    for (const std::span<const std::byte> window : world_.windows()) {
      const auto* bytes = reinterpret_cast<const unsigned char*>(window.data());
      outcome.bytes.insert(outcome.bytes.end(), bytes, bytes + window.size());
    }
    return outcome;
  }

 private:
  Schedule schedule() {
    const std::uint32_t choice = input_.byte();
    if (choice < 2) return {choice == 0 ? Schedule::kEager : Schedule::kLazy, 0};
    return {Schedule::kRandom, choice};
  }

  void step() {
    switch (input_.byte() % 16) {
      case 0:
        return answer(mfc_.write_tag_update(input_.byte() % 4));
      case 1:
        return mfc_.write_tag_mask(input_.half() << (input_.byte() % 2 * 16));
      case 2: {
        const auto status = mfc_.read_tag_status();
        if (const auto* tags = std::get_if<std::uint32_t>(&status)) last_status_ = *tags;
        return answer(status);
      }
      case 3:
        return answer(mfc_.tag_status_count());
      case 4:
        return answer(mfc_.free_slots());
      case 5:
        return answer(mfc_.read_list_stall_status());
      case 6:
        return answer(mfc_.write_list_stall_ack(input_.byte() % 40));
      case 7:
        return answer(mfc_.list_stall_count());
      case 8:
        return answer(mfc_.read_atomic_status());
      case 9:
        for (std::uint32_t visits = input_.byte(); visits != 0; --visits) mfc_.visit();
        return;
      case 10:
        return answer(mfc_.advance() ? 1 : 0);
      case 11:
        return answer(mfc_.poll_events());
      case 12:
        return write_list();
      case 13:
        return wait_for_all();
      default:
        return issue();
    }
  }

  // A few elements, mostly legal, where issue() looks for lists.
  void write_list() {
    const std::uint32_t first = input_.byte();
    for (std::uint32_t i = 0, count = input_.byte() % 8; i < count; ++i) {
      const EffectiveAddress place = world_.place(input_.byte());
      const std::uint32_t flags = input_.byte();
      const ListElement element{
          size(flags) | (flags >= 0xE0 ? ListElement::kStallBit : 0) | (flags == 0xDF ? 0x8000u : 0),
          static_cast<std::uint32_t>(place.value) + input_.byte() * 16};
      std::memcpy(&world_.own.store[kLists + (first + i) % 256 * sizeof element], &element, sizeof element);
    }
  }

  void wait_for_all() {
    mfc_.write_tag_mask(~0u);
    if (const auto fault = mfc_.write_tag_update(2)) return answer(fault);
    const auto status = mfc_.read_tag_status();
    if (std::holds_alternative<std::uint32_t>(status)) {
      require(std::get<std::uint32_t>(status) == ~0u, "a wait for all tags gives all");
      require(books_.under_way.empty(), "nothing is under way once all tags are complete");
    }
    answer(status);
  }

  void issue() {
    constexpr MfcOpcode kOpcodes[] = {
#define SC_MFC_OPCODE(name, code) MfcOpcode::name,
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
        MfcOpcode{0x43},
    };
    MfcCommand command;
    command.word = static_cast<std::uint32_t>(kOpcodes[input_.byte() % std::size(kOpcodes)]);
    const std::uint32_t low = input_.byte();
    command.lsa.value = World::kOwnWindow + input_.half() % kQuadwords * 16 + low % 16;
    command.ea = world_.place(input_.byte()) + input_.byte() * 16 + low / 16;
    command.size = size(input_.byte());
    command.tag = input_.byte() % 34;
    if (command.kind() == CommandKind::kLine || command.kind() == CommandKind::kQueuedLine) {
      command.lsa.value = command.lsa.value / kLineBytes * kLineBytes;
      command.ea.value = command.ea.value / kLineBytes * kLineBytes;
    } else if (command.kind() == CommandKind::kList) {
      command.ea.value = (kMainMemoryBase.value >> 32 << 32) | (kLists + low * kListElementBytes);
      command.size = (1 + command.size % 16) * kListElementBytes;
    }
    const std::optional<Fault> fault = mfc_.issue(command);
    if (!fault) ++accepted_;
    answer(fault);
    require(books_.issued >= accepted_, "every command that is taken is told of");
  }

  std::uint32_t size(std::uint32_t choice) {
    constexpr std::uint32_t kSizes[] = {0, 1, 2, 4, 8, 16, 32, 48, 128, 256, 1024, 4096, 16384, 3, 24, 16400};
    return kSizes[choice % std::size(kSizes)];
  }

  void answer(std::uint32_t value) { answers_.push_back(value); }
  void answer(int value) { answers_.push_back(static_cast<std::uint32_t>(value)); }
  // Faults end a kernel, but one in eight goes on, as no kernel can; the MFC must not mind.
  void answer(const std::optional<Fault>& fault) {
    if (!fault) return;
    require(!fault->detail.empty(), "a fault says what was found");
    require(fault->message().find(name(fault->rule)) != std::string::npos, "a message names its rule");
    answer(static_cast<std::uint32_t>(fault->rule));
    over_ = input_.byte() % 8 != 0;
  }
  void answer(const std::variant<std::uint32_t, Fault>& status) {
    if (const Fault* fault = std::get_if<Fault>(&status)) return answer(std::optional(*fault));
    answer(std::get<std::uint32_t>(status));
  }

  void finish() {
    const MfcStatistics& statistics = mfc_.statistics();
    require(statistics.commands() == books_.issued, "every command is counted once");
    require(statistics.highest_queue_occupancy <= MfcQueue::kSlots, "the queue has 16 slots");
    require(statistics.putllc_failed <= statistics.putllc, "only a putllc can fail");
    if (const std::optional<Fault> fault = mfc_.drain()) {
      answer(static_cast<std::uint32_t>(fault->rule));
    } else {
      require(books_.under_way.empty(), "after a drain nothing is under way");
      require(mfc_.free_slots() == MfcQueue::kSlots, "after a drain the queue is empty");
    }
    require(!mfc_.advance(), "after a drain nothing moves");
    answer(last_status_);
    world_.check_what_must_not_change();
  }

  static constexpr std::uint32_t kLists = 0x3F000;
  // From the window's first to a little past the local store's end.
  static constexpr std::uint32_t kQuadwords = World::kBytes / 16 + 16;

  World& world_;
  Input input_;
  Books books_;
  Mfc mfc_;
  std::vector<std::uint32_t> answers_;
  std::uint64_t accepted_ = 0;
  std::uint32_t last_status_ = 0;
  bool over_ = false;
};

}  // namespace
}  // namespace softcell::dma

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace softcell::dma;
  static World world;
  const Outcome first = Program(world, Input(data, size)).run();
  const Outcome again = Program(world, Input(data, size)).run();
  require(first == again, "the same program under the same schedule does the same");
  return 0;
}
