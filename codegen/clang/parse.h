#pragma once
/// C++ text to Clang's syntax tree, in memory.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace clang {
class ASTContext;
class ASTUnit;
class SourceLocation;
class SourceManager;
}  // namespace clang

namespace tightrope::codegen {

struct EmbeddedHeader {
  std::string_view name;  ///< as code includes it: "tightrope/sign.h"
  std::string_view text;
};

/// The headers of runtime/ that this command was built with.
const std::vector<EmbeddedHeader>& runtime_headers();

/// The folder that the parser sees the runtime's headers in. It exists nowhere else.
inline constexpr std::string_view runtime_folder = "/tightrope-runtime";

struct ParsedCode {
  std::shared_ptr<clang::ASTUnit> unit;  ///< never null
  std::string errors;                    ///< the compiler's; empty if it accepts the text
};

/// Parses generated code. The runtime's headers are those of `runtime_headers`; there are no others, so the result does
/// not depend on the machine that the command runs on.
ParsedCode parse_generated(const std::string& code, const std::string& file_name);

/// Parses a user's C++ with the compiler's own system headers; `flags` as on a command line.
ParsedCode parse_file(const std::string& code, const std::string& file_name, const std::vector<std::string>& flags);

clang::ASTContext& parsed_context(const ParsedCode& code);

/// "FILE:LINE:COLUMN: error: what", the source line, a caret.
std::string error_at(const clang::SourceManager& sources, clang::SourceLocation where, std::string_view what);

}  // namespace tightrope::codegen
