#include "codegen/clang/parse.h"

#include <clang/Basic/Diagnostic.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Basic/Version.h>
#include <clang/Frontend/ASTUnit.h>
#include <clang/Tooling/Tooling.h>
#include <fmt/format.h>
#include <llvm/ADT/SmallString.h>
#include <llvm/Support/FileSystem.h>

namespace tightrope::codegen {
namespace {

class ErrorCollector : public clang::DiagnosticConsumer {
 public:
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) override {
    if (level < clang::DiagnosticsEngine::Error) return;
    llvm::SmallString<200> message;
    diagnostic.FormatDiagnostic(message);
    const std::string_view what(message.data(), message.size());
    if (diagnostic.hasSourceManager() && diagnostic.getLocation().isValid()) {
      text += error_at(diagnostic.getSourceManager(), diagnostic.getLocation(), what);
    } else {
      text += fmt::format("error: {}\n", what);
    }
  }
  std::string text;
};

ParsedCode parsed(const std::string& code, const std::string& file_name, const std::vector<std::string>& options,
                  const clang::tooling::FileContentMappings& files) {
  ErrorCollector errors;
  ParsedCode result;
  result.unit = clang::tooling::buildASTFromCodeWithArgs(
      code, options, file_name, "tightrope", std::make_shared<clang::PCHContainerOperations>(),
      clang::tooling::getClangStripDependencyFileAdjuster(), files, &errors);
  result.errors = std::move(errors.text);
  if (!result.unit && result.errors.empty()) result.errors = "error: the parser gave up\n";
  return result;
}

}  // namespace

ParsedCode parse_generated(const std::string& code, const std::string& file_name) {
  clang::tooling::FileContentMappings files;
  for (const EmbeddedHeader& header : runtime_headers()) {
    files.emplace_back(fmt::format("{}/{}", runtime_folder, header.name), std::string(header.text));
  }
  // One target for all machines: the syntax tree must not depend on the host's. The macro __FMA__ lets headers made
  // with
  // --fma through; it changes no other text.
  std::vector<std::string> options = {"-std=c++20", "-xc++",       "--target=x86_64-unknown-linux-gnu",
                                      "-mfma",      "-w",          "-ffreestanding",
                                      "-nostdinc",  "-nostdinc++", fmt::format("-I{}", runtime_folder)};
#if CLANG_VERSION_MAJOR < 15
  // The loosest arithmetic that users' flags may ask for unnoticed: the syntax tree shows whether the code forbids it.
  // Later versions let the runtime notice, and refuse.
  options.insert(options.end(), {"-fassociative-math", "-freciprocal-math", "-fno-signed-zeros", "-fno-trapping-math"});
#endif
  return parsed(code, file_name, options, files);
}

ParsedCode parse_file(const std::string& code, const std::string& file_name, const std::vector<std::string>& flags) {
  std::vector<std::string> options = {"-xc++", "-std=c++20", "-w"};
  if (llvm::sys::fs::is_directory(TIGHTROPE_CLANG_RESOURCES)) {
    options.push_back("-resource-dir=" TIGHTROPE_CLANG_RESOURCES);
  }
  options.insert(options.end(), flags.begin(), flags.end());
  return parsed(code, file_name, options, {});
}

clang::ASTContext& parsed_context(const ParsedCode& code) { return code.unit->getASTContext(); }

std::string error_at(const clang::SourceManager& sources, clang::SourceLocation where, std::string_view what) {
  const clang::SourceLocation place = sources.getFileLoc(where);
  const clang::PresumedLoc presumed = where.isValid() ? sources.getPresumedLoc(place) : clang::PresumedLoc();
  if (presumed.isInvalid()) return fmt::format("error: {}\n", what);
  const llvm::StringRef text = sources.getBufferData(sources.getFileID(place));
  const std::size_t offset = sources.getFileOffset(place);
  const std::size_t begin = offset == 0 ? 0 : text.rfind('\n', offset - 1) + 1;  // npos + 1 is the first character
  const std::string line = text.substr(begin, text.find('\n', offset) - begin).str();
  std::string caret;
  for (std::size_t i = 0; i < offset - begin; ++i) caret += line[i] == '\t' ? '\t' : ' ';
  return fmt::format("{}:{}:{}: error: {}\n{}\n{}^\n", presumed.getFilename(), presumed.getLine(), presumed.getColumn(),
                     what, line, caret);
}

}  // namespace tightrope::codegen
