#pragma once
/// Runs tightrope-ccd as a user does.

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/unit/ccd/scratch_directory.h"

namespace tightrope::ccd {

struct Outcome {
  int status = -1;  ///< exit status; -1 if it was killed
  std::string out;
  std::string err;
};

/// `arguments` without single quotes. Stdin is empty, stdout and stderr are files.
inline Outcome run_command(const ScratchDirectory& scratch, const std::vector<std::string>& arguments) {
  const std::string out = (scratch.path() / ".out").string();
  const std::string err = (scratch.path() / ".err").string();
  std::string line = "'" TIGHTROPE_CCD_COMMAND "'";
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  const int raw = std::system((line + " </dev/null >'" + out + "' 2>'" + err + "'").c_str());
  Outcome outcome{WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, text_of(out), text_of(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

}  // namespace tightrope::ccd
