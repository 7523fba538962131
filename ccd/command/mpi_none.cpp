/// Builds without MPI.

#include "command/mpi.h"

namespace tightrope::ccd::mpi {

Session::Session() = default;
Session::~Session() = default;

std::string fault() { return {}; }

bool is_first() { return true; }

std::unique_ptr<Processes> processes() { return std::make_unique<SingleProcess>(); }

}  // namespace tightrope::ccd::mpi
