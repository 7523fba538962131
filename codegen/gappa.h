#pragma once
/// Runs Gappa on a script and reads what it says.

#include <optional>
#include <string>

namespace tightrope::codegen {

struct GappaAnswer {
  enum class Status {
    proved,      ///< all goals with a bound
    not_proved,  ///< some goal not
    timed_out,
    failed,  ///< Gappa did not run, or refuses the script
  } status = Status::failed;
  std::optional<double> found;  ///< the largest magnitude of the goal "in ?", never below what Gappa proves
  std::string unproved;         ///< Gappa's words on the goals that it could not prove
};

/// The program that a name stands for: a path, or what the folders of $PATH hold. Empty if there is none.
std::string find_program(const std::string& name);

/// Runs `program` on the file `script`, for at most `seconds`; what it prints goes to the file `log`.
GappaAnswer run_gappa(const std::string& program, const std::string& script, const std::string& log, double seconds);

/// What the text that Gappa printed says; `exit_status` 0: everything was proved.
GappaAnswer read_gappa_answer(const std::string& text, int exit_status);

}  // namespace tightrope::codegen
