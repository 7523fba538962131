#include "codegen/clang/format.h"

#include <clang/Format/Format.h>

namespace tightrope::codegen {

namespace {
constexpr std::size_t longest_formatted = 4'000'000;  // bytes
}

std::string formatted(const std::string& code, const std::string& file_name) {
  if (code.size() > longest_formatted) return code;
  clang::format::FormatStyle style = clang::format::getGoogleStyle(clang::format::FormatStyle::LK_Cpp);
  style.ColumnLimit = 120;
  style.DerivePointerAlignment = false;
  style.ReflowComments = false;
  style.SortIncludes = clang::format::FormatStyle::SI_Never;
  const clang::tooling::Range everything(0, static_cast<unsigned>(code.size()));
  const clang::tooling::Replacements changes = clang::format::reformat(style, code, {everything}, file_name);
  auto result = clang::tooling::applyAllReplacements(code, changes);
  if (!result) {  // overlapping replacements: cannot be for one file, and the text as printed is as good
    llvm::consumeError(result.takeError());
    return code;
  }
  return *result;
}

}  // namespace tightrope::codegen
