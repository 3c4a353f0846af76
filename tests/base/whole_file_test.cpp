// A file that appears whole or not at all, whatever lies where it is to be.

#include "softcell/base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "support/files_in.h"
#include "support/text_file.h"

namespace softcell::base {
namespace {

namespace fs = std::filesystem;

class WholeFileTest : public testing::Test {
 protected:
  WholeFileTest() {
    std::string name = fs::temp_directory_path() / "softcell_whole_file_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~WholeFileTest() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string text(const std::string& name) const { return test::text_of(folder_ / name); }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void write_whole(const std::string& name, const std::string& text) const {
    WholeFile file(folder_ / name);
    file.write(text);
    file.commit();
  }
  std::set<std::string> names() const { return test::files_in(folder_); }
  mode_t mode(const std::string& name) const {
    struct stat found {};
    EXPECT_EQ(::stat((folder_ / name).c_str(), &found), 0) << name;
    return found.st_mode & 07777;
  }

  fs::path folder_;
};

std::string refusal(const fs::path& path) {
  try {
    const WholeFile file(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "it was opened";
}

TEST_F(WholeFileTest, TakesItsPlaceOnlyWhenItIsCommitted) {
  put("f", "old");
  {
    WholeFile file(folder_ / "f");
    file.write("new");
    file.finish();
    EXPECT_EQ(text("f"), "old");
  }
  EXPECT_EQ(text("f"), "old");
  EXPECT_EQ(names(), std::set<std::string>{"f"});
  write_whole("f", "new");
  EXPECT_EQ(text("f"), "new");
  EXPECT_EQ(names(), std::set<std::string>{"f"});
}

TEST_F(WholeFileTest, TwoWritersOfOneFileDoNotMixTheirBytes) {
  WholeFile one(folder_ / "f"), other(folder_ / "f");
  one.write("one");
  other.write("the other");
  one.finish();
  other.finish();
  one.commit();
  EXPECT_EQ(text("f"), "one");
  other.commit();
  EXPECT_EQ(text("f"), "the other");
  EXPECT_EQ(names(), std::set<std::string>{"f"});
}

TEST_F(WholeFileTest, LeavesOtherFilesAlone) {
  put("f.part", "the user's");
  put("elsewhere", "the user's, too");
  fs::create_symlink(folder_ / "elsewhere", folder_ / "g.part");
  write_whole("f", "new");
  write_whole("g", "new");
  EXPECT_EQ(text("f.part"), "the user's");
  EXPECT_EQ(text("elsewhere"), "the user's, too");
  EXPECT_EQ(names(), (std::set<std::string>{"elsewhere", "f", "f.part", "g", "g.part"}));
}

// As one that was killed leaves it, when a later process has its number.
TEST_F(WholeFileTest, TakesAnotherTemporaryNameWhenOneIsTaken) {
  std::string taken;
  {
    const WholeFile file(folder_ / "f");
    taken = *names().begin();
  }
  const std::size_t number = taken.rfind('-') + 1;
  const unsigned long counter = std::stoul(taken.substr(number));
  const std::string next = taken.substr(0, number) + std::to_string(counter + 1) + ".partial";
  put("elsewhere", "the user's");
  fs::create_symlink(folder_ / "elsewhere", folder_ / next);
  write_whole("f", "new");
  EXPECT_EQ(text("f"), "new");
  EXPECT_EQ(text("elsewhere"), "the user's");
  EXPECT_EQ(names(), (std::set<std::string>{"elsewhere", "f", next}));
}

TEST_F(WholeFileTest, KeepsThePermissionsOfWhatItReplaces) {
  const mode_t umask_before = ::umask(027);
  write_whole("f", "first");
  EXPECT_EQ(mode("f"), 0640u) << "a new file's are those that the umask leaves";
  for (const mode_t kept : {0600u, 0666u, 0444u, 0755u}) {
    ASSERT_EQ(::chmod((folder_ / "f").c_str(), kept), 0);
    write_whole("f", "again");
    EXPECT_EQ(mode("f"), kept);
  }
  ::umask(umask_before);
}

TEST_F(WholeFileTest, ReplacesTheFileThatALinkStandsFor) {
  fs::create_directory(folder_ / "sub");
  put("sub/f", "old");
  fs::create_symlink("sub/f", folder_ / "near");
  fs::create_symlink(folder_ / "near", folder_ / "far");
  fs::create_symlink("sub/none", folder_ / "to_nothing");
  write_whole("far", "new");
  write_whole("to_nothing", "made");
  EXPECT_EQ(text("sub/f"), "new");
  EXPECT_EQ(text("sub/none"), "made");
  for (const char* link : {"near", "far", "to_nothing"}) EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
  EXPECT_EQ(names(), (std::set<std::string>{"far", "near", "sub", "to_nothing"}));
}

TEST_F(WholeFileTest, WritesToADeviceBehindALink) {
  fs::create_symlink("/dev/null", folder_ / "null");
  write_whole("null", "nothing");
  EXPECT_TRUE(fs::is_character_file(folder_ / "null"));
  EXPECT_EQ(names(), std::set<std::string>{"null"});
}

TEST_F(WholeFileTest, TakesTheLongestNames) {
  const std::string longest(255, 'f');
  write_whole(longest, "new");
  EXPECT_EQ(text(longest), "new");
  EXPECT_NE(refusal(folder_ / (longest + "f")).find("File name too long"), std::string::npos);
}

// As an encoder does that is given a name and looks at its ending.
TEST_F(WholeFileTest, MayBeWrittenByAnotherProgramUnderItsTemporaryName) {
  put("f.mp4", "old");
  ASSERT_EQ(::chmod((folder_ / "f.mp4").c_str(), 0444), 0);
  WholeFile file(folder_ / "f.mp4");
  EXPECT_EQ(file.written_path().extension(), ".mp4");
  EXPECT_EQ(file.written_path().parent_path(), folder_);
  std::ofstream(file.written_path()) << "new";
  EXPECT_EQ(text("f.mp4"), "old");
  file.commit();
  EXPECT_EQ(text("f.mp4"), "new");
  EXPECT_EQ(mode("f.mp4"), 0444u);
  EXPECT_EQ(names(), std::set<std::string>{"f.mp4"});
  EXPECT_EQ(WholeFile("/dev/null").written_path(), "/dev/null");
}

TEST_F(WholeFileTest, MayBeWrittenAsAStream) {
  {
    WholeFile file(folder_ / "f");
    std::fputs("one ", file.stream());
    file.write("two");
    file.commit();
  }
  EXPECT_EQ(text("f"), "one two");
}

TEST_F(WholeFileTest, MayBeAStreamThatIsOpenAlready) {
  put("f", "old\n");
  const auto append = [&] { return std::fopen((folder_ / "f").c_str(), "ab"); };
  {
    WholeFile file(append(), "standard output");
    file.write("new");
    file.commit();
  }
  EXPECT_EQ(text("f"), "old\nnew") << "what is there already stays";
  WholeFile full(std::fopen("/dev/full", "wb"), "standard output");
  full.write("new");
  try {
    full.commit();
    FAIL() << "a full disk was written to";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "cannot write standard output: No space left on device");
  }
  EXPECT_EQ(names(), std::set<std::string>{"f"});
}

TEST_F(WholeFileTest, TakesItsPlaceTogetherWithOthers) {
  {
    WholeFiles files;
    files.open(folder_ / "f").write("f");
    EXPECT_EQ(files.open(std::optional<fs::path>()), nullptr);
  }
  EXPECT_EQ(names(), std::set<std::string>{});
  WholeFiles files;
  files.open(folder_ / "f").write("f");
  files.open(std::optional(folder_ / "g"))->write("g");
  EXPECT_FALSE(fs::exists(folder_ / "f"));
  files.commit();
  EXPECT_EQ(names(), (std::set<std::string>{"f", "g"}));
}

TEST_F(WholeFileTest, RefusesWhatIsNoFile) {
  EXPECT_EQ(refusal(""), "cannot write '': the file name is empty");
  EXPECT_EQ(refusal(folder_), "cannot write " + folder_.string() + ": Is a directory");
  EXPECT_NE(refusal(folder_ / "none/f").find("none/f: No such file or directory"), std::string::npos);
  fs::create_symlink("round", folder_ / "round");
  EXPECT_NE(refusal(folder_ / "round").find("Too many levels of symbolic links"), std::string::npos);
  EXPECT_EQ(names(), std::set<std::string>{"round"});
}

/// Opens three files, commits one, discards another, and raises the signal. @return  how the process ended
int end_while_files_are_open(const fs::path& folder, int signal, bool is_ignored) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{};
    setrlimit(RLIMIT_CORE, &no_core);
    std::signal(signal, is_ignored ? SIG_IGN : SIG_DFL);
    remove_temporary_files_at({SIGQUIT, SIGPIPE});
    WholeFile open(folder / "open"), committed(folder / "committed");
    { const WholeFile discarded(folder / "discarded"); }
    open.write("half of");
    committed.write("all");
    committed.commit();
    const WholeFile another(folder / "another");
    std::raise(signal);
    _exit(7);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

TEST_F(WholeFileTest, LeavesNothingHiddenWhenASignalEndsTheProcess) {
  for (const int signal : {SIGQUIT, SIGPIPE}) {
    EXPECT_EQ(end_while_files_are_open(folder_, signal, false), signal);
    EXPECT_EQ(names(), std::set<std::string>{"committed"});
  }
  EXPECT_EQ(end_while_files_are_open(folder_, SIGPIPE, true), -7) << "a signal that is ignored stays so";
}

TEST_F(WholeFileTest, MayBeMoreThanSignalsKnow) {
  WholeFiles files;
  for (int i = 0; i < 100; ++i) files.open(folder_ / std::to_string(i)).write("x");
  files.commit();
  EXPECT_EQ(names().size(), 100u);
}

}  // namespace
}  // namespace softcell::base
