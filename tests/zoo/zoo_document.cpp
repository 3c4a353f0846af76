// Writes docs/reference/zoo.md: every broken kernel of the zoo with the message that it gets, in the order of the
// rules.
//
//   zoo_document               to standard output
//   zoo_document --check FILE  succeeds when FILE is what would be written

#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>

#include "kernel_card.h"
#include "kernel_run.h"
#include "softcell/dma/fault.h"

namespace softcell::zoo {
namespace {

constexpr char kIntroduction[] =
    R"(<!-- Written by zoo_document (tests/zoo) from the kernels and what softcell says about them: do not edit. -->
# The zoo

Broken kernels, one fault each, by the rule that they break, with the message that softcell gives; and for each the nearest kernel that
is legal, which runs without a finding. All are in `tests/zoo` and run under the schedules eager, lazy and two random ones. Where a
message has a local-store address, dots stand for it here, because it depends on the compiler.

What each rule asks for and how to mend a kernel: [writing-kernels.md](../guide/writing-kernels.md). What a real Cell does when a rule is broken:
**raised**, it raises an error; **silent**, it raises nothing, and data are lost or a wait never ends; **unconfirmed**, no source at hand
says.
)";

const char* word_for(dma::Evidence evidence) {
  switch (evidence) {
    case dma::Evidence::kRaised:
      return "raised";
    case dma::Evidence::kSilent:
      return "silent";
    case dma::Evidence::kUnconfirmed:
      return "unconfirmed";
  }
  return "";
}

/// The message of the first fault or finding of a run.
std::string message_of(const KernelCard& card) {
  const Flavour flavour = card.runs_plain() ? Flavour::kPlain : Flavour::kChecked;
  const Observation observation = run(card, flavour, dma::parse_schedule("eager"));
  for (const ls_sim::RunResult& result : observation.results) {
    if (result.fault) return result.fault->message();
  }
  if (!observation.findings.empty()) return observation.findings.front().fault.message();
  throw std::runtime_error("nothing was found in " + card.kind + "/" + card.name);
}

/// What depends on how the compiler lays out an image becomes dots, and where a deadline met a kernel is left
/// out; a bar would end a table's cell.
std::string for_the_table(const std::string& message) {
  static const std::regex place_in_image("(LSA|list|address) 0x[0-9A-F]{5}\\b");
  static const std::regex distance("[0-9]+ bytes past the end of the local store");
  static const std::regex moment("did not end in time.*");
  static const std::regex bar("\\|");
  std::string text = std::regex_replace(message, place_in_image, "$1 0x.....");
  text = std::regex_replace(text, distance, "... bytes past the end of the local store");
  text = std::regex_replace(text, moment, "did not end in time");
  return std::regex_replace(text, bar, "\\|");
}

std::string link(const std::string& kernel) {
  return "[`" + kernel + "`](../../tests/zoo/" + kernel + ".cpp)";
}

void write(std::ostream& out) {
  const auto cards = read_cards("broken");
  out << kIntroduction << "\n"
      << cards.size() << " broken kernels, " << read_cards("legal").size() << " legal ones.\n";
  for (const dma::Rule rule : dma::kAllRules) {
    bool headed = false;
    for (const KernelCard& card : cards) {
      if (card.rule != dma::name(rule)) continue;
      if (!headed) {
        out << "\n## " << dma::name(rule) << "\n\n"
            << "**" << word_for(dma::evidence(rule)) << ".** " << dma::explanation(rule) << "\n\n"
            << "| broken kernel | what is wrong | message | legal twin |\n|---|---|---|---|\n";
        headed = true;
      }
      out << "| " << link("broken/" + card.name) << " | " << card.text << " | "
          << for_the_table(message_of(card)) << " | " << link(card.twin) << " |\n";
    }
  }
}

bool is_fresh(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream expected;
  write(expected);
  std::istringstream lines(expected.str());
  std::string ours, theirs;
  for (int number = 1; std::getline(lines, ours); ++number) {
    if (!std::getline(file, theirs)) theirs = "(the end)";
    if (ours == theirs) continue;
    std::cerr << path << ":" << number << ": not up to date; write it again with zoo_document\n  it has  "
              << theirs << "\n  and not " << ours << "\n";
    return false;
  }
  return file.peek() == std::ifstream::traits_type::eof();
}

}  // namespace
}  // namespace softcell::zoo

int main(int count, char** arguments) {
  try {
    if (count == 1) {
      softcell::zoo::write(std::cout);
      return 0;
    }
    if (count == 3 && std::string(arguments[1]) == "--check")
      return softcell::zoo::is_fresh(arguments[2]) ? 0 : 1;
    std::cerr << "usage: zoo_document [--check FILE]\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "zoo_document: " << error.what() << "\n";
    return 1;
  }
}
