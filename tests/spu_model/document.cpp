// Fills in docs/reference/spu-instructions.md from the model's table: what stands there between
// `<!-- instructions -->` and `<!-- end -->`.
//
//   spu_instruction_document FILE          writes the block of FILE anew
//   spu_instruction_document --check FILE  succeeds when nothing would change

#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "spu_model/instruction.h"

namespace softcell::spu_model {
namespace {

constexpr std::string_view kBegin = "<!-- instructions -->\n";
constexpr std::string_view kEnd = "<!-- end -->\n";

const char* word_for(Evidence evidence) {
  switch (evidence) {
    case Evidence::kArchitecture:
      return "architecture";
    case Evidence::kTwoSources:
      return "two sources";
    case Evidence::kOneSource:
      return "one source";
    case Evidence::kAssumed:
      return "assumed";
  }
  return "";
}

const char* word_for(Format format) {
  switch (format) {
    case Format::kRRR:
      return "RRR";
    case Format::kRR:
    case Format::kHintRegister:
      return "RR";
    case Format::kRI7:
      return "RI7";
    case Format::kRI8:
      return "RI8";
    case Format::kRI10:
      return "RI10";
    case Format::kRI16:
    case Format::kHintImmediate:
      return "RI16";
    case Format::kRI18:
      return "RI18";
  }
  return "";
}

std::string block() {
  std::map<Evidence, int> counts;
  for (const Instruction& row : instructions()) ++counts[row.evidence];
  std::string text = std::to_string(instructions().size()) + " instructions:";
  for (const auto& [evidence, count] : counts) {
    text += (text.ends_with(':') ? " " : ", ") + std::to_string(count) + " " + word_for(evidence);
  }
  text += ".\n\n| instruction | format | opcode | evidence | except |\n|---|---|---|---|---|\n";
  for (const Instruction& row : instructions()) {
    text += "| `" + std::string(row.mnemonic) + "` | " + word_for(row.format) + " | `" +
            std::string(row.opcode) + "` | " + word_for(row.evidence) + " | " + std::string(row.note) +
            " |\n";
  }
  return text;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The page with its block written anew. @throws std::runtime_error  the page has no block
std::string filled_in(const std::string& path) {
  std::string page = contents(path);
  const std::size_t begin = page.find(kBegin);
  const std::size_t end = page.find(kEnd, begin);
  if (begin == std::string::npos || end == std::string::npos) {
    throw std::runtime_error(path + ": no block from " + std::string(kBegin.substr(0, kBegin.size() - 1)) +
                             " to " + std::string(kEnd.substr(0, kEnd.size() - 1)));
  }
  return page.replace(begin + kBegin.size(), end - begin - kBegin.size(), block());
}

bool is_up_to_date(const std::string& path) {
  if (contents(path) == filled_in(path)) return true;
  std::cerr << path << ": not up to date; write it again with spu_instruction_document " << path << "\n";
  return false;
}

}  // namespace
}  // namespace softcell::spu_model

int main(int count, char** arguments) {
  using namespace softcell;
  try {
    if (count == 3 && std::string_view(arguments[1]) == "--check") {
      return spu_model::is_up_to_date(arguments[2]) ? 0 : 1;
    }
    if (count == 2 && !std::string_view(arguments[1]).starts_with("--")) {
      const std::string page = spu_model::filled_in(arguments[1]);
      if (std::ofstream(arguments[1]) << page << std::flush) return 0;
      throw std::runtime_error(std::string("cannot write ") + arguments[1]);
    }
    std::cerr << "usage: spu_instruction_document [--check] FILE\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "spu_instruction_document: " << error.what() << "\n";
    return 1;
  }
}
