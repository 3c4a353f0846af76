// softcell_vector_casts: reads the preprocessed source of a C kernel and writes it with SPU vectors as the host's C compiler needs them.
//
//   softcell_vector_casts [--c++] name.i name.softcell.i [FOLDER...]
//
// - A cast between vector types, `(vec_uchar16)x`, reinterprets a register's sixteen bytes. The compiler's own cast would show the
//   host's byte order in each lane, so that the cast becomes a call of softcell_regroup() (softcell_c_types.h).
// - `(vec_uint4)(1, 2, 3, 4)`, the old spelling of a literal, becomes one with braces.
// - A literal that initialises static data, `static const vector float v = ((vec_float4){1, 2, 3, 4})`, becomes its braces alone: the
//   host's compiler takes a literal there only if it is spelled as the variable's type is, and that is not const.
// - `vector` before a type's name becomes the attribute. Elsewhere it stays what it is: a name.
//
// The compiler takes headers in the folders for those of a system, of which it says no warnings.
//
// OUTPUT.inline gets the names of functions that are defined inline and not static, one a line. Compilers of old C make an external
// function of each, those of newer C of none unless asked to, and programs rely on the one or the other. Here each source makes one, which
// is then made weak, so that it does not matter how many sources do.
//
// Lines stay where they are, so that the compiler's messages and the debugger name those of the source.
//
// In C++ vectors are classes, which do all of that by themselves, except for two spellings: `vector unsigned int` becomes the name of its
// class, `vec_uint4`, and literals in parentheses get braces.

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

struct Token {
  enum Kind { kSpace, kWord, kNumber, kText, kSign, kLine } kind;
  std::string text;
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$'; }

/// The end of a string or character literal that begins at `at`.
std::size_t end_of_literal(std::string_view s, std::size_t at) {
  const char quote = s[at];
  for (++at; at < s.size() && s[at] != quote && s[at] != '\n'; ++at) {
    if (s[at] == '\\') ++at;
  }
  return at < s.size() ? at + 1 : s.size();
}

/// The end of R"word(...)word", whose quotation mark is at `at`.
std::size_t end_of_raw_string(std::string_view s, std::size_t at) {
  const std::size_t open = s.find('(', at);
  if (open == std::string_view::npos) return s.size();
  const std::string close = ")" + std::string(s.substr(at + 1, open - at - 1)) + "\"";
  const std::size_t end = s.find(close, open);
  return end == std::string_view::npos ? s.size() : end + close.size();
}

std::vector<Token> tokens_of(std::string_view s, bool is_cxx) {
  std::vector<Token> tokens;
  bool line_begins = true;
  for (std::size_t at = 0; at < s.size();) {
    std::size_t end = at + 1;
    Token::Kind kind = Token::kSign;
    const char c = s[at];
    if (c == '#' && line_begins) {  // where the lines come from, and pragmas
      kind = Token::kLine;
      end = s.find('\n', at);
      if (end == std::string_view::npos) end = s.size();
    } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      kind = Token::kSpace;
    } else if (c == '"' || c == '\'') {
      kind = Token::kText;
      const bool is_raw = c == '"' && !tokens.empty() && tokens.back().kind == Token::kWord &&
                          tokens.back().text.back() == 'R';
      end = is_raw ? end_of_raw_string(s, at) : end_of_literal(s, at);
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 ||
               (c == '.' && at + 1 < s.size() && std::isdigit(static_cast<unsigned char>(s[at + 1])) != 0)) {
      kind = Token::kNumber;
      while (end < s.size() && (is_word(s[end]) || s[end] == '.' ||
                                (is_cxx && s[end] == '\'' && end + 1 < s.size() && is_word(s[end + 1])) ||
                                ((s[end] == '+' || s[end] == '-') &&
                                 std::string_view("eEpP").find(s[end - 1]) != std::string_view::npos)))
        ++end;
    } else if (is_word(c)) {
      kind = Token::kWord;
      while (end < s.size() && is_word(s[end])) ++end;
    } else {
      for (const std::string_view sign : {"->", "++", "--", "&&", "||", "==", "!=", "<=", ">=", "<<", ">>"}) {
        if (s.substr(at, 2) == sign) end = at + 2;
      }
    }
    if (kind != Token::kSpace) line_begins = false;
    if (c == '\n' || kind == Token::kLine) line_begins = true;
    tokens.push_back({kind, std::string(s.substr(at, end - at))});
    at = end;
  }
  return tokens;
}

using Names = std::set<std::string, std::less<>>;

const Names kScalarWords = {"unsigned", "signed", "__signed__", "char",  "short",   "int",
                            "long",     "float",  "double",     "_Bool", "__int128"};
const Names kQualifiers = {"const",      "volatile", "restrict",  "__const",    "__volatile__",
                           "__restrict", "register", "__const__", "__volatile", "__restrict__"};
/// Words behind which an expression begins.
const Names kBeforeExpression = {"return", "else", "do", "case"};

/// What a type's name says.
struct Type {
  std::string text;          ///< as the host's compiler is to read it
  bool is_vector = false;    ///< of sixteen bytes
  bool is_of_value = false;  ///< __typeof__(value): only the compiler knows
  std::size_t lanes = 0;     ///< of a vector of such lanes; 0 if that is not known
};

/// The vectors that an SPU has, and the bytes of their lanes.
constexpr std::pair<std::string_view, int> kVectors[] = {
    {"unsigned char", 1},      {"signed char", 1}, {"char", 1},  {"unsigned short", 2}, {"short", 2},
    {"unsigned int", 4},       {"int", 4},         {"float", 4}, {"unsigned long", 4},  {"long", 4},
    {"unsigned long long", 8}, {"long long", 8},   {"double", 8}};

/// The lanes of a vector of a scalar, from the scalar's words.
std::size_t lanes_of(const std::multiset<std::string>& words) {
  if (words.count("char") != 0 || words.count("_Bool") != 0) return 16;
  if (words.count("short") != 0) return 8;
  return words.count("double") != 0 || words.count("long") == 2 ? 2 : 4;
}

/// The class of a vector in C++, from the scalar's words.
std::string class_of(const std::multiset<std::string>& words) {
  const bool is_unsigned = words.count("unsigned") != 0;
  if (words.count("float") != 0) return "vec_float4";
  if (words.count("double") != 0) return "vec_double2";
  if (words.count("char") != 0)  // plain ones have no sign on an SPU
    return words.count("signed") + words.count("__signed__") == 0 ? "vec_uchar16" : "vec_char16";
  if (words.count("short") != 0) return is_unsigned ? "vec_ushort8" : "vec_short8";
  if (words.count("long") == 2) return is_unsigned ? "vec_ullong2" : "vec_llong2";
  return is_unsigned ? "vec_uint4" : "vec_int4";
}
const std::map<std::string, std::size_t, std::less<>> kLanesOfClasses = {
    {"vec_uchar16", 16}, {"vec_char16", 16}, {"vec_ushort8", 8}, {"vec_short8", 8}, {"vec_uint4", 4},
    {"vec_int4", 4},     {"vec_float4", 4},  {"vec_ullong2", 2}, {"vec_llong2", 2}, {"vec_double2", 2}};

class Rewriter {
 public:
  Rewriter(std::vector<Token> tokens, bool is_cxx, std::vector<std::string> system_folders)
      : tokens_(std::move(tokens)), is_cxx_(is_cxx), system_folders_(std::move(system_folders)) {}

  std::string run() {
    while (at_ < tokens_.size()) step();
    return std::move(out_);
  }

  const std::string& inline_functions() const { return inline_functions_; }

 private:
  static bool is_blank(const Token& t) { return t.kind == Token::kSpace || t.kind == Token::kLine; }
  bool is(std::size_t at, std::string_view text) const {
    return at < tokens_.size() && tokens_[at].text == text;
  }
  std::size_t skip_blanks(std::size_t at) const {
    while (at < tokens_.size() && is_blank(tokens_[at])) ++at;
    return at;
  }

  /// Copies a token and keeps the books of where we are.
  void copy() {
    if (at_ >= tokens_.size()) return;  // a source that breaks off
    const Token& t = tokens_[at_++];
    out_ += t.text;
    // # <line> "<file>" <flags>: the flag 3 is that of headers which are not the user's.
    if (t.kind == Token::kLine && t.text.find('"') != std::string::npos) {
      foreign_ = t.text.find(" 3", t.text.rfind('"')) != std::string::npos;
      if (!foreign_ && is_in_system_folder(t.text)) out_ += " 3";
    }
    if (is_blank(t)) return;
    if (depth_ == 0) note_declaration(t);
    if (t.text == "{") {
      // A function's body begins behind a parameter list, or behind the declarations of K&R's parameters; all else at this level is a
      // declaration or an initialiser.
      if (depth_++ == 0) in_function_ = last_ == ")" || last_ == ";";
      if (depth_ == 1 && in_function_) is_static_ = false;
    } else if (t.text == "}") {
      if (--depth_ == 0) in_function_ = false;
    } else if (t.text == "typedef" && !is_cxx_) {
      note_types(at_);
    } else if (t.text == "static") {
      is_static_ = true;
    } else if (t.text == ";") {
      is_static_ = false;
    }
    last_ = t.text;
    last_kind_ = t.kind;
  }

  /// Outside of functions: whether a function is being defined inline, and its name, which is the first one in front of a parenthesis.
  void note_declaration(const Token& t) {
    if (t.text == ";" || t.text == "}") {
      declared_ = {};
    } else if (t.text == "static" || t.text == "extern") {
      declared_.is_inline_here = false;
      declared_.may_be_inline_here = false;
    } else if (t.text == "inline" || t.text == "__inline__" || t.text == "__inline") {
      declared_.is_inline_here = declared_.may_be_inline_here;
    } else if (t.text == "(" && declared_.name.empty() && last_kind_ == Token::kWord &&
               last_.substr(0, 11) != "__attribute" && last_.find("typeof") == std::string::npos) {
      declared_.name = last_;
    } else if (t.text == "{") {
      const bool is_function = last_ == ")" || last_ == ";";
      if (is_function && declared_.is_inline_here && !declared_.name.empty())
        inline_functions_ += declared_.name + "\n";
      declared_ = {};
    }
  }

  bool is_in_system_folder(std::string_view marker) const {
    const std::string_view file = marker.substr(marker.find('"') + 1);
    return std::any_of(system_folders_.begin(), system_folders_.end(), [&](const std::string& folder) {
      return file.substr(0, folder.size() + 1) == folder + "/";
    });
  }

  void step() {
    if (is_cxx_) return cxx_step();
    const Token& t = tokens_[at_];
    if (!foreign_ && t.kind == Token::kWord && t.text == "vector" && names_scalar(skip_blanks(at_ + 1))) {
      out_ += "__attribute__((vector_size(16)))";
      last_ = "vector";
      ++at_;
      return;
    }
    // Also where it is the expansion of a header's macro.
    if (t.text == "(" && initialises_static_data() && braces_of_literal()) return;
    if (foreign_) return copy();
    if (t.text == "(" && may_begin_a_cast()) {
      Type type;
      if (const std::size_t behind = vector_in_parentheses(at_, type); behind != 0) {
        if (is_literal(type, skip_blanks(behind))) return literal(type, behind);
        if (in_function_ && may_be_vector(type, skip_blanks(behind))) return cast(type, behind);
      }
    }
    copy();
  }

  void cxx_step() {
    std::string name;
    if (foreign_) return copy();
    if (const std::size_t behind = vector_class(at_, name); behind != at_) {
      out_ += name;
      blanks(at_, behind);
      at_ = behind;
      last_ = name;
      last_kind_ = Token::kWord;
      return;
    }
    if (tokens_[at_].text == "(" && may_begin_a_cast()) {
      const std::size_t begin = skip_blanks(at_ + 1);
      std::size_t behind = vector_class(begin, name);
      if (behind == begin && begin < tokens_.size() && kLanesOfClasses.count(tokens_[begin].text) != 0)
        name = tokens_[behind++].text;
      const std::size_t close = skip_blanks(behind), open = skip_blanks(close + 1);
      if (behind != begin && is(close, ")") && is(open, "(") && commas(open) + 1 == kLanesOfClasses.at(name))
        return literal({.text = name}, close + 1);
    }
    copy();
  }

  /// `vector` or `__vector` and a scalar's words. @return  the token behind them, or `at`
  std::size_t vector_class(std::size_t at, std::string& name) const {
    if (!is(at, "vector") && !is(at, "__vector")) return at;
    std::multiset<std::string> words;
    std::size_t behind = at;
    for (std::size_t next = skip_blanks(at + 1); names_scalar(next); next = skip_blanks(next + 1)) {
      words.insert(tokens_[next].text);
      behind = next + 1;
    }
    if (!words.empty()) name = class_of(words);
    return behind;
  }

  bool names_scalar(std::size_t at) const {
    return at < tokens_.size() && kScalarWords.count(tokens_[at].text) != 0;
  }

  bool initialises_static_data() const {
    return (!in_function_ || is_static_) && (last_ == "=" || last_ == "{" || last_ == ",");
  }

  /// Writes a vector's literal, perhaps in more parentheses, as its braces if it is all that initialises something here.
  bool braces_of_literal() {
    std::size_t begin = at_, behind = 0, around = 0;
    Type type;
    for (; (behind = vector_in_parentheses(begin, type)) == 0; ++around, type = {}) {
      begin = skip_blanks(begin + 1);
      if (!is(begin, "(")) return false;
    }
    const std::size_t open = skip_blanks(behind);
    if (!is(open, "{") && !is_literal(type, open)) return false;
    std::size_t end = behind_parentheses(open);
    const std::size_t close = end - 1;
    for (; around != 0; --around) {
      end = skip_blanks(end);
      if (!is(end, ")")) return false;
      ++end;
    }
    const std::size_t next = skip_blanks(end);
    if (!is(next, ",") && !is(next, ";") && !is(next, "}")) return false;
    blanks(at_, open);
    braces(open, close);
    blanks(close, end);
    at_ = end;
    return true;
  }

  /// Not behind a name or a value: that is a call, a parameter list, or sizeof.
  bool may_begin_a_cast() const {
    if (last_kind_ == Token::kWord) return kBeforeExpression.count(last_) != 0;
    return last_kind_ != Token::kNumber && last_ != "]" && last_ != ")";
  }

  bool is_attribute(std::size_t at) const { return is(at, "__attribute__") || is(at, "__attribute"); }

  /// What __vector has become by preprocessing, alone or with other attributes.
  bool is_vector_attribute(std::size_t at) const {
    std::string text;
    for (const std::size_t end = behind_parentheses(skip_blanks(at + 1)); at < end; ++at)
      if (!is_blank(tokens_[at])) text += tokens_[at].text;
    return text.find("vector_size(16)") != std::string::npos ||
           text.find("vector_size__(16)") != std::string::npos;
  }

  /// Reads qualifiers, attributes and the names of a scalar or a vector. @return  the token behind them.
  std::size_t specifiers(std::size_t at, Type& type) const {
    std::multiset<std::string> scalar;
    bool has_name = false;
    const auto add = [&type](const std::string& text) { type.text += (type.text.empty() ? "" : " ") + text; };
    for (at = skip_blanks(at); at < tokens_.size(); at = skip_blanks(at + 1)) {
      const std::string& word = tokens_[at].text;
      if (kQualifiers.count(word) != 0) continue;
      if (is_attribute(at)) {
        if (is_vector_attribute(at)) {
          type.is_vector = true;
          add("__attribute__((vector_size(16)))");
        }
        at = behind_parentheses(skip_blanks(at + 1)) - 1;
      } else if (word == "vector" && names_scalar(skip_blanks(at + 1))) {
        type.is_vector = true;
        add("__attribute__((vector_size(16)))");
      } else if (has_name) {
        break;
      } else if (kScalarWords.count(word) != 0) {
        scalar.insert(word);
        add(word);
      } else if (!scalar.empty()) {
        break;
      } else if (const auto known = types_.find(word); known != types_.end()) {
        has_name = true;
        type.is_vector |= known->second.is_vector;
        type.is_of_value = known->second.is_of_value;
        type.lanes = known->second.lanes;
        add(word);
      } else if (word == "typeof" || word == "__typeof__" || word == "__typeof") {
        has_name = type.is_of_value = true;
        const std::size_t end = behind_parentheses(skip_blanks(at + 1));
        for (; at < end; ++at) type.text += is_blank(tokens_[at]) ? " " : tokens_[at].text;
        --at;
      } else {
        break;
      }
    }
    if (!scalar.empty()) type.lanes = lanes_of(scalar);
    return at;
  }

  /// `(vector type)`, or what may be one. @return  the token behind it, or 0.
  std::size_t vector_in_parentheses(std::size_t at, Type& type) const {
    at = specifiers(at + 1, type);
    return is(at, ")") && (type.is_vector || type.is_of_value) ? at + 1 : 0;
  }

  /// Whether these are the parentheses of a cast or a compound literal, and no expression's.
  bool holds_type(std::size_t at) const {
    const std::string& word = tokens_[std::min(skip_blanks(at + 1), tokens_.size() - 1)].text;
    if (word == "struct" || word == "union" || word == "enum" || word == "void" ||
        kQualifiers.count(word) != 0)
      return true;
    Type type;
    return specifiers(at + 1, type) != skip_blanks(at + 1);
  }

  /// Notes the names that a typedef declares.
  void note_types(std::size_t at) {
    Type type;
    at = specifiers(at + 1, type);
    if (is(at, "struct") || is(at, "union") || is(at, "enum")) {
      while (at < tokens_.size() && !is(at, "{") && !is(at, ";") && !is(at, "*")) {
        const std::size_t next = skip_blanks(at + 1);
        if (is_attribute(at)) {
          at = behind_parentheses(next);
        } else if (next < tokens_.size() && tokens_[next].kind != Token::kWord && !is(next, "{")) {
          break;  // at the name that is declared
        } else {
          at = next;
        }
      }
      if (is(at, "{")) at = skip_blanks(behind_parentheses(at));
    } else if (is(at, "void") || (type.text.empty() && at < tokens_.size())) {
      ++at;  // void, or a type that the compiler knows by itself
    }
    while (at < tokens_.size() && !is(at, "}")) {
      at = note_declarator(at, type);
      if (is(at, ";")) return;
      ++at;
    }
  }

  /// One of them: the name itself is of the type, *name and name[4] are of another. @return  the token behind it.
  std::size_t note_declarator(std::size_t at, Type type) {
    std::string name;
    for (at = skip_blanks(at); at < tokens_.size(); at = skip_blanks(at + 1)) {
      const Token& t = tokens_[at];
      if (t.text == "," || t.text == ";" || t.text == "}") break;
      if (is_attribute(at)) {
        type.is_vector |= is_vector_attribute(at);
        at = behind_parentheses(skip_blanks(at + 1)) - 1;
      } else if (t.text == "(" || t.text == "[") {
        const std::size_t end = behind_parentheses(at);
        for (; name.empty() && at < end; ++at)
          if (tokens_[at].kind == Token::kWord && kQualifiers.count(tokens_[at].text) == 0)
            name = tokens_[at].text;  // (*name)(...)
        at = end - 1;
        type = {};
      } else if (t.text == "*") {
        type = {};
      } else if (t.kind == Token::kWord && kQualifiers.count(t.text) == 0) {
        name = t.text;
      }
    }
    if (!name.empty()) types_[name] = type;
    return at;
  }

  std::size_t behind_parentheses(std::size_t at) const {
    int depth = 0;
    for (; at < tokens_.size(); ++at) {
      const std::string& text = tokens_[at].text;
      if (text == "(" || text == "[" || text == "{") ++depth;
      if ((text == ")" || text == "]" || text == "}") && --depth == 0) return at + 1;
    }
    return tokens_.size();
  }

  /// How many commas of their own the parentheses that begin here hold.
  std::size_t commas(std::size_t at) const {
    std::size_t found = 0;
    int depth = 0;
    for (const std::size_t end = behind_parentheses(at); at < end; ++at) {
      const std::string& text = tokens_[at].text;
      if (text == "(" || text == "[" || text == "{") ++depth;
      if (text == ")" || text == "]" || text == "}") --depth;
      if (text == "," && depth == 1) ++found;
    }
    return found;
  }

  /// (type)(1, 2, 3, 4). With another number of values than lanes it is a cast of the last one, as a comma has it.
  bool is_literal(const Type& type, std::size_t operand) const {
    if (!type.is_vector || !is(operand, "(")) return false;
    const std::size_t found = commas(operand);
    return found != 0 && (type.lanes == 0 || found + 1 == type.lanes);
  }

  /// Whether a vector may be what is cast.
  bool may_be_vector(const Type& type, std::size_t operand) const {
    if (!begins_operand(operand)) return false;
    return type.is_vector || tokens_[operand].kind == Token::kWord || tokens_[operand].kind == Token::kSign;
  }

  bool begins_operand(std::size_t at) const {
    if (at >= tokens_.size()) return false;
    const Token& t = tokens_[at];
    if (t.kind == Token::kWord || t.kind == Token::kNumber) return true;
    for (const std::string_view sign : {"(", "*", "&", "-", "+", "~", "!", "++", "--"})
      if (t.text == sign) return true;
    return false;
  }

  /// Copies tokens, with what is in them rewritten, up to `end`.
  void rewrite_to(std::size_t end) {
    while (at_ < end) step();
  }

  void literal(const Type& type, std::size_t behind) {
    const std::size_t open = skip_blanks(behind), close = behind_parentheses(open) - 1;
    out_ += "(" + type.text + ")";
    blanks(at_, open);
    braces(open, close);
  }

  /// What lies between two tokens, in braces.
  void braces(std::size_t open, std::size_t close) {
    out_ += "{";
    at_ = open + 1;
    last_ = "{";
    last_kind_ = Token::kSign;
    rewrite_to(close);
    out_ += "}";
    last_ = "}";
    last_kind_ = Token::kSign;
    at_ = close + 1;
  }

  void cast(const Type& type, std::size_t behind) {
    out_ += "__extension__({ __auto_type softcell_v = (";
    if (type.is_of_value) out_ += "(void)0, ";  // a bit-field alone gives no type
    blanks(at_, behind);
    at_ = behind;
    last_ = "(";
    last_kind_ = Token::kSign;
    operand();
    if (type.is_vector) {
      out_ += "); (" + type.text +
              ")softcell_regroup((vec_uchar16)softcell_v, (sizeof softcell_v[0] - 1) ^ (sizeof((" +
              type.text + "){0})[0] - 1)); })";
    } else {
      out_ += "); (" + type.text + ")__builtin_choose_expr(" + lane_bytes("*(" + type.text + "*)0") +
              " == 0, softcell_v, softcell_regroup((vec_uchar16)" + vector_or_zero("softcell_v") + ", (" +
              lane_bytes("softcell_v") + " - 1) ^ (" + lane_bytes("*(" + type.text + "*)0") + " - 1))); })";
    }
    last_ = ")";
    last_kind_ = Token::kSign;
  }

  /// Of a vector, else 0.
  static std::string lane_bytes(const std::string& value) {
    return vectors_of(value, [](int bytes) { return std::to_string(bytes); }) + "default: 0)";
  }
  /// Of anything a vector.
  static std::string vector_or_zero(const std::string& value) {
    return vectors_of(value, [&](int) { return value; }) + "default: (vec_uchar16){0})";
  }
  template <class Choice>
  static std::string vectors_of(const std::string& value, const Choice& choice) {
    std::string text = "_Generic(" + value + ", ";
    for (const auto& [words, bytes] : kVectors)
      text += "__attribute__((vector_size(16))) " + std::string(words) + ": " + choice(bytes) + ", ";
    return text;
  }

  /// The blanks among tokens that are written anew, so that lines stay where they are.
  void blanks(std::size_t from, std::size_t to) {
    for (; from < to; ++from)
      if (is_blank(tokens_[from])) out_ += tokens_[from].text;
  }

  /// A cast's operand: prefixes, a primary expression, and what follows it.
  void operand() {
    for (;;) {
      while (at_ < tokens_.size() && is_blank(tokens_[at_])) copy();
      if (at_ >= tokens_.size()) return;
      const std::string& text = tokens_[at_].text;
      if (text == "*" || text == "&" || text == "-" || text == "+" || text == "~" || text == "!" ||
          text == "++" || text == "--") {
        copy();
        continue;
      }
      break;
    }
    if (is(at_, "(")) {
      Type type;
      const std::size_t behind = vector_in_parentheses(at_, type);
      const std::size_t end = behind_parentheses(at_), next = skip_blanks(end);
      if (behind != 0 && is_literal(type, next)) {
        literal(type, behind);
      } else if (behind != 0 && may_be_vector(type, next)) {
        return cast(type, behind);
      } else if (holds_type(at_)) {
        rewrite_to(end);
        if (!is(next, "{")) return operand();  // a cast to a scalar or a pointer
        rewrite_to(behind_parentheses(next));
      } else {
        copy();
        rewrite_to(end);
      }
    } else {
      copy();
    }
    for (;;) {
      const std::size_t next = skip_blanks(at_);
      if (is(next, "[") || is(next, "(")) {
        rewrite_to(next);
        const std::size_t end = behind_parentheses(next);
        copy();
        rewrite_to(end);
      } else if (is(next, ".") || is(next, "->")) {
        rewrite_to(next);
        copy();
        rewrite_to(skip_blanks(at_));
        copy();
      } else if (is(next, "++") || is(next, "--")) {
        rewrite_to(next);
        copy();
      } else {
        return;
      }
    }
  }

  std::vector<Token> tokens_;
  bool is_cxx_;
  std::vector<std::string> system_folders_;
  std::map<std::string, Type, std::less<>> types_;
  std::size_t at_ = 0;
  std::string out_;
  std::string last_;
  Token::Kind last_kind_ = Token::kSign;
  int depth_ = 0;
  bool in_function_ = false, foreign_ = false;
  bool is_static_ = false;  ///< in a declaration that has the word static
  struct Declared {
    bool may_be_inline_here = true, is_inline_here = false;
    std::string name;
  };
  Declared declared_;
  std::string inline_functions_ = "# as objcopy --weaken-symbols reads them; it refuses an empty file\n";
};

}  // namespace

int main(int count, char** arguments) {
  const bool is_cxx = count > 1 && arguments[1] == std::string_view("--c++");
  if (is_cxx) ++arguments, --count;
  if (count < 3) {
    std::cerr << "usage: softcell_vector_casts [--c++] PREPROCESSED OUTPUT [FOLDER...]\n";
    return 2;
  }
  std::ifstream in(arguments[1], std::ios::binary);
  const std::string source{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) {
    std::cerr << "softcell_vector_casts: " << arguments[1] << " cannot be read\n";
    return 1;
  }
  Rewriter rewriter(tokens_of(source, is_cxx), is_cxx, {arguments + 3, arguments + count});
  const std::string output = arguments[2];
  for (const auto& [file, text] :
       {std::pair(output, rewriter.run()), std::pair(output + ".inline", rewriter.inline_functions())}) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) {
      std::cerr << "softcell_vector_casts: " << file << " cannot be written\n";
      return 1;
    }
  }
  return 0;
}
