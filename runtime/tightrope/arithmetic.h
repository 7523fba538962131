#pragma once
/// The floating-point operations of generated code, and the guards that keep a compiler from changing them.
///
/// Assumed, and not checkable at compile time: round to nearest, gradual underflow (no flush-to-zero).

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "Tightrope: error bounds do not hold under -ffast-math or its parts"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && !defined(__CUDACC__)
#error "Tightrope: error bounds do not hold with excess precision (x87); use -mfpmath=sse"
#endif

#if defined(__CUDACC__)
#define TIGHTROPE_FUNCTION __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define TIGHTROPE_FUNCTION __attribute__((always_inline)) inline
#else
#define TIGHTROPE_FUNCTION inline
#endif

// clang has no macro for -fassociative-math, -freciprocal-math and -funsafe-math-optimizations that could be refused
// above. Between these two, also in generated code, it keeps to the operations as they are written, whatever the flags,
// and after inlining, too.
#if defined(__clang__)
#define TIGHTROPE_PRECISE_BEGIN _Pragma("float_control(push)") _Pragma("float_control(precise, on)")
#define TIGHTROPE_PRECISE_END _Pragma("float_control(pop)")
#else
#define TIGHTROPE_PRECISE_BEGIN
#define TIGHTROPE_PRECISE_END
#endif

// nvcc has no macro for -ftz=true, -prec-div=false and -prec-sqrt=false (-use_fast_math is all three), but tells the
// device library of them: __nvvm_reflect becomes a constant when code is made.
#if defined(__CUDA_ARCH__) && !defined(__clang__)
#define TIGHTROPE_NVCC_DEVICE
extern "C" __device__ int __nvvm_reflect(const void* option);
#endif

TIGHTROPE_PRECISE_BEGIN
namespace tightrope {

#if defined(TIGHTROPE_NVCC_DEVICE)
/// Leaves nothing in correct code. ptxas stops at instructions that it does not know; their names are the messages.
__device__ __forceinline__ void stop_unless_single_precision_is_ieee() {
  if (__nvvm_reflect("__CUDA_FTZ")) asm volatile("Tightrope_single_precision_needs_ftz_false;");
  if (!__nvvm_reflect("__CUDA_PREC_DIV")) asm volatile("Tightrope_single_precision_needs_prec_div_true;");
  if (!__nvvm_reflect("__CUDA_PREC_SQRT")) asm volatile("Tightrope_single_precision_needs_prec_sqrt_true;");
}
#endif

/// Stops the compilation of device code whose numbers of type Real are not rounded as IEEE 754 says.
template <class Real>
TIGHTROPE_FUNCTION constexpr void require_ieee_device() {
#if defined(TIGHTROPE_NVCC_DEVICE)
  if (sizeof(Real) == sizeof(float) && !__builtin_is_constant_evaluated()) stop_unless_single_precision_is_ieee();
#endif
}

#if defined(__x86_64__) || defined(__i386__)
#define TIGHTROPE_FLOAT_REGISTER "+x"
#elif defined(__aarch64__)
#define TIGHTROPE_FLOAT_REGISTER "+w"
#else
#define TIGHTROPE_FLOAT_REGISTER "+m"
#endif

/// x. If it is a product, it is rounded, and no compiler may contract it with an addition into an fma. g++ ignores the
/// standard pragma and contracts by default; its barrier keeps the rounded product. clang heeds the pragma unless
/// -ffp-contract=fast overrules it (its back end then fuses whatever it sees), which an empty asm statement prevents;
/// so does it for code that nvcc passes on to g++ (nvcc does not know the barrier). Not for the device.
template <class Real>
TIGHTROPE_FUNCTION Real rounded(Real x) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__) && __GNUC__ >= 12
  return __builtin_assoc_barrier(x);
#else
#if !defined(__CUDA_ARCH__)
  asm("" : TIGHTROPE_FLOAT_REGISTER(x));
#endif
  return x;
#endif
}

/// a * b, rounded on its own. On the device, an operation with its rounding spelled out is never fused.
TIGHTROPE_FUNCTION double product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  return rounded(a * b);
#endif
}
TIGHTROPE_FUNCTION float product(float a, float b) {
#if defined(__CUDA_ARCH__)
  require_ieee_device<float>();
  return __fmul_rn(a, b);
#else
  return rounded(a * b);
#endif
}

/// a + b and a - b, of arguments: the caller may have formed them as products, after inlining they stand beside the
/// sum.
TIGHTROPE_FUNCTION double sum(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dadd_rn(a, b);
#else
  return rounded(a) + rounded(b);
#endif
}
TIGHTROPE_FUNCTION float sum(float a, float b) {
#if defined(__CUDA_ARCH__)
  require_ieee_device<float>();
  return __fadd_rn(a, b);
#else
  return rounded(a) + rounded(b);
#endif
}
TIGHTROPE_FUNCTION double difference(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dsub_rn(a, b);
#else
  return rounded(a) - rounded(b);
#endif
}
TIGHTROPE_FUNCTION float difference(float a, float b) {
#if defined(__CUDA_ARCH__)
  require_ieee_device<float>();
  return __fsub_rn(a, b);
#else
  return rounded(a) - rounded(b);
#endif
}

#undef TIGHTROPE_FLOAT_REGISTER

template <class Real>
TIGHTROPE_FUNCTION constexpr Real magnitude(Real a) {
  return __builtin_fabs(a);
}
template <>
TIGHTROPE_FUNCTION constexpr float magnitude(float a) {
  return __builtin_fabsf(a);
}

/// min(a, b); NaN if either is NaN, unlike std::fmin and `a < b ? a : b`.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real minimum(Real a, Real b) {
  return a < b ? a : b <= a ? b : a + b;
}

/// max(a, b); NaN if either is NaN.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real maximum(Real a, Real b) {
  return a > b ? a : b >= a ? b : a + b;
}

/// `a` if the exact number that it stands for, which differs from it by at most `bound`, is certainly not zero; else
/// NaN, so that a quotient by it has no sign (and nothing is divided by zero). The bound may be NaN.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real certain_nonzero(Real a, Real bound) {
  require_ieee_device<Real>();
  return magnitude(a) > bound ? a : static_cast<Real>(__builtin_nan(""));
}

/// `a` if the exact number that it stands for is certainly not negative; else NaN, which is what its root is then.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real certain_nonnegative(Real a, Real bound) {
  require_ieee_device<Real>();
  return a >= bound ? a : static_cast<Real>(__builtin_nan(""));
}

/// max(a, b) of non-negative numbers in one instruction, for the run-time maxima of SafeBound only. A NaN in `b` is
/// passed over, a NaN in `a`, the maximum so far, stays: never may a NaN wipe out the numbers before it.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real max_magnitude(Real a, Real b) {
  return b > a ? b : a;
}

/// The power of two by which inputs are normalized whose largest magnitude is `largest`: the product is below 1, and at
/// least 1/2 unless `largest` is subnormal (or 0). NaN if it is infinite or NaN.
TIGHTROPE_FUNCTION constexpr double normalizer(double largest) {
  const int exponent = static_cast<int>(__builtin_bit_cast(unsigned long long, largest) >> 52);  // biased; no sign
  if (exponent >= 2045)
    return exponent == 2045 ? 0x1p-1023 : largest <= 0x1.fffffffffffffp+1023 ? 0x1p-1024 : __builtin_nan("");
  return __builtin_bit_cast(double, static_cast<unsigned long long>(2045 - exponent) << 52);
}
TIGHTROPE_FUNCTION constexpr float normalizer(float largest) {
  const int exponent = static_cast<int>(__builtin_bit_cast(unsigned, largest) >> 23);
  if (exponent >= 253)
    return exponent == 253 ? 0x1p-127f : largest <= 0x1.fffffep+127f ? 0x1p-128f : __builtin_nanf("");
  return __builtin_bit_cast(float, static_cast<unsigned>(253 - exponent) << 23);
}

/// Square root and fused multiply-add, by the names that vector classes have for them.
TIGHTROPE_FUNCTION double square_root(double a) { return __builtin_sqrt(a); }
TIGHTROPE_FUNCTION float square_root(float a) { return __builtin_sqrtf(a); }
TIGHTROPE_FUNCTION double multiply_add(double a, double b, double c) { return __builtin_fma(a, b, c); }
TIGHTROPE_FUNCTION float multiply_add(float a, float b, float c) { return __builtin_fmaf(a, b, c); }

/// `first` if the condition, a difference of sizes, is not negative, else (a NaN, too) `second`: one of two values that
/// stand in equal expressions.
template <class Real>
TIGHTROPE_FUNCTION constexpr Real choose(Real condition, Real first, Real second) {
  return condition >= 0 ? first : second;
}

}  // namespace tightrope
TIGHTROPE_PRECISE_END
