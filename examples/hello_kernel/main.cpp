// Runs the kernel hello on one SPE.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string_view>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"

// The kernel's image, which CMakeLists.txt puts into the program.
extern "C" const std::byte softcell_image_hello[], softcell_image_hello_end[];

using namespace softcell;

int main() try {
  const auto image = ls_sim::load_image("hello", {softcell_image_hello, softcell_image_hello_end});
  dma::AddressSpace memory;
  dma::Buffer<char> text(memory, "text", 16);
  std::ranges::copy(std::string_view("hello, kernel"), text.data());

  ls_sim::SpeGroup spes(memory, {.spes = 1});
  spes.start(0, image, {.argp = text.ea().value});
  const ls_sim::RunResult result = spes.wait(0);
  if (result.fault) throw std::runtime_error(result.fault->message());
  std::puts(text.data());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hello: %s\n", error.what());
  return 1;
}
