#pragma once
/// The `tightrope` command.

namespace tightrope::codegen {

/// Runs it. Returns the exit status: 0 done, 1 a bad program (diagnostics on stderr), 2 bad usage or an unwritable
/// file.
int run_command(int argc, const char* const* argv);

}  // namespace tightrope::codegen
