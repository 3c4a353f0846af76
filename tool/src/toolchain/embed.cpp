#include "embed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace softcell::toolchain {
namespace {

bool is_identifier(const std::string& text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// The text as a string of the assembler.
std::string quoted(const std::string& text) {
  std::string result(1, '"');
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  result += '"';
  return result;
}

void require_program(const std::string& file) {
  std::array<char, 20> header{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::invalid_argument("cannot read " + file);
  stream.read(header.data(), header.size());
  constexpr char kSpuMachine = 23;
  const bool is_elf = stream && std::string_view(header.data(), 4) == "\177ELF";
  if (is_elf && header[18] == 0 && header[19] == kSpuMachine) {
    throw std::invalid_argument(
        file +
        " holds SPU instructions, which a PC program cannot run beside itself; compile its "
        "sources with softcell-spu-gcc, or run it by softcell spu run");
  }
  if (!is_elf) throw std::invalid_argument(file + " is no ELF file; embed what softcell-spu-gcc has linked");
  constexpr char kObject = 1, kExecutable = 2, k32Bits = 1, kHostMachine = 62;
  const bool is_softcells = header[4] == k32Bits && header[18] == kHostMachine && header[19] == 0;
  if (is_softcells && header[16] == kObject)
    throw std::invalid_argument(
        file + " is an object that was not linked; link it with softcell-spu-gcc, and embed the program");
  if (!is_softcells || header[16] != kExecutable)
    throw std::invalid_argument(file + " is no SPU program; embed what softcell-spu-gcc has linked");
}

/// The compiler of the PPU side; it assembles, so it knows the host.
std::string host_compiler() {
  const char* const wanted = std::getenv("SOFTCELL_PPU_CC");
  return wanted != nullptr && *wanted != '\0' ? wanted : "gcc";
}

}  // namespace

int embedspu(const Words& words) {
  Words names, options;
  for (const std::string& word : words) (word.starts_with('-') ? options : names).push_back(word);
  if (names.size() != 3)
    throw std::invalid_argument("usage: softcell-embedspu [OPTIONS] SYMBOL INPUT OUTPUT, as embedspu");
  for (const std::string& option : options) {
    if (option == "-m32")
      throw std::invalid_argument(
          "-m32: softcell's libspe2 has 64 bits; leave it out, for the PPU side's compiler too");
    if (!option.starts_with("-m") && !option.starts_with("-f") && !option.starts_with("-W") &&
        !option.starts_with("-g"))
      throw std::invalid_argument("unknown option " + option);
  }
  const std::string &symbol = names[0], &input = names[1], &output = names[2];
  if (!is_identifier(symbol)) throw std::invalid_argument(symbol + " is no name of a variable");
  require_program(input);
  ScratchFolder scratch;
  const auto source = scratch.file("program.s");
  // The same as softcell_embed_spu_program() writes; the file itself contains its checked image and its name.
  std::ofstream(source) << ".section .data.rel.ro, \"aw\"\n.balign 8\n.global " << symbol << "\n.type "
                        << symbol << ", @object\n.size " << symbol << ", 40\n"
                        << symbol << ":\n.long 40, 0\n.quad .Limage, 0, 0, .Lname\n"
                        << ".section .rodata\n.Lname: .asciz " << quoted(std::filesystem::path(input).stem())
                        << "\n"
                        << ".balign 128\n.Limage: .incbin " << quoted(std::filesystem::absolute(input))
                        << "\n"
                        << ".section .note.GNU-stack,\"\",%progbits\n";
  return run({host_compiler(), "-c", source, "-o", output});
}

int bin2s(const Words& words) {
  if (words.empty()) throw std::invalid_argument("usage: softcell-bin2s [-a ALIGNMENT] FILE");
  std::string alignment = "128";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "-a" && i + 1 < words.size()) {
      alignment = words[++i];
      continue;
    }
    std::string symbol = std::filesystem::path(words[i]).filename();
    for (char& c : symbol) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    if (!is_identifier(symbol)) symbol = '_' + symbol;
    if (!std::ifstream(words[i])) throw std::invalid_argument("cannot read " + words[i]);
    std::printf(
        ".section .rodata\n.balign %s\n.global %s, %s_end, %s_size\n%s: .incbin %s\n%s_end:\n.balign "
        "4\n%s_size: .long %s_end - %s\n",
        alignment.c_str(), symbol.c_str(), symbol.c_str(), symbol.c_str(), symbol.c_str(),
        quoted(std::filesystem::absolute(words[i])).c_str(), symbol.c_str(), symbol.c_str(), symbol.c_str(),
        symbol.c_str());
  }
  std::printf(".section .note.GNU-stack,\"\",%%progbits\n");
  return 0;
}

}  // namespace softcell::toolchain
