#pragma once
/// What Highway compiles for, and the names that batch.h has for it. Included before anything else of Highway.

// Of no use to arithmetic on doubles, or all but equal to others.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/detect_targets.h>

#if HWY_TARGETS & HWY_SSE4
#define TIGHTROPE_CASE_SSE4(...) \
  case InstructionSet::sse4:     \
    return lanes::N_SSE4::__VA_ARGS__;
#else
#define TIGHTROPE_CASE_SSE4(...) \
  case InstructionSet::sse4:     \
    break;
#endif
#if HWY_TARGETS & HWY_NEON
#define TIGHTROPE_CASE_NEON(...) \
  case InstructionSet::neon:     \
    return lanes::N_NEON::__VA_ARGS__;
#else
#define TIGHTROPE_CASE_NEON(...) \
  case InstructionSet::neon:     \
    break;
#endif
#if HWY_TARGETS & HWY_AVX2
#define TIGHTROPE_CASE_AVX2(...) \
  case InstructionSet::avx2:     \
    return lanes::N_AVX2::__VA_ARGS__;
#else
#define TIGHTROPE_CASE_AVX2(...) \
  case InstructionSet::avx2:     \
    break;
#endif
#if HWY_TARGETS & HWY_AVX3
#define TIGHTROPE_CASE_AVX512(...) \
  case InstructionSet::avx512:     \
    return lanes::N_AVX3::__VA_ARGS__;
#else
#define TIGHTROPE_CASE_AVX512(...) \
  case InstructionSet::avx512:     \
    break;
#endif

/// All cases of a switch over InstructionSet: those of the sets that there is code for return what the expression is in
/// the set's namespace.
#define TIGHTROPE_RETURN_FOR_INSTRUCTIONS(...) \
  case InstructionSet::scalar:                 \
    break;                                     \
    TIGHTROPE_CASE_SSE4(__VA_ARGS__)           \
    TIGHTROPE_CASE_NEON(__VA_ARGS__)           \
    TIGHTROPE_CASE_AVX2(__VA_ARGS__)           \
    TIGHTROPE_CASE_AVX512(__VA_ARGS__)

/// Is the present pass of foreach_target.h one of those? Highway's other targets are plain C++, or their vectors have
/// no size at compile time.
#define TIGHTROPE_HAS_VECTORS (HWY_TARGET & (HWY_SSE4 | HWY_NEON | HWY_AVX2 | HWY_AVX3))
