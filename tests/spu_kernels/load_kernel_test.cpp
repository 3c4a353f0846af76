// Kernels by name and from files.

#include "softcell/spu_kernels/load_kernel.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>

#include "softcell/spu_kernels/images.h"
#include "support/scratch_folder.h"

namespace softcell::spu_kernels {
namespace {

namespace fs = std::filesystem;

class LoadKernel : public testing::Test {
 protected:
  fs::path write(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return folder_ / name;
  }

  tests::ScratchFolder folder_;
};

TEST_F(LoadKernel, FindsEveryKernelByName) {
  for (const ImageFile& file : image_files()) {
    EXPECT_EQ(load_kernel(file.name).name, file.name);
    EXPECT_FALSE(load_kernel(file.name).checked);
    if (file.checked_elf.empty()) continue;
    EXPECT_TRUE(load_kernel(file.name, true).checked) << file.name;
  }
  try {
    load_kernel("no_such");
    ADD_FAILURE() << "a kernel that there is not";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("softcell has no kernel no_such; there are: job_loop, attach, "),
              0u)
        << error.what();
  }
  EXPECT_THROW(load_kernel("job_loop", true), std::runtime_error);
}

TEST_F(LoadKernel, AFilesNameIsTheKernels) {
  const ls_sim::KernelImage plain = load_kernel_file(write("mine.spu.elf", image_file("skin", false)));
  EXPECT_EQ(plain.name, "mine");
  EXPECT_EQ(plain.bytes, load_kernel("skin").bytes);
  const ls_sim::KernelImage checked =
      load_kernel_file(write("mine.checked.spu.elf", image_file("skin", true)));
  EXPECT_EQ(checked.name, "mine");
  EXPECT_TRUE(checked.checked);
  EXPECT_EQ(load_kernel_file(write("other.elf", image_file("skin", false))).name, "other");
}

TEST_F(LoadKernel, NamesAFileThatIsNoKernel) {
  const auto problem = [](const fs::path& file) -> std::string {
    try {
      load_kernel_file(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(problem(folder_ / "none.spu.elf").find("none.spu.elf"), std::string::npos);
  const std::byte few[4] = {};
  EXPECT_NE(problem(write("few.spu.elf", few)).find("few.spu.elf is not an ELF file"), std::string::npos);
  const std::string cut = problem(write("cut.spu.elf", image_file("skin", false).first(100)));
  EXPECT_NE(cut.find("cut.spu.elf: "), std::string::npos) << cut;
  EXPECT_NE(cut.find("truncated"), std::string::npos) << cut;
}

}  // namespace
}  // namespace softcell::spu_kernels
