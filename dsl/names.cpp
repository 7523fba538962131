#include "dsl/names.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace tightrope::dsl {
namespace {

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& sorted, std::string_view name) {
  return std::binary_search(sorted.begin(), sorted.end(), name);
}

constexpr std::array<std::string_view, 92> cpp_keywords = {
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
    "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
    "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
    "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
    "xor_eq",
};

/// Macros of the standard library and of compilers that plausible names would meet.
constexpr std::array<std::string_view, 12> macros = {"EOF",   "HUGE_VAL", "INFINITY", "NAN",   "NULL",   "assert",
                                                     "errno", "linux",    "stderr",   "stdin", "stdout", "unix"};

constexpr std::array<std::string_view, 28> generated_names = {"Bound",
                                                              "Bounded",
                                                              "Lanes",
                                                              "Real",
                                                              "Sign",
                                                              "State",
                                                              "bound",
                                                              "certain_nonnegative",
                                                              "certain_nonzero",
                                                              "choose",
                                                              "generated",
                                                              "in_range",
                                                              "lanes",
                                                              "magnitude",
                                                              "make_uncertain",
                                                              "max_magnitude",
                                                              "maximum",
                                                              "minimum",
                                                              "multiply_add",
                                                              "normalizer",
                                                              "product",
                                                              "real",
                                                              "result",
                                                              "sign",
                                                              "square_root",
                                                              "state",
                                                              "std",
                                                              "tightrope"};

static_assert(std::is_sorted(cpp_keywords.begin(), cpp_keywords.end()));
static_assert(std::is_sorted(macros.begin(), macros.end()));
static_assert(std::is_sorted(generated_names.begin(), generated_names.end()));

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::string_view cpp_objection(std::string_view name) {
  if (contains(cpp_keywords, name)) return "is a keyword of C++";
  if (contains(macros, name)) return "is a macro of C++";
  if (name.find("__") != std::string_view::npos) return "contains `__`, which C++ reserves";
  if (name.size() > 1 && name[0] == '_' && std::isupper(static_cast<unsigned char>(name[1])) != 0) {
    return "starts with `_` and a capital letter, which C++ reserves";
  }
  return {};
}

bool is_generated_name(std::string_view name) { return contains(generated_names, name); }

std::string fold_white_space(std::string_view text) {
  std::string folded;
  bool blank = false;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i, 2) == "//") {
      i = std::min(text.find('\n', i), text.size());
      blank = true;
    } else if (text.substr(i, 2) == "/*") {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
      blank = true;
    } else if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      ++i;
      blank = true;
    } else {
      if (blank && !folded.empty()) folded += ' ';
      blank = false;
      folded += text[i++];
    }
  }
  return folded;
}

std::string output_name(std::string_view folded_text) {
  std::string name;
  for (const char c : folded_text) {
    if (is_word(c) && c != '_') {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (!name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(name.begin(), 'n');
  return name;
}

}  // namespace tightrope::dsl
