#pragma once
// What is wrong with a command line, in words: the parser's own say neither where nor what is there instead.

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softcell::demos {

/// The verb that was called, from the top: "softcell spu run".
std::string called_verb(const CLI::App& top);

/// @param top  the parser that has thrown the error.
std::string usage_sentence(const CLI::App& top, const CLI::ParseError& error);

/// For a verb that has others below it and was called without: what there is to do.
std::string verbs_sentence(const CLI::App& top);

}  // namespace softcell::demos
