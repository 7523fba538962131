#include "command/mpi.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdlib>
#include <initializer_list>

namespace tightrope::ccd::mpi {
namespace {

/// What launchers say to the processes that they start: Open MPI, PMIx and PMI (MPICH, Intel, Slurm). MPI_Init on its
/// own, without any of them, would take most of a second to become the only process.
bool is_launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"}) {
    if (std::getenv(name) != nullptr) return true;  // NOLINT(concurrency-mt-unsafe): nobody sets it
  }
  return false;
}

bool is_running() {
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  return begun != 0 && ended == 0;
}

class MpiProcesses final : public Processes {
 public:
  std::size_t rank() const override {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return static_cast<std::size_t>(rank);
  }
  std::size_t count() const override {
    int count = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    return static_cast<std::size_t>(count);
  }
  void smallest(std::span<std::uint64_t> numbers) override { combine(numbers, MPI_UINT64_T, MPI_MIN); }
  void sum(std::span<std::uint64_t> numbers) override { combine(numbers, MPI_UINT64_T, MPI_SUM); }
  void sum(std::span<double> numbers) override { combine(numbers, MPI_DOUBLE, MPI_SUM); }
  std::string text_of(std::size_t rank, std::string text) override {
    std::uint64_t length = text.size();
    const int root = static_cast<int>(rank);
    MPI_Bcast(&length, 1, MPI_UINT64_T, root, MPI_COMM_WORLD);
    text.resize(length);
    MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, root, MPI_COMM_WORLD);
    return text;
  }

 private:
  template <class T>
  static void combine(std::span<T> numbers, MPI_Datatype type, MPI_Op operation) {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), type, operation, MPI_COMM_WORLD);
  }
};

}  // namespace

Session::Session() {
  if (!is_launched()) return;
  int level = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);  // what other threads do knows no MPI
}

Session::~Session() {
  if (is_running()) MPI_Finalize();
}

std::string fault() {
  if (!is_running()) return {};
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* told = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
    if (told == nullptr || MpiProcesses().count() == std::strtoul(told, nullptr, 10)) continue;
    return "the MPI launcher is not that of the MPI library which this command was built with";
  }
  return {};
}

bool is_first() { return !is_running() || MpiProcesses().rank() == 0; }

std::unique_ptr<Processes> processes() {
  if (is_running()) return std::make_unique<MpiProcesses>();
  return std::make_unique<SingleProcess>();
}

}  // namespace tightrope::ccd::mpi
