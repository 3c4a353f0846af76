#include "shell_verbs.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "command_tree.h"
#include "help_texts.h"

namespace softcell::tool {
namespace {

class ShellVerbs final : public Verb {
 public:
  explicit ShellVerbs(std::string version) : version_(std::move(version)) {}

  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* c = command.add_subcommand("completion",
                                         "Print a script for the shell that completes softcell's commands");
    c->add_option("SHELL", shell_, "bash, zsh or fish: source <(softcell completion bash)")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""))
        ->type_name("bash|zsh|fish");
    c->callback([&] {
      chosen = [&] {
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
};

}  // namespace

std::unique_ptr<Verb> shell_verbs(std::string version) {
  return std::make_unique<ShellVerbs>(std::move(version));
}

}  // namespace softcell::tool
