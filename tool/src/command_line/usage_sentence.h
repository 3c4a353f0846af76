#pragma once
// Messages about mistakes in a command line. The parser's own messages state neither the place nor the alternatives.

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

/// The message about a word in the place of a verb.
/// @param verb  the verb above it, from the top: "softcell spu"  @param app  its parser
std::string unknown_verb(const std::string& verb, const CLI::App& app, const std::string& argument);

/// @param top  the parser that has thrown the error.
std::string usage_sentence(const CLI::App& top, const CLI::ParseError& error);

/// The message about a command line that begins with a verb that this build does not have.
/// @param top       the parser that has thrown an error.
/// @param left_out  the verbs that this build does not have
std::optional<std::string> left_out_sentence(const CLI::App& top, std::span<const std::string_view> left_out);

/// The message about a word such as "-headless", which the parser takes for -h with something after it: no such option exists.
/// @param top  the parser that was asked for help by these arguments.
std::optional<std::string> more_behind_help(const CLI::App& top, int argc, const char* const* argv);

/// The message about an option with an empty value, which the parser takes for no value. A regular expression may be empty.
std::optional<std::string> empty_value(const CLI::App& top);

/// The message for a verb that was called without one of the verbs below it: it lists these.
std::string verbs_sentence(const CLI::App& top);

}  // namespace softcell::tool
