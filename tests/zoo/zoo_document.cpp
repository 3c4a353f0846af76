// Fills in docs/reference/rules.md: what stands there between `<!-- zoo RULE -->` and `<!-- end -->` is what the
// hardware does when the rule is broken, and every broken kernel of the zoo with the message that it gets.
//
//   zoo_document FILE          writes the blocks of FILE anew
//   zoo_document --check FILE  succeeds when nothing would change

#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "kernel_card.h"
#include "kernel_run.h"
#include "softcell/dma/fault.h"

namespace softcell::zoo {
namespace {

constexpr std::string_view kBegin = "<!-- zoo ";
constexpr std::string_view kCounts = "<!-- zoo counts -->";
constexpr std::string_view kEnd = "<!-- end -->";

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
  const Build build = card.runs_plain() ? Build::kPlain : Build::kChecked;
  const Observation observation = run(card, build, dma::parse_schedule("eager"));
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
  static const std::regex place_in_variable("(the instruction at [a-z]+ \\+) [0-9]+");
  static const std::regex moment("did not end in time.*");
  static const std::regex bar("\\|");
  std::string text = std::regex_replace(message, place_in_image, "$1 0x.....");
  text = std::regex_replace(text, place_in_variable, "$1 ...");
  text = std::regex_replace(text, distance, "... bytes past the end of the local store");
  text = std::regex_replace(text, moment, "did not end in time");
  return std::regex_replace(text, bar, "\\|");
}

std::string link(const std::string& kernel) {
  return "[`" + kernel + "`](../../tests/zoo/" + kernel + ".cpp)";
}

/// The blocks of the document by the line that begins them.
std::map<std::string, std::string> blocks() {
  std::map<std::string, std::string> all;
  const auto cards = read_cards("broken");
  all[std::string(kCounts)] = std::to_string(cards.size()) + " broken kernels, " +
                              std::to_string(read_cards("legal").size()) + " legal ones.\n";
  for (const dma::Rule rule : dma::kAllRules) {
    const std::string name(dma::name(rule));
    std::ostringstream block;
    block << "**" << word_for(dma::evidence(rule)) << ".** " << dma::explanation(rule) << "\n";
    bool headed = false;
    for (const KernelCard& card : cards) {
      if (card.rule != name) continue;
      if (!headed) block << "\n| broken kernel | what is wrong | message | legal twin |\n|---|---|---|---|\n";
      headed = true;
      block << "| " << link("broken/" + card.name) << " | " << card.text << " | "
            << for_the_table(message_of(card)) << " | " << link(card.twin) << " |\n";
    }
    all[std::string(kBegin) + name + " -->"] = block.str();
  }
  return all;
}

/// The document with its blocks written anew.
/// @throws std::runtime_error  a block of no rule, a rule without a block, a block without an end.
std::string filled_in(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  auto left = blocks();
  std::string document;
  for (std::string line; std::getline(file, line);) {
    document += line + "\n";
    if (!line.starts_with(kBegin)) continue;
    const auto block = left.extract(line);
    if (!block) throw std::runtime_error(path + ": '" + line + "' names no rule, or one that had its block");
    while (std::getline(file, line) && line != kEnd) {
    }
    if (!file) throw std::runtime_error(path + ": " + block.key() + " has no " + std::string(kEnd));
    document += block.mapped() + std::string(kEnd) + "\n";
  }
  if (!left.empty()) throw std::runtime_error(path + ": no block " + left.begin()->first);
  return document;
}

bool is_up_to_date(const std::string& path) {
  std::ifstream file(path);
  std::istringstream lines(filled_in(path));
  std::string expected, found;
  for (int number = 1; std::getline(lines, expected); ++number) {
    if (!std::getline(file, found)) found = "(the end)";
    if (expected == found) continue;
    std::cerr << path << ":" << number << ": not up to date; write it again with zoo_document " << path
              << "\n  it has  " << found << "\n  and not " << expected << "\n";
    return false;
  }
  return true;
}

}  // namespace
}  // namespace softcell::zoo

int main(int count, char** arguments) {
  using namespace softcell;
  try {
    if (count == 3 && std::string(arguments[1]) == "--check") return zoo::is_up_to_date(arguments[2]) ? 0 : 1;
    if (count == 2 && !std::string_view(arguments[1]).starts_with("--")) {
      const std::string document = zoo::filled_in(arguments[1]);
      if (std::ofstream(arguments[1]) << document << std::flush) return 0;
      throw std::runtime_error(std::string("cannot write ") + arguments[1]);
    }
    std::cerr << "usage: zoo_document [--check] FILE\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "zoo_document: " << error.what() << "\n";
    return 1;
  }
}
