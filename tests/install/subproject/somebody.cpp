// Runs the kernel on one SPE. Status 0: it ended as it should.
#include "softcell/ls_sim/spe_group.h"

// Made by softcell_embed_spu_images.
extern "C" const std::byte softcell_image_sloppy[], softcell_image_sloppy_end[];

int main() {
  using namespace softcell;
  const auto image = ls_sim::load_image("sloppy", {softcell_image_sloppy, softcell_image_sloppy_end});
  dma::AddressSpace memory;
  ls_sim::SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {});
  const ls_sim::RunResult result = group.wait(0);
  return !result.fault && result.status() == 42 ? 0 : 1;
}
