// libFuzzer target: calls of programs with any arguments: formats of printf and scanf, addresses, sizes. The first byte selects the library
// and the kind of program, the second the function. The rest is the local store, with the arguments at address 0, and also the standard input.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "assisted/assisted_calls.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softcell::ls_sim;
  if (size < 2) return 0;
  const std::span<const std::uint8_t> content(
      data + 2, std::min<std::size_t>(size - 2, softcell::dma::kLocalStoreBytes));
  static std::vector<std::byte> local_store(softcell::dma::kLocalStoreBytes);
  std::fill(local_store.begin(), local_store.end(), std::byte{0});
  std::transform(content.begin(), content.end(), local_store.begin(),
                 [](std::uint8_t b) { return std::byte{b}; });

  std::size_t read = 0;
  HostCalls calls;
  calls.standard_output = calls.standard_error = [](std::string_view) {};
  calls.standard_input = [&](std::span<char> to) -> std::optional<std::size_t> {
    const std::size_t count = std::min(to.size(), content.size() - read);
    std::copy_n(content.begin() + static_cast<std::ptrdiff_t>(read), count, to.begin());
    read += count;
    return count;
  };
  std::atomic<bool> interrupted = data[0] >= 128;  // an interrupted run waits for nothing
  assisted::FilesInFolder files(calls, interrupted);
  assisted::AssistedCalls served(
      files, local_store, (data[0] & 2) != 0 ? assisted::CallerKind::kHost : assisted::CallerKind::kSpu);
  if ((data[0] & 1) != 0 && data[1] == assisted::kNanosleep) interrupted = true;
  served.serve((data[0] & 1) != 0 ? assisted::kPosixCall : assisted::kC99Call, std::uint32_t{data[1]} << 24);
  return 0;
}
