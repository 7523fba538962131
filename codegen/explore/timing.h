#pragma once
/// Times of schemes: their code compiled by the machine's C++ compiler and run.

#include <span>
#include <string>
#include <vector>

#include "codegen/explore/candidate.h"
#include "codegen/explore/samples.h"

namespace tightrope::codegen::explore {

struct TimingRequest {
  std::string compiler;  ///< path of the program; find_compiler
  std::vector<std::string> flags = {"-O3"};
  std::size_t last_stage = 0;  ///< a call evaluates all stages up to this one
  Precision inputs = Precision::binary64;
  int rounds = 21;  ///< in each, every scheme is timed once, in turn
};

/// Nanoseconds a call: the median of the rounds and its quartiles. 0: not timed.
struct Time {
  double median = 0;
  double lower_quartile = 0;
  double upper_quartile = 0;
};

/// The compiler: what $CXX names, else c++, g++ or clang++ in $PATH. Empty, with one line in `error`, if there is none.
std::string find_compiler(std::string& error);

/// Times every candidate on the rows, all of them again and again. Fused multiply-adds get -mfma on x86; where the
/// processor has none, their candidates are not timed. Returns "" or one line on what went wrong.
std::string measure_times(std::span<const Candidate* const> candidates, const std::vector<Row>& rows,
                          const TimingRequest& request, std::vector<Time>& times);

/// The C++ code that evaluates one candidate on rows: `long scheme_N(const REAL* rows, long count)`, for tests and for
/// the curious. Returns the number of definite signs.
std::string timed_code(const Candidate& candidate, std::size_t number, const TimingRequest& request);

/// A row as the code reads it: argument by argument; bounded inputs with their bounds, 0, behind each number.
std::vector<double> arranged(const dsl::Predicate& predicate, const Row& row);

}  // namespace tightrope::codegen::explore
