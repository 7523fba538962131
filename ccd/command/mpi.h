#pragma once
/// The processes that an MPI launcher (mpirun, srun) started. In builds without MPI, and without a launcher, there is
/// one process, and no MPI function is called.

#include <memory>
#include <string>

#include "command/processes.h"

namespace tightrope::ccd::mpi {

/// MPI from begin to end of a run; does nothing if no launcher started this process. One a process.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// Why the launcher's processes cannot work together; empty: they can.
std::string fault();

/// Whether this process is the one that prints. True before and after the session.
bool is_first();

/// The processes of the session.
std::unique_ptr<Processes> processes();

}  // namespace tightrope::ccd::mpi
