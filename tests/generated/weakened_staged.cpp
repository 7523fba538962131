/// A staged predicate whose filters lack the rounding of products, to show that the generated tests notice signs that a
/// filter settles wrongly.
///
///   weakened_staged DIRECTORY
///
/// writes DIRECTORY/weakened_staged.pred and its header and tests.
#include <fmt/format.h>

#include "codegen/compile.h"

int main(int argc, char** argv) {
  using namespace tightrope;
  if (argc != 2) return 2;
  const std::filesystem::path directory = argv[1];
  const codegen::TextFile source = {
      directory / "weakened_staged.pred",
      "predicate weakened(scalar a, b, c, d, e, f) { sign a * b + c * d + e * f as s }\n"};
  std::string error = codegen::write_files({&source, 1});
  codegen::CompileRequest request;
  request.file = source.path.string();
  request.modes = {codegen::BoundMode::staged};
  request.tests = true;
  request.directory = directory;
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  const auto files = codegen::compile(request, sources, diagnostics, codegen::Weakening::drop_rounding_of_products);
  if (!files) error = diagnostics.render(sources);
  if (error.empty()) error = codegen::write_files(*files);
  if (!error.empty()) fmt::print(stderr, "weakened_staged: {}\n", error);
  return error.empty() ? 0 : 1;
}
