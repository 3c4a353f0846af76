#pragma once
// What is wrong with a command line, in words: the parser's own say neither where nor what is there instead.

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace softcell::tool {

/// The verb that was called, from the top: "softcell spu run".
std::string called_verb(const CLI::App& top);

/// What to say of a word that stands where a verb is expected.
/// @param verb  the one above, from the top: "softcell spu"  @param app  its parser
std::string unknown_verb(const std::string& verb, const CLI::App& app, const std::string& argument);

/// @param top  the parser that has thrown the error.
std::string usage_sentence(const CLI::App& top, const CLI::ParseError& error);

/// The command line begins with a verb that this build has not: what to say of it.
/// @param top       the parser that has thrown an error.
/// @param left_out  such verbs
std::optional<std::string> left_out_sentence(const CLI::App& top, std::span<const std::string_view> left_out);

/// The parser takes "-headless" for -h with something behind it: such a word is an option that there is not.
/// @param top  the parser that was asked for help by these arguments.
std::optional<std::string> more_behind_help(const CLI::App& top, int argc, const char* const* argv);

/// The option with a value of no characters, which the parser takes for none. A regular expression may be
/// empty.
std::optional<std::string> empty_value(const CLI::App& top);

/// For a verb that has others below it and was called without: what there is to do.
std::string verbs_sentence(const CLI::App& top);

}  // namespace softcell::tool
