#include "codegen/clang/parse.h"

#include <clang/Basic/Diagnostic.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Basic/Version.h>
#include <clang/Frontend/ASTUnit.h>
#include <clang/Tooling/Tooling.h>
#include <fmt/format.h>
#include <llvm/ADT/SmallString.h>

namespace tightrope::codegen {
namespace {

class ErrorCollector : public clang::DiagnosticConsumer {
 public:
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) override {
    if (level < clang::DiagnosticsEngine::Error) return;
    llvm::SmallString<200> message;
    diagnostic.FormatDiagnostic(message);
    unsigned line = 0;
    if (diagnostic.hasSourceManager() && diagnostic.getLocation().isValid()) {
      line = diagnostic.getSourceManager().getPresumedLineNumber(diagnostic.getLocation());
    }
    text +=
        fmt::format("{}line {}: {}", text.empty() ? "" : "\n", line, std::string_view(message.data(), message.size()));
  }
  std::string text;
};

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
  ErrorCollector errors;
  ParsedCode result;
  result.unit = clang::tooling::buildASTFromCodeWithArgs(
      code, options, file_name, "tightrope", std::make_shared<clang::PCHContainerOperations>(),
      clang::tooling::getClangStripDependencyFileAdjuster(), files, &errors);
  result.errors = std::move(errors.text);
  if (!result.unit && result.errors.empty()) result.errors = "the parser gave up";
  return result;
}

}  // namespace tightrope::codegen
