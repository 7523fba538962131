#include "query_io/query_writer.h"

#include <fmt/format.h>

namespace tightrope::ccd {

OpenedWriter create_queries(const std::filesystem::path& output, const std::string& stem) {
  const std::filesystem::path extension = output.extension();
  std::error_code ignored;
  if (extension == ".h5" || extension == ".hdf5") {
    if (!std::filesystem::is_directory(output, ignored)) return create_hdf5(output);
    return FileError{fmt::format("{}: is a directory", output.string())};
  }
  if (extension == ".csv") {
    return FileError{fmt::format("{}: CSV goes into a directory, a file for each kind; give a directory or FILE.h5",
                                 output.string())};
  }
  if (std::filesystem::exists(output, ignored) && !std::filesystem::is_directory(output, ignored)) {
    return FileError{fmt::format("{}: is a file; the output is a directory or FILE.h5", output.string())};
  }
  return create_rational_csv(output, stem);
}

}  // namespace tightrope::ccd
