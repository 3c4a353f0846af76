// softcell_vector_casts: reads the preprocessed source of a C kernel and writes it with SPU vectors as the host's C compiler needs them.
//
//   softcell_vector_casts name.i name.softcell.i
//
// - A cast between vector types, `(vec_uchar16)x`, reinterprets a register's sixteen bytes. The compiler's own cast would show the
//   host's byte order in each lane, so that the cast becomes a call of softcell_regroup() (softcell_c_types.h).
// - `(vec_uint4)(1, 2, 3, 4)`, the old spelling of a literal, becomes one with braces.
// - `vector` before a type's name becomes the attribute. Elsewhere it stays what it is: a name.
//
// Lines stay where they are, so that the compiler's messages and the debugger name those of the source. C++ needs none of this: its
// vectors are classes.

#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
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

std::vector<Token> tokens_of(std::string_view s) {
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
      end = end_of_literal(s, at);
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 ||
               (c == '.' && at + 1 < s.size() && std::isdigit(static_cast<unsigned char>(s[at + 1])) != 0)) {
      kind = Token::kNumber;
      while (end < s.size() && (is_word(s[end]) || s[end] == '.' ||
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

const std::set<std::string, std::less<>> kScalarWords = {"unsigned", "signed", "char",   "short", "int",
                                                         "long",     "float",  "double", "bool"};
const std::set<std::string, std::less<>> kQualifiers = {"const", "volatile", "__const", "__volatile__",
                                                        "register"};
/// Words behind which an expression begins.
const std::set<std::string, std::less<>> kBeforeExpression = {"return", "else", "do", "case"};

class Rewriter {
 public:
  explicit Rewriter(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  std::string run() {
    while (at_ < tokens_.size()) step();
    return std::move(out_);
  }

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
    if (t.kind == Token::kLine && t.text.find('"') != std::string::npos)
      foreign_ = t.text.find(" 3", t.text.rfind('"')) != std::string::npos;
    if (is_blank(t)) return;
    if (t.text == "{") {
      // Behind a parameter list a function's body begins; all else at this level is a declaration or an initialiser.
      if (depth_++ == 0) in_function_ = last_ == ")";
    } else if (t.text == "}") {
      if (--depth_ == 0) in_function_ = false;
    } else if (t.text == "typedef") {
      typedef_ = true;
    } else if (t.text == ";" && typedef_ && depth_ == typedef_depth_) {
      typedef_ = false;
    }
    if (t.text == "typedef") typedef_depth_ = depth_;
    last_ = t.text;
    last_kind_ = t.kind;
  }

  void step() {
    const Token& t = tokens_[at_];
    if (foreign_) return copy();
    if (t.kind == Token::kWord && t.text == "vector" && names_scalar(skip_blanks(at_ + 1))) {
      out_ += "__attribute__((vector_size(16)))";
      last_ = "vector";
      ++at_;
      return;
    }
    if (t.kind == Token::kWord && typedef_ && vectors_.count(last_) != 0 && is(skip_blanks(at_ + 1), ";")) {
      vectors_.insert(t.text);  // typedef vec_float4 point;
    }
    if (t.text == "(" && may_begin_a_cast()) {
      std::string type;
      if (const std::size_t behind = vector_type_in_parentheses(at_, type); behind != 0) {
        const std::size_t operand = skip_blanks(behind);
        if (is(operand, "(") && has_comma(operand)) {
          literal(type, behind);
          return;
        }
        if (in_function_ && begins_operand(operand)) {
          cast(type, behind);
          return;
        }
      }
    }
    copy();
  }

  bool names_scalar(std::size_t at) const {
    return at < tokens_.size() && kScalarWords.count(tokens_[at].text) != 0;
  }

  /// Not behind a name or a value: that is a call, a parameter list, or sizeof.
  bool may_begin_a_cast() const {
    if (last_kind_ == Token::kWord) return kBeforeExpression.count(last_) != 0;
    return last_kind_ != Token::kNumber && last_ != "]" && last_ != ")";
  }

  /// `( [qualifiers] vector type [qualifiers] )`. @return  the token behind it, or 0.
  std::size_t vector_type_in_parentheses(std::size_t at, std::string& type) const {
    bool found = false;
    type.clear();
    for (at = skip_blanks(at + 1); at < tokens_.size(); at = skip_blanks(at + 1)) {
      const std::string& word = tokens_[at].text;
      if (word == ")") return found ? at + 1 : 0;
      if (kQualifiers.count(word) != 0) continue;
      if (found) {
        if (!spelt_out_ || kScalarWords.count(word) == 0) return 0;
        type += " " + word;
      } else if (vectors_.count(word) != 0) {
        type = word;
        found = true;
        spelt_out_ = false;
      } else if ((word == "vector" || word == "__vector" || word == "__vector__") &&
                 names_scalar(skip_blanks(at + 1))) {
        type = "__attribute__((vector_size(16)))";
        found = true;
        spelt_out_ = true;
      } else if (word == "__attribute__" && is_vector_attribute(at)) {
        type = "__attribute__((vector_size(16)))";
        found = true;
        spelt_out_ = true;
        at = behind_parentheses(skip_blanks(at + 1)) - 1;
      } else {
        return 0;
      }
    }
    return 0;
  }

  /// What __vector has become by preprocessing.
  bool is_vector_attribute(std::size_t at) const {
    std::string text;
    const std::size_t begin = skip_blanks(at + 1);
    if (!is(begin, "(")) return false;
    for (std::size_t i = begin; i < behind_parentheses(begin); ++i)
      if (!is_blank(tokens_[i])) text += tokens_[i].text;
    return text == "((vector_size(16)))" || text == "((__vector_size__(16)))";
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

  /// Whether the parentheses that begin here hold a comma of their own.
  bool has_comma(std::size_t at) const {
    int depth = 0;
    for (const std::size_t end = behind_parentheses(at); at < end; ++at) {
      const std::string& text = tokens_[at].text;
      if (text == "(" || text == "[" || text == "{") ++depth;
      if (text == ")" || text == "]" || text == "}") --depth;
      if (text == "," && depth == 1) return true;
    }
    return false;
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

  void literal(const std::string& type, std::size_t behind) {
    const std::size_t open = skip_blanks(behind), close = behind_parentheses(open) - 1;
    out_ += "(" + type + ")";
    blanks(at_, open);
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

  void cast(const std::string& type, std::size_t behind) {
    out_ += "__extension__({ __auto_type softcell_v = (";
    blanks(at_, behind);
    at_ = behind;
    last_ = "(";
    last_kind_ = Token::kSign;
    operand();
    out_ += "); (" + type +
            ")softcell_regroup((vec_uchar16)softcell_v, (sizeof softcell_v[0] - 1) ^ (sizeof((" + type +
            "){0})[0] - 1)); })";
    last_ = ")";
    last_kind_ = Token::kSign;
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
      std::string type;
      const std::size_t behind = vector_type_in_parentheses(at_, type);
      if (behind != 0 && begins_operand(skip_blanks(behind)) &&
          !(is(skip_blanks(behind), "(") && has_comma(skip_blanks(behind)))) {
        cast(type, behind);
        return;
      }
      const std::size_t end = behind_parentheses(at_);
      const std::size_t next = skip_blanks(end);
      if (behind != 0 && is(next, "(")) {
        literal(type, behind);
      } else {
        copy();
        rewrite_to(end);
        if (next < tokens_.size() &&
            (tokens_[next].kind == Token::kWord || tokens_[next].kind == Token::kNumber || is(next, "{"))) {
          if (!is(next, "{")) return operand();  // a cast to a scalar or a pointer
          const std::size_t end_of_literal = behind_parentheses(next);
          rewrite_to(end_of_literal);
        }
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
  std::set<std::string, std::less<>> vectors_ = {"vec_uchar16", "vec_char16",  "vec_ushort8", "vec_short8",
                                                 "vec_uint4",   "vec_int4",    "vec_ullong2", "vec_llong2",
                                                 "vec_float4",  "vec_double2", "qword"};
  std::size_t at_ = 0;
  std::string out_;
  std::string last_;
  Token::Kind last_kind_ = Token::kSign;
  int depth_ = 0, typedef_depth_ = 0;
  bool in_function_ = false, typedef_ = false, foreign_ = false;
  mutable bool spelt_out_ = false;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::cerr << "usage: softcell_vector_casts PREPROCESSED OUTPUT\n";
    return 2;
  }
  std::ifstream in(arguments[1], std::ios::binary);
  const std::string source{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) {
    std::cerr << "softcell_vector_casts: " << arguments[1] << " cannot be read\n";
    return 1;
  }
  std::ofstream out(arguments[2], std::ios::binary);
  out << Rewriter(tokens_of(source)).run();
  if (!out.flush()) {
    std::cerr << "softcell_vector_casts: " << arguments[2] << " cannot be written\n";
    return 1;
  }
  return 0;
}
