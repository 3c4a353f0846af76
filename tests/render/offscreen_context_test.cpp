#include "softcell/render/offscreen_context.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "dynamic_library.h"
#include "temporary_directory.h"

namespace softcell::render {
namespace {

struct Output {
  int status = -1;
  std::string text;
  std::string hash() const { return text.substr(0, text.find(' ')); }
};

/// Draws the test scene in a process of its own, since a process uses one backend.
Output run_probe(const std::string& arguments) {
  const std::string command = std::string(SOFTCELL_RENDER_PROBE) + " " + arguments + " 2>&1";
  Output output;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output.text += buffer.data();
  const int status = ::pclose(pipe);
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return output;
}

TEST(OffscreenContext, BothBackendsDrawTheSamePixels) {
  // As pictures and as windows without a GPU are drawn.
  for (const std::string settings : {"", " --samples 1 --occlusion 4 --quick"}) {
    const Output osmesa = run_probe("osmesa" + settings);
    const Output egl = run_probe("egl" + settings);
    ASSERT_EQ(osmesa.status, 0) << osmesa.text;
    ASSERT_EQ(egl.status, 0) << egl.text;
    EXPECT_NE(osmesa.text.find(" OSMesa, llvmpipe"), std::string::npos) << osmesa.text;
    EXPECT_NE(egl.text.find(" EGL, llvmpipe"), std::string::npos) << egl.text;
    EXPECT_EQ(osmesa.hash(), egl.hash()) << settings;
  }
}

TEST(OffscreenContext, DrawsTheSamePixelsWithAnyNumberOfRasterizerThreads) {
  const Output one = run_probe("osmesa");
  ::setenv("LP_NUM_THREADS", "0", 1);
  const Output none = run_probe("osmesa");
  ::unsetenv("LP_NUM_THREADS");
  ASSERT_EQ(one.status, 0) << one.text;
  EXPECT_EQ(one.hash(), none.hash());
}

TEST(DynamicLibrary, NamesWhatIsMissingAndThePackageThatHasIt) {
  const std::string error = test::error_of([] {
    DynamicLibrary({"libNoSuchThing.so.8", "libNoSuchThing.so"}, "libnosuchthing8");
  });
  EXPECT_NE(error.find("cannot load libNoSuchThing.so.8 ("), std::string::npos) << error;
  EXPECT_NE(error.find("install the package libnosuchthing8"), std::string::npos) << error;
}

}  // namespace
}  // namespace softcell::render
