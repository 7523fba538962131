#pragma once
/// C++ text to Clang's syntax tree, in memory.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace clang {
class ASTUnit;
}

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
  std::string errors;                    ///< the compiler's, one a line; empty if it accepts the text
};

/// Parses generated code. The runtime's headers are those of `runtime_headers`; there are no others, so the result does
/// not depend on the machine that the command runs on.
ParsedCode parse_generated(const std::string& code, const std::string& file_name);

}  // namespace tightrope::codegen
