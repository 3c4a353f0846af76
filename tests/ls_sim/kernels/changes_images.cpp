// Resident. Changes the image at the bottom of the local store as fast as it can, calls it each time and
// compares what it returns. argp: a stress::Task and behind it the Expected; envp: the Outcome.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "stress_code.h"

namespace {

using softcell::spu::get_large;
using softcell::spu::put_large;
using softcell::spu::wait_for_tag;

constexpr uint32_t kBottom = 0x80;              // where images are linked
constexpr uint32_t kSignal1Register = 0x5400C;  // from the base of an SPE
constexpr uint32_t kTag = 3;
constexpr uint32_t kMostImageBytes = 24 * 1024;
constexpr uint32_t kPieceBytes = 2048;  // of a list

stress::Task task;
stress::Expected expected;
stress::Outcome outcome;
alignas(128) char staging[kMostImageBytes];
alignas(128) mfc_list_element_t list[kMostImageBytes / kPieceBytes];
alignas(16) uint32_t signal[4];

char* local_store(uint32_t address) {
  return reinterpret_cast<char*>((reinterpret_cast<uintptr_t>(&task) & ~uintptr_t{0x3FFFF}) | address);
}

void fetch_by_list(uint32_t image) {
  uint32_t elements = 0;
  for (uint32_t at = 0; at < task.image_bytes[image]; at += kPieceBytes) {
    const uint32_t rest = task.image_bytes[image] - at;
    list[elements].notify = 0;
    list[elements].reserved = 0;
    list[elements].size = rest < kPieceBytes ? rest : kPieceBytes;
    list[elements].eal = mfc_ea2l(task.image_ea[image]) + at;
    ++elements;
  }
  mfc_getl(local_store(kBottom), task.image_ea[image], list, elements * sizeof list[0], kTag, 0, 0);
}

void tell_neighbour(uint32_t value) {
  signal[3] = value;
  mfc_sndsig(&signal[3], task.neighbour + kSignal1Register, kTag, 0, 0);
  wait_for_tag(kTag);
}

/// Of a pair, the one that puts: image by image to the neighbour, who answers when it has run it.
void serve_neighbour(uint32_t image) {
  get_large(staging, task.image_ea[image], task.image_bytes[image], kTag);
  wait_for_tag(kTag);
  put_large(staging, task.neighbour + kBottom, task.image_bytes[image], kTag);
  wait_for_tag(kTag);
  tell_neighbour(1);
  spu_read_signal1();
}

void bring(uint32_t image) {
  switch (static_cast<stress::Way>(task.way)) {
    case stress::Way::kGets:
      get_large(local_store(kBottom), task.image_ea[image], task.image_bytes[image], kTag);
      wait_for_tag(kTag);
      break;
    case stress::Way::kList:
      fetch_by_list(image);
      wait_for_tag(kTag);
      break;
    case stress::Way::kPutsOfNeighbour:
      spu_read_signal1();
      break;
  }
  if (task.syncs) spu_sync_c();
}

void put_outcome(uint64_t ea) {
  mfc_put(&outcome, ea, sizeof outcome, kTag, 0, 0);
  wait_for_tag(kTag);
}

}  // namespace

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_get(&task, argp, sizeof task, kTag, 0, 0);
  mfc_get(&expected, argp + sizeof task, sizeof expected, kTag, 0, 0);
  wait_for_tag(kTag);
  uint32_t order = task.seed;
  for (uint32_t round = 0; round < task.rounds; ++round) {
    order = order * 1664525u + 1013904223u;
    const uint32_t image = order >> 30, input = order >> 20 & (stress::kInputs - 1);
    if (task.fetches_only) {
      serve_neighbour(image);
      continue;
    }
    bring(image);
    using Main = int(uint64_t, uint64_t, uint64_t);
    const uint32_t result =
        static_cast<uint32_t>(reinterpret_cast<Main*>(local_store(task.entry[image]))(0, input, 0));
    if (static_cast<stress::Way>(task.way) == stress::Way::kPutsOfNeighbour) tell_neighbour(1);
    if (result != expected.of[image][input]) {
      outcome.rounds = round;
      outcome.image = image;
      outcome.input = input;
      outcome.result = result;
      put_outcome(envp);
      return 1;
    }
  }
  outcome.rounds = task.rounds;
  put_outcome(envp);
  return 0;
}
