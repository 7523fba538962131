#pragma once
/// Formatting of generated C++ with Clang's libFormat.

#include <string>

namespace tightrope::codegen {

/// `code` in the one style of generated files: Google's, 120 columns, comments and the order of includes left as they
/// are. Depends on nothing but the text: no configuration file is looked for. Texts beyond a few megabytes come back as
/// they are (libFormat takes about a second a megabyte and nobody reads them).
std::string formatted(const std::string& code, const std::string& file_name);

}  // namespace tightrope::codegen
