#pragma once
/// Integers of a fixed number of 64-bit words, two's complement, without allocation: what generated code evaluates
/// polynomials of scaled inputs in (exact_sign.h). Every result is exact modulo 2^(64 words); the caller chooses words
/// enough for the exact value (codegen/exact_program.h proves it for generated code), so that no result wraps.

#include <tightrope/arithmetic.h>

#include <cstdint>

namespace tightrope {

#if defined(__clang__)
#define TIGHTROPE_UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define TIGHTROPE_UNROLL _Pragma("GCC unroll 8")
#else
#define TIGHTROPE_UNROLL
#endif

__extension__ using SignedWide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

/// word[0] + word[1] 2^64 + ..., the last word signed.
template <int Words>
struct Integer {
  std::uint64_t word[Words];

  bool negative() const { return word[Words - 1] >> 63 != 0; }
  /// All ones if negative, else 0: every word above the last.
  std::uint64_t extension() const {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(word[Words - 1]) >> 63);
  }
};

namespace detail {

template <int Words>
TIGHTROPE_FUNCTION Integer<Words> integer_of(SignedWide value) {
  Integer<Words> r;
  r.word[0] = static_cast<std::uint64_t>(value);
  TIGHTROPE_UNROLL
  for (int i = 1; i < Words; ++i) r.word[i] = static_cast<std::uint64_t>(i == 1 ? value >> 64 : value >> 127);
  return r;
}

template <int Words>
TIGHTROPE_FUNCTION SignedWide wide(const Integer<Words>& a) {
  static_assert(Words <= 2);
  if constexpr (Words == 1) {
    return static_cast<std::int64_t>(a.word[0]);
  } else {
    return static_cast<SignedWide>(static_cast<UnsignedWide>(a.word[1]) << 64 | a.word[0]);
  }
}

/// Word i of `a` as if it had words without end.
template <int Words>
TIGHTROPE_FUNCTION std::uint64_t word_of(const Integer<Words>& a, std::uint64_t extension, int i) {
  return i < Words ? a.word[i < Words ? i : 0] : extension;
}

/// r[0 .. min(A + B, N)) += a * b, both unsigned; the rest of the N words takes no carry.
template <int N, int A, int B>
TIGHTROPE_FUNCTION void add_unsigned_product(std::uint64_t (&r)[N], const std::uint64_t (&a)[A],
                                             const std::uint64_t (&b)[B]) {
  TIGHTROPE_UNROLL
  for (int i = 0; i < (A < N ? A : N); ++i) {
    std::uint64_t carry = 0;
    TIGHTROPE_UNROLL
    for (int j = 0; j < (B < N - i ? B : N - i); ++j) {  // (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1: no overflow
      const UnsignedWide t = static_cast<UnsignedWide>(a[i]) * b[j] + r[i + j] + carry;
      r[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    if (i + B < N) r[i + B] = carry;
  }
}

/// r[at .. at + B) -= mask & b, as far as r goes (a borrow beyond `at` + B is lost: see product()).
template <int At, int N, int B>
TIGHTROPE_FUNCTION void subtract_masked(std::uint64_t (&r)[N], const std::uint64_t (&b)[B], std::uint64_t mask) {
  std::uint64_t borrow = 0;
  TIGHTROPE_UNROLL
  for (int j = 0; j < (B < N - At ? B : N - At); ++j) {
    const UnsignedWide t = static_cast<UnsignedWide>(r[At + j]) - (b[j] & mask) - borrow;
    r[At + j] = static_cast<std::uint64_t>(t);
    borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
  }
}

/// a * b modulo 2^(64 N) for N <= A + B. Lemma: with a_u, b_u the words read as unsigned numbers, a = a_u - 2^(64 A) if
/// a < 0 (b likewise), so that a b = a_u b_u - [a < 0] 2^(64 A) b_u - [b < 0] 2^(64 B) a_u modulo 2^(64 (A + B)).
template <int N, int A, int B>
TIGHTROPE_FUNCTION Integer<N> unrolled_product(const Integer<A>& a, const Integer<B>& b) {
  static_assert(N <= A + B);
  Integer<N> r = {};
  add_unsigned_product(r.word, a.word, b.word);
  if constexpr (N > A) subtract_masked<A>(r.word, b.word, a.extension());
  if constexpr (N > B) subtract_masked<B>(r.word, a.word, b.extension());
  return r;
}

#if defined(__GNUC__) && !defined(__CUDACC__)
__attribute__((noinline))
#endif
/// The same for numbers of many words, which inlining would only make larger. r (N words) must be zero.
inline void
long_product(std::uint64_t* r, int n, const std::uint64_t* a, int na, const std::uint64_t* b, int nb) {
  for (int i = 0; i < na && i < n; ++i) {
    std::uint64_t carry = 0;
    const int end = nb < n - i ? nb : n - i;
    for (int j = 0; j < end; ++j) {
      const UnsignedWide t = static_cast<UnsignedWide>(a[i]) * b[j] + r[i + j] + carry;
      r[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    if (i + nb < n) r[i + nb] = carry;
  }
  const auto subtract = [r, n](const std::uint64_t* b_words, int count, int at) {
    std::uint64_t borrow = 0;
    for (int j = 0; j < count && at + j < n; ++j) {
      const UnsignedWide t = static_cast<UnsignedWide>(r[at + j]) - b_words[j] - borrow;
      r[at + j] = static_cast<std::uint64_t>(t);
      borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
    }
  };
  if (a[na - 1] >> 63 != 0) subtract(b, nb, na);
  if (b[nb - 1] >> 63 != 0) subtract(a, na, nb);
}

}  // namespace detail

/// Arithmetic on the numbers of generated exact code; R is the type of the result. Dyadic numbers have the same
/// functions (exact_sign.h).
namespace exact_arithmetic {

/// -1, 0, +1
template <int A>
TIGHTROPE_FUNCTION int sign_of(const Integer<A>& a) {
  std::uint64_t bits = 0;
  TIGHTROPE_UNROLL
  for (int i = 0; i < A; ++i) bits |= a.word[i];
  return a.negative() ? -1 : bits != 0 ? 1 : 0;
}

template <int N, int A>
TIGHTROPE_FUNCTION Integer<N> resized(const Integer<A>& a) {
  Integer<N> r;
  TIGHTROPE_UNROLL
  for (int i = 0; i < N; ++i) r.word[i] = detail::word_of(a, a.extension(), i);
  return r;
}

template <class R, int A>
TIGHTROPE_FUNCTION R converted(const Integer<A>& a) {
  return resized<static_cast<int>(sizeof(R) / sizeof(std::uint64_t))>(a);
}

namespace detail {

template <class R>
inline constexpr int words_of = static_cast<int>(sizeof(R) / sizeof(std::uint64_t));

/// a + (b ^ flip) + (flip & 1): the sum, or the difference if all bits of `flip` are set.
template <class R, int A, int B>
TIGHTROPE_FUNCTION R sum_or_difference(const Integer<A>& a, const Integer<B>& b, std::uint64_t flip) {
  constexpr int n = words_of<R>;
  const std::uint64_t a_extension = a.extension(), b_extension = b.extension();
  R r;
  std::uint64_t carry = flip & 1U;
  TIGHTROPE_UNROLL
  for (int i = 0; i < n; ++i) {
    const std::uint64_t y = tightrope::detail::word_of(b, b_extension, i) ^ flip;
    const UnsignedWide t = static_cast<UnsignedWide>(tightrope::detail::word_of(a, a_extension, i)) + y + carry;
    r.word[i] = static_cast<std::uint64_t>(t);
    carry = static_cast<std::uint64_t>(t >> 64);
  }
  return r;
}

}  // namespace detail

template <class R, int A, int B>
TIGHTROPE_FUNCTION R sum(const Integer<A>& a, const Integer<B>& b) {
  constexpr int n = detail::words_of<R>;
  if constexpr (n == 1) {
    return {{a.word[0] + b.word[0]}};
  } else if constexpr (n == 2 && A <= 2 && B <= 2) {  // modulo 2^128, in unsigned numbers
    const auto x = static_cast<UnsignedWide>(tightrope::detail::wide(a));
    const auto y = static_cast<UnsignedWide>(tightrope::detail::wide(b));
    return tightrope::detail::integer_of<n>(static_cast<SignedWide>(x + y));
  } else {
    return detail::sum_or_difference<R>(a, b, 0);
  }
}

template <class R, int A, int B>
TIGHTROPE_FUNCTION R difference(const Integer<A>& a, const Integer<B>& b) {
  constexpr int n = detail::words_of<R>;
  if constexpr (n == 1) {
    return {{a.word[0] - b.word[0]}};
  } else if constexpr (n == 2 && A <= 2 && B <= 2) {
    const auto x = static_cast<UnsignedWide>(tightrope::detail::wide(a));
    const auto y = static_cast<UnsignedWide>(tightrope::detail::wide(b));
    return tightrope::detail::integer_of<n>(static_cast<SignedWide>(x - y));
  } else {
    return detail::sum_or_difference<R>(a, b, ~std::uint64_t{0});
  }
}

template <class R, int A>
TIGHTROPE_FUNCTION R negated(const Integer<A>& a) {
  return difference<R>(Integer<1>{{0}}, a);
}

template <class R, int A, int B>
TIGHTROPE_FUNCTION R product(const Integer<A>& a, const Integer<B>& b) {
  constexpr int n = detail::words_of<R>;
  constexpr int full = n < A + B ? n : A + B;
  if constexpr (full == 1) {
    return converted<R>(Integer<1>{{a.word[0] * b.word[0]}});
  } else if constexpr (A == 1 && B == 1) {
    return tightrope::detail::integer_of<n>(tightrope::detail::wide(a) * tightrope::detail::wide(b));
  } else if constexpr (A * B <= 12) {
    return converted<R>(tightrope::detail::unrolled_product<full>(a, b));
  } else {
    Integer<full> r = {};
    tightrope::detail::long_product(r.word, full, a.word, A, b.word, B);
    return converted<R>(r);
  }
}

/// a times an integer.
template <class R, int A>
TIGHTROPE_FUNCTION R multiple(const Integer<A>& a, std::int64_t factor) {
  return product<R>(a, Integer<1>{{static_cast<std::uint64_t>(factor)}});
}

/// a * 2^bits, bits >= 0.
template <class R, int A>
TIGHTROPE_FUNCTION R shifted(const Integer<A>& a, int bits) {
  constexpr int n = detail::words_of<R>;
  const std::uint64_t extension = a.extension();
  const int words = bits / 64, rest = bits % 64;
  R r;
  for (int i = 0; i < n; ++i) {
    const int k = i - words;
    const std::uint64_t high = k < 0 ? 0 : k < A ? a.word[k] : extension;
    const std::uint64_t low = k < 1 ? 0 : k - 1 < A ? a.word[k - 1] : extension;
    r.word[i] = rest == 0 ? high : high << rest | low >> (64 - rest);
  }
  return r;
}

/// a if condition >= 0, else -a, without a branch.
template <class R, int A>
TIGHTROPE_FUNCTION R negated_if(const Integer<A>& a, bool condition) {
  return converted<R>(condition ? negated<Integer<A>>(a) : a);
}

}  // namespace exact_arithmetic

}  // namespace tightrope
