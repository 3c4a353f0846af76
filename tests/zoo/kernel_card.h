#pragma once
// What the head of a zoo kernel's source says about it. Lines of keys, then the text:
//
//   // rule: size-not-legal          broken: the rule that it breaks
//   // names: get                    broken: what the message names besides, a command or a channel
//   // twin: legal/small_sizes       broken: the nearest legal case
//   // keeps: size-zero, list-size   legal: the rules that it comes close to
//   // build: checked              broken: only the checked image finds it; otherwise the plain one does
//   // build: plain                legal: not to be checked; otherwise both builds are left alone
//   // envp: read-only               what envp leads to; otherwise 64 KB that may be read and written
//   // spes: 2                       runs on so many SPEs at once; otherwise on one
//   // ppu: in_mbox=42               what the PPU side does meanwhile
//   // deadline: 100                 milliseconds; otherwise the usual
//   // What is wrong, and why one might write it.

#include <filesystem>
#include <string>
#include <vector>

namespace softcell::zoo {

struct KernelCard {
  std::string kind;  ///< "broken" or "legal"
  std::string name;  ///< of its file, without extension
  std::string rule, names, twin;
  std::vector<std::string> keeps;
  std::string build, envp, ppu;
  int spes = 1;
  int deadline_ms = 0;  ///< 0: the usual
  std::string text;
  int broken_line = 0;  ///< of the marker `// BROKEN`; 0: none

  bool runs_plain() const { return build != "checked"; }
  bool runs_checked() const { return build == "checked" || (kind == "legal" && build != "plain"); }
  /// Where the fault is: "size_3.cpp:10".
  std::string place() const { return name + ".cpp:" + std::to_string(broken_line); }
};

/// @throws std::runtime_error  the file and the line at fault: an unknown key, no text, not one marker.
KernelCard read_card(const std::filesystem::path& source);

/// The cards of all kernels of a kind in the zoo's folder, in order of name.
std::vector<KernelCard> read_cards(const std::string& kind);

}  // namespace softcell::zoo
