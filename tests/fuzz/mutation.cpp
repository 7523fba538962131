#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

namespace tightrope::fuzz {

namespace {

constexpr std::array<std::string_view, 60> tokens{"predicate ",
                                                  "function ",
                                                  "instance ",
                                                  "import ",
                                                  "stage ",
                                                  "let ",
                                                  "sign ",
                                                  "value ",
                                                  "for ",
                                                  "in ",
                                                  "range ",
                                                  "property ",
                                                  "of ",
                                                  "as ",
                                                  "return ",
                                                  "bounded ",
                                                  "moving ",
                                                  "static ",
                                                  "scalar ",
                                                  "vec2 ",
                                                  "vec3 ",
                                                  "point ",
                                                  "point2 ",
                                                  "at ",
                                                  "(",
                                                  ")",
                                                  "[",
                                                  "]",
                                                  "{",
                                                  "}",
                                                  ",",
                                                  ";",
                                                  ":",
                                                  "=",
                                                  "<=",
                                                  "|",
                                                  ".",
                                                  "..",
                                                  "+",
                                                  "-",
                                                  "*",
                                                  "/",
                                                  "^",
                                                  "//",
                                                  "/*",
                                                  "*/",
                                                  "\"",
                                                  "0",
                                                  "1e308",
                                                  "1/3",
                                                  "diff(",
                                                  "cross(",
                                                  "dot(",
                                                  "split(",
                                                  "\xFF",
                                                  "\xE2\x82\xAC",
                                                  std::string_view("\0", 1),
                                                  "\r",
                                                  "\n",
                                                  "99999999999"};

std::size_t below(std::size_t bound, std::mt19937_64& random) { return bound == 0 ? 0 : random() % bound; }

/// A place in the text and a length from there, mostly short.
struct Piece {
  std::size_t begin, length;
};

Piece piece(const std::string& text, std::mt19937_64& random) {
  const std::size_t begin = below(text.size() + 1, random);
  const std::size_t longest = random() % 4 == 0 ? text.size() : 12;
  return {begin, below(std::min(longest, text.size() - begin) + 1, random)};
}

void mutate_once(std::string& text, const std::vector<std::string>& programs, std::mt19937_64& random) {
  const Piece p = piece(text, random);
  switch (random() % 8) {
    case 0:
      text.erase(p.begin, p.length);
      break;
    case 1:
      text.insert(p.begin, tokens[below(tokens.size(), random)]);
      break;
    case 2:
      text.insert(below(text.size() + 1, random), std::string(text, p.begin, p.length));
      break;
    case 3:
      text.replace(p.begin, p.length, tokens[below(tokens.size(), random)]);
      break;
    case 4:
      if (p.begin < text.size()) text[p.begin] = static_cast<char>(random());
      break;
    case 5:
      text.resize(p.begin);
      break;
    case 6: {
      const std::string& other = programs[below(programs.size(), random)];
      const Piece q = piece(other, random);
      text.insert(p.begin, other, q.begin, q.length);
      break;
    }
    default:
      if (p.begin + 1 < text.size()) std::swap(text[p.begin], text[p.begin + 1]);
  }
}

}  // namespace

std::vector<std::string> corpus() {
  namespace fs = std::filesystem;
  std::vector<fs::path> paths;
  for (const char* folder : {"ccd/predicates", "examples", "tests/errors"}) {
    const fs::path root = fs::path(TIGHTROPE_SOURCE_DIR) / folder;
    if (!fs::exists(root)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (entry.path().extension() == ".pred") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> programs;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    programs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return programs;
}

std::string mutate(std::string text, const std::vector<std::string>& programs, std::mt19937_64& random) {
  for (std::size_t left = 1 + below(8, random); left > 0; --left) mutate_once(text, programs, random);
  return text;
}

}  // namespace tightrope::fuzz
