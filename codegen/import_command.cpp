#include "codegen/import_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iterator>

#include "codegen/clang/import_function.h"
#include "codegen/import.h"
#include "codegen/write_files.h"

namespace tightrope::codegen {

CLI::App& add_import_command(CLI::App& app, ImportArguments& arguments) {
  CLI::App& command = *app.add_subcommand("import", "Write a predicate that computes what a C++ function does");
  command.add_option("FILE", arguments.file, "C++ source file")->required()->expected(1);
  command.add_option("--function", arguments.function, "the function's name, plain or qualified")->required();
  command.add_option("-o", arguments.output, "file for the predicate (standard output if not given)");
  command.add_option("FLAGS", arguments.flags, "behind --: flags for the compiler (-I.. -D.. -std=..)");
  return command;
}

int run_import(const ImportArguments& arguments) {
  constexpr int done = 0;
  constexpr int bad_program = 1;
  constexpr int bad_usage = 2;
  std::error_code ignored;
  std::ifstream stream(arguments.file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(arguments.file, ignored)) {
    fmt::print(stderr, "tightrope: error: cannot read {}\n", arguments.file);
    return bad_usage;
  }
  const std::string code{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::string errors;
  const auto function = import_function(arguments.file, code, arguments.function, arguments.flags, errors);
  if (!function) {
    std::fputs(errors.c_str(), stderr);
    return bad_program;
  }
  std::string text;
  try {
    text = import_text(*function, std::filesystem::path(arguments.file).filename().string());
  } catch (const InexpressibleFunction& error) {
    fmt::print(stderr, "{}: error: `{}` goes beyond the language's limits; its predicate:\n{}", arguments.file,
               function->name, error.what());
    return bad_program;
  }
  if (arguments.output.empty()) {
    std::fputs(text.c_str(), stdout);
    return done;
  }
  const TextFile file{arguments.output, text};
  if (const std::string error = write_files({&file, 1}); !error.empty()) {
    fmt::print(stderr, "tightrope: error: {}\n", error);
    return bad_usage;
  }
  return done;
}

}  // namespace tightrope::codegen
