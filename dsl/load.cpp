#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <unordered_map>
#include <vector>

#include "dsl/elaborate.h"
#include "dsl/parser.h"

namespace tightrope::dsl {
namespace {

/// The file's text, or why it cannot be had.
struct FileText {
  std::string text;
  std::string problem;
};

FileText read_file(const std::filesystem::path& path) {
  const auto problem = [](int number) { return FileText{{}, std::generic_category().message(number)}; };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return problem(EISDIR);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return problem(errno != 0 ? errno : ENOENT);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) return problem(errno != 0 ? errno : EIO);
  return {std::move(text), {}};
}

/// One name for a file however it is reached.
std::string identity(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path.lexically_normal().string() : canonical.string();
}

}  // namespace

Program load_program(const std::string& path, SourceMap& sources, Diagnostics& diagnostics,
                     const ElaborateOptions& options) {
  std::vector<Module> modules;
  std::unordered_map<std::string, std::uint32_t> loaded;
  // Where the file was asked for; line 1 of the main file itself.
  const auto load = [&](const std::filesystem::path& file, const SourceSpan* import) {
    if (!loaded.emplace(identity(file), sources.size()).second) return;
    FileText content = read_file(file);
    const bool readable = content.problem.empty();
    std::uint32_t index = 0;
    if (readable || import == nullptr) index = sources.add(file.string(), std::move(content.text));
    if (!readable) {
      const SourceSpan place = import != nullptr ? *import : SourceSpan{index, 0, 0};
      diagnostics.error(place, fmt::format("cannot read `{}`: {}", file.string(), content.problem));
    }
    if (readable || import == nullptr) modules.push_back(parse(sources, index, diagnostics));
  };
  load(path, nullptr);
  for (std::size_t m = 0; m < modules.size(); ++m) {
    const std::filesystem::path folder = std::filesystem::path(sources.file(modules[m].file).path).parent_path();
    const std::vector<ImportDecl> imports = modules[m].imports;  // `modules` grows meanwhile
    for (const ImportDecl& import : imports) load((folder / import.path).lexically_normal(), &import.span);
  }
  return elaborate(sources, modules, diagnostics.has_errors(), diagnostics, options);
}

}  // namespace tightrope::dsl
