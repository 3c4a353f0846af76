// The command `softcell`: parses the command line, calls a verb, and turns an error into one line and an exit status.

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "all_verbs.h"
#include "command_line/shell_verbs.h"
#include "command_line/usage_sentence.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/base/whole_file.h"
#include "verb/exit_status.h"

namespace {

using namespace softcell;
using namespace softcell::tool;

/// Adds every verb to the parser; `chosen` becomes the call that the command line asks for.
class CommandLine {
 public:
  CommandLine() : verbs_(all_verbs()) {
    verbs_.push_back(shell_verbs(SOFTCELL_VERSION));
    SC_ASSERT(!verbs_.empty() && verbs_.back() != nullptr, "{} verbs, one of them none", verbs_.size());
    app_.require_subcommand(0, 1);
    app_.set_version_flag("--version", "softcell " SOFTCELL_VERSION);
    for (const auto& verb : verbs_) verb->add_to(app_, chosen_);
  }

  int run(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) {
        const auto sentence = left_out_sentence(app_, left_out_verbs());
        throw UsageError(sentence ? *sentence : usage_sentence(app_, error));
      }
      if (const auto sentence = more_behind_help(app_, argc, argv)) throw UsageError(*sentence);
      return app_.exit(error);  // --help, --version
    }
    if (const auto sentence = empty_value(app_)) throw UsageError(*sentence);
    if (!chosen_) throw UsageError(verbs_sentence(app_));
    return chosen_();
  }

  /// The verb that was called; before run(), the command itself.
  std::string verb() const { return called_verb(app_); }

 private:
  Verbs verbs_;
  CLI::App app_{"Runs Cell/PS3 SPU kernels on a PC, checks them, and shows soft bodies that they compute.",
                "softcell"};
  Call chosen_;
};

/// Printed text may still be in the stream's buffer, and a full disk shows only when it is flushed.
void finish_printing() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("cannot write standard output: ") + std::strerror(errno));
}

std::string sentence_of(const std::system_error& error) {
  // What a thread that cannot be started throws says nothing of threads.
  if (error.code() == std::errc::resource_unavailable_try_again)
    return "no more threads can be started: there is not enough memory, or too many run";
  // fmt::print() names no file.
  if (std::string_view(error.what()).starts_with("cannot write to file"))
    return "cannot write standard output: " + error.code().message();
  return base::one_line(error.what());
}

}  // namespace

int main(int argc, char** argv) {
  // A write beyond the limit of file sizes fails as one to a full disk does, and does not end the process.
  std::signal(SIGXFSZ, SIG_IGN);
  base::remove_temporary_files_at({SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE});
  try {
    CommandLine command_line;
    try {
      const int status = command_line.run(argc, argv);
      finish_printing();
      return status;
    } catch (const UsageError& error) {
      std::fprintf(stderr, "softcell: %s (%s --help lists what is allowed)\n",
                   base::one_line(error.what()).c_str(), command_line.verb().c_str());
      return 2;
    }
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "softcell: there is not enough memory\n");
    return 1;
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "softcell: %s\n", sentence_of(error).c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "softcell: %s\n", base::one_line(error.what()).c_str());
    return 1;
  }
}
