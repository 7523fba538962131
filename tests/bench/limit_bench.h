#pragma once

#include <span>

namespace tightrope::bench {

/// Registers what the machine can do at most, for every instruction set of batch.h that it has:
///
///   limit/read/SET/threads:N              memory read front to back; counter `bytes` a call
///   limit/arithmetic/REAL/SET/threads:N   products and sums; counter `operations` a call
///   limit/fused/REAL/SET/threads:N        the same fused, each counted as two operations
///
/// `limit/fused` is there for comparison: generated code has no fused operations unless told.
void register_limits(std::span<const int> numbers_of_threads);

}  // namespace tightrope::bench
