#include "softcell/base/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace softcell::base {
namespace {

/// Sets TMPDIR for a test.
class TemporaryFolders : public testing::Test {
 protected:
  ~TemporaryFolders() override {
    if (had_) {
      setenv("TMPDIR", before_.c_str(), 1);
    } else {
      unsetenv("TMPDIR");
    }
  }

 private:
  const bool had_ = std::getenv("TMPDIR") != nullptr;
  const std::string before_ = had_ ? std::getenv("TMPDIR") : "";
};

TEST_F(TemporaryFolders, AreNewAndGoWithAllThatIsInThem) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder("softcell-test"), other("softcell-test");
    path = folder.path();
    EXPECT_NE(path, other.path());
    EXPECT_EQ(path.filename().string().rfind("softcell-test-", 0), 0u) << path;
    std::filesystem::create_directory(path / "below");
    std::ofstream(path / "below" / "file") << "text";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(TemporaryFolders, LieInTmpIfTMPDIRNamesNoFolder) {
  setenv("TMPDIR", "/there/is/none", 1);
  const TemporaryFolder folder("softcell-test");
  EXPECT_EQ(folder.path().parent_path(), "/tmp");
}

TEST_F(TemporaryFolders, SayWhereTheyCannotBeMade) {
  setenv("TMPDIR", "/proc", 1);
  try {
    const TemporaryFolder folder("softcell-test");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("cannot make the temporary folder /proc/softcell-test-", 0), 0u)
        << error.what();
  }
}

}  // namespace
}  // namespace softcell::base
