#include "shell_verbs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "command_tree.h"
#include "help_texts.h"
#include "softcell/base/assert.h"
#include "usage_sentence.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

/// The text of --help for the verb that the words lead to, from the top. @throws UsageError  there is no such verb.
std::string help_of(const CLI::App& command, const std::vector<std::string>& words) {
  const CLI::App* app = &command;
  std::string path = command.get_name();
  for (const std::string& word : words) {
    const std::vector<const CLI::App*> below = app->get_subcommands(nullptr);
    const auto found =
        std::ranges::find_if(below, [&](const CLI::App* verb) { return verb->get_name() == word; });
    if (found == below.end()) throw UsageError(unknown_verb(path, *app, word));
    app = *found;
    path += " " + word;
  }
  return app->get_formatter()->make_help(app, path, CLI::AppFormatMode::Normal);
}

class ShellVerbs final : public Verb {
 public:
  explicit ShellVerbs(std::string version) : version_(std::move(version)) {}

  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* h = command.add_subcommand("help", "Print the help of a verb: softcell help spu run");
    h->add_option("VERB", words_, "The verb, from the top; none: the command itself")->type_name("VERB");
    h->callback([&] {
      chosen = [&] {
        std::fputs(help_of(command, words_).c_str(), stdout);
        return 0;
      };
    });
    CLI::App* c = command.add_subcommand("completion",
                                         "Print a script for the shell that completes softcell's commands");
    c->add_option("SHELL", shell_, "bash, zsh or fish: source <(softcell completion bash)")
        ->required()
        ->check([](const std::string& text) -> std::string {
          if (text == "bash" || text == "zsh" || text == "fish") return {};
          throw UsageError(fmt::format("completion {}: give bash, zsh or fish", text));
        })
        ->type_name("bash|zsh|fish");
    c->callback([&] {
      chosen = [&] {
        SC_ASSERT(shell_ == "bash" || shell_ == "zsh" || shell_ == "fish", "a script for the shell '{}'",
                  shell_);
        const CommandVerb tree = command_tree(command);
        const auto script = shell_ == "fish"  ? fish_completion(tree)
                            : shell_ == "zsh" ? zsh_completion(tree)
                                              : bash_completion(tree);
        std::fputs(script.c_str(), stdout);
        return 0;
      };
    });
    command.add_subcommand("man", "Print the manual page: softcell man | man -l -")->callback([&] {
      chosen = [&] {
        std::fputs(manual_page(command_tree(command), version_).c_str(), stdout);
        return 0;
      };
    });
  }

 private:
  std::string version_;
  std::string shell_;
  std::vector<std::string> words_;
};

}  // namespace

std::unique_ptr<Verb> shell_verbs(std::string version) {
  return std::make_unique<ShellVerbs>(std::move(version));
}

}  // namespace softcell::tool
