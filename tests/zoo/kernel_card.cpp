#include "kernel_card.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace softcell::zoo {
namespace {

constexpr std::string_view kComment = "// ";
constexpr std::string_view kMarker = "// BROKEN";

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; stream >> part;) {
    if (part.back() == ',') part.pop_back();
    parts.push_back(part);
  }
  return parts;
}

/// @return  false when no key of that name exists.
bool set(KernelCard& card, const std::string& key, const std::string& value) {
  if (key == "rule") {
    card.rule = value;
  } else if (key == "names") {
    card.names = value;
  } else if (key == "twin") {
    card.twin = value;
  } else if (key == "keeps") {
    card.keeps = split_at_commas(value);
  } else if (key == "build") {
    card.build = value;
  } else if (key == "envp") {
    card.envp = value;
  } else if (key == "ppu") {
    card.ppu = value;
  } else if (key == "spes") {
    card.spes = std::stoi(value);
  } else if (key == "deadline") {
    card.deadline_ms = std::stoi(value);
  } else {
    return false;
  }
  return true;
}

bool is_key(std::string_view word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

}  // namespace

KernelCard read_card(const std::filesystem::path& source) {
  std::ifstream file(source);
  if (!file) throw std::runtime_error("cannot read " + source.string());
  KernelCard card;
  card.kind = source.parent_path().filename().string();
  card.name = source.stem().string();
  const auto refuse = [&](int line, const std::string& why) {
    throw std::runtime_error(source.string() + ":" + std::to_string(line) + ": " + why);
  };

  bool in_head = true;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.find(kMarker) != std::string::npos) {
      if (card.broken_line != 0) refuse(number, "a second marker BROKEN");
      card.broken_line = number;
    }
    in_head = in_head && line.starts_with(kComment);
    if (!in_head) continue;
    line.erase(0, kComment.size());
    const std::size_t colon = line.find(": ");
    if (card.text.empty() && colon != std::string::npos && is_key(std::string_view(line).substr(0, colon))) {
      if (!set(card, line.substr(0, colon), line.substr(colon + 2))) refuse(number, "no such key");
    } else {
      card.text += (card.text.empty() ? "" : " ") + line;
    }
  }
  if (card.text.empty()) refuse(1, "the head does not say what the kernel is about");
  if ((card.kind == "broken") != (card.broken_line != 0)) {
    refuse(1, "broken kernels have one marker BROKEN, legal ones none");
  }
  return card;
}

std::vector<KernelCard> read_cards(const std::string& kind) {
  std::vector<std::filesystem::path> sources;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(ZOO_SOURCES) / kind)) {
    if (entry.path().extension() == ".cpp") sources.push_back(entry.path());
  }
  std::sort(sources.begin(), sources.end());
  std::vector<KernelCard> cards;
  for (const auto& source : sources) cards.push_back(read_card(source));
  return cards;
}

}  // namespace softcell::zoo
