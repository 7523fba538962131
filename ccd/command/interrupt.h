#pragma once
/// Ctrl-C while files are being written: the loop that writes them stops, and what is unfinished is removed.

namespace tightrope::ccd {

/// From now on SIGINT and SIGTERM only set interrupted().
void catch_interrupts();
bool interrupted();

}  // namespace tightrope::ccd
