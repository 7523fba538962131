#pragma once
/// CUDA text around the generated header: batches of calls as structures of arrays, and their kernels (docs/cuda.md).
///
/// The arithmetic stays in the header, which is `__host__ __device__` under nvcc and validated. What is printed here
/// calls it between loads and stores, and holds no operation on numbers.

#include <span>
#include <string>

#include "codegen/print_cpp.h"

namespace tightrope::codegen {

/// NAME.BOUND.REAL.cuda.h, for C++ and CUDA: tightrope::Batch of every predicate. The header lies beside it.
std::string print_cuda_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options,
                              const std::string& stem);

/// NAME.BOUND.REAL.cu: the kernels and Batch::launch.
std::string print_cuda_source(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options,
                              const std::string& stem);

/// "vertex_face.tight.double.cuda.h", "vertex_face.tight.double.cu"
std::string cuda_header_name(const std::string& stem, BoundMode mode, Precision precision);
std::string cuda_source_name(const std::string& stem, BoundMode mode, Precision precision);

}  // namespace tightrope::codegen
