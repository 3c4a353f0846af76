#pragma once
// Golden pictures: what was looked at once and found good, kept beside the tests.
//
// The test program says where they are, by two compile definitions (as tests/render/CMakeLists.txt sets
// them): SOFTCELL_GOLDEN_DIR in the sources, SOFTCELL_GOLDEN_FAILURES_DIR in the build tree.

#include <gtest/gtest.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include "softcell/render/image.h"
#include "softcell/render/image_compare.h"
#include "softcell/render/png_io.h"

namespace softcell::test {

struct GoldenFolders {
  std::filesystem::path golden = SOFTCELL_GOLDEN_DIR;
  std::filesystem::path failures = SOFTCELL_GOLDEN_FAILURES_DIR;
};

/// Compares a picture with <golden folder>/<name>.png by the golden rule of image_compare.h. On failure the
/// picture, the golden one and their difference (32-fold) are left in the failures folder, and the message
/// names them. With SOFTCELL_UPDATE_GOLDENS=1 in the environment the golden picture is written instead and
/// the comparison passes: look at it before committing it, and say in the commit why it moved.
///
///     EXPECT_TRUE(compare_with_golden(renderer.pixels(), "small_scene"));
inline testing::AssertionResult compare_with_golden(const render::Image& actual, const std::string& name,
                                                    const GoldenFolders& folders = {}) {
  const std::filesystem::path golden = folders.golden / (name + ".png");
  const auto keep = [&](const char* kind, const render::Image& image) {
    std::filesystem::create_directories(folders.failures);
    const std::filesystem::path path = folders.failures / (name + "." + kind + ".png");
    render::write_png(path, image, render::PngEffort::kSmall);
    return "\n  " + path.string();
  };
  try {
    const char* const update = std::getenv("SOFTCELL_UPDATE_GOLDENS");
    if (update != nullptr && std::string(update) == "1") {
      std::filesystem::create_directories(folders.golden);
      render::write_png(golden, actual, render::PngEffort::kSmall);
      return testing::AssertionSuccess() << "wrote " << golden.string();
    }
    if (!std::filesystem::exists(golden)) {
      return testing::AssertionFailure() << "there is no golden picture " << golden.string()
                                         << "; the picture drawn is" << keep("actual", actual);
    }
    const render::Image expected = render::read_png(golden);
    const render::ImageDifference difference = render::compare(actual, expected);
    if (render::within_golden_rule(difference)) return testing::AssertionSuccess();
    auto failure = testing::AssertionFailure() << name << ": " << render::describe(difference)
                                               << keep("actual", actual) << keep("expected", expected);
    if (difference.same_size) failure << keep("difference", render::difference_image(actual, expected));
    return failure;
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << name << ": " << error.what();
  }
}

}  // namespace softcell::test
