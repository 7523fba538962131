#include "command/interrupt.h"

#include <csignal>

namespace tightrope::ccd {
namespace {

volatile std::sig_atomic_t signal_came = 0;  // a signal handler has no other way to tell

void note_signal(int) { signal_came = 1; }

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

bool interrupted() { return signal_came != 0; }

}  // namespace tightrope::ccd
