#pragma once
/// Exact dyadic numbers (m * 2^e, any integers m and e): closed under + - * and scaling, every finite double is one.
/// Host only. Products and sums never round; to_double() and its relatives round once, as their names say.

#include <tightrope/limbs.h>

#include <algorithm>
#include <bit>
#include <compare>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace tightrope {

/// An exact number m * 2^e. Memory grows with the distance between its highest and its lowest bit.
class Dyadic {
 public:
  Dyadic() = default;  ///< zero
  /// Exactly `value`, which must be finite (aborts otherwise). A float converts to double exactly first.
  explicit Dyadic(double value);
  explicit Dyadic(long double value) = delete;
  template <std::integral Integer>
  requires(sizeof(Integer) <= 8) explicit Dyadic(Integer value) : limbs_(value == 0 ? 0 : 1) {
    if (value == 0) return;
    negative_ = value < 0;
    const auto bits = static_cast<std::uint64_t>(value);
    *limbs_.data() = negative_ ? 0 - bits : bits;
  }

  int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }  ///< -1, 0, +1

  double to_double() const { return round<double>(Direction::nearest); }  ///< nearest, ties to even; overflow gives inf
  float to_float() const { return round<float>(Direction::nearest); }     ///< the same in single precision
  double floor_double() const { return round<double>(Direction::down); }  ///< largest double <= *this (may be -inf)
  double ceil_double() const { return round<double>(Direction::up); }     ///< smallest double >= *this (may be +inf)

  /// The exponent of the highest set bit: 2^e <= |*this| < 2^(e+1). Not for zero.
  std::int64_t high_exponent() const;
  /// The exponent of the lowest set bit: the largest e with *this an integer multiple of 2^e. Not for zero.
  std::int64_t low_exponent() const;
  /// Exact text, "-0x1f5p-3": hexadecimal integer times a power of two.
  std::string to_string() const;

  Dyadic operator-() const&;
  Dyadic operator-() &&;
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return sum(a, b, b.negative_); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, !b.negative_); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
  Dyadic& operator+=(const Dyadic& b) { return *this = *this + b; }
  Dyadic& operator-=(const Dyadic& b) { return *this = *this - b; }
  Dyadic& operator*=(const Dyadic& b) { return *this = *this * b; }
  friend std::strong_ordering operator<=>(const Dyadic& a, const Dyadic& b);
  friend bool operator==(const Dyadic& a, const Dyadic& b) { return (a <=> b) == 0; }
  friend Dyadic mul_pow2(const Dyadic& a, std::int64_t exponent);  ///< a * 2^exponent

 private:
  enum class Direction { nearest, down, up };
  template <std::floating_point Real>
  Real round(Direction direction) const;
  /// floor(|*this| / 2^position), which must be below 2^64.
  std::uint64_t bits_from(std::int64_t position) const;
  std::uint64_t limb_at(std::int64_t index) const {
    const std::int64_t i = index - offset_;
    return i >= 0 && i < static_cast<std::int64_t>(limbs_.size()) ? limbs_[static_cast<std::size_t>(i)] : 0;
  }
  Dyadic(detail::Limbs limbs, std::int64_t offset) : limbs_(std::move(limbs)), offset_(offset) {}
  /// (carry 2^128 + magnitude) 2^(64 offset), with a sign.
  static Dyadic of_wide(detail::Wide magnitude, std::uint64_t carry, std::int64_t offset, bool negative);
  /// Of one or two limbs, not zero.
  bool is_short() const { return limbs_.size() - 1 < 2; }
  detail::Wide short_magnitude() const {
    const std::uint64_t* d = limbs_.data();
    return limbs_.size() == 1 ? d[0] : static_cast<detail::Wide>(d[1]) << 64 | d[0];
  }
  /// From the lowest limb of a to that of b, which is not below it.
  static std::size_t distance(const Dyadic& a, const Dyadic& b) {
    return static_cast<std::size_t>(b.offset_ - a.offset_);
  }
  std::int64_t end() const { return offset_ + static_cast<std::int64_t>(limbs_.size()); }
  void normalise();
  static std::strong_ordering compare_magnitudes(const Dyadic& a, const Dyadic& b);
  static Dyadic sum(const Dyadic& a, const Dyadic& b, bool b_negative);
  static Dyadic add_magnitudes(const Dyadic& a, const Dyadic& b);
  static Dyadic subtract_magnitudes(const Dyadic& larger, const Dyadic& smaller);

  // |*this| = sum of limbs_[i] * 2^(64 (offset_ + i)). Exponents in whole limbs make sums free of shifts.
  // Invariant: first and last limb are not zero; zero has no limbs, offset 0 and is not negative.
  detail::Limbs limbs_;
  std::int64_t offset_ = 0;
  bool negative_ = false;
};

inline Dyadic Dyadic::of_wide(detail::Wide magnitude, std::uint64_t carry, std::int64_t offset, bool negative) {
  const auto low = static_cast<std::uint64_t>(magnitude), high = static_cast<std::uint64_t>(magnitude >> 64);
  Dyadic r;
  if (low != 0) {
    r.limbs_.set(low, high, carry);
  } else if (high != 0) {
    r.limbs_.set(high, carry, 0);
    ++offset;
  } else if (carry != 0) {
    r.limbs_.set(carry, 0, 0);
    offset += 2;
  } else {
    return r;
  }
  r.offset_ = offset;
  r.negative_ = negative;
  return r;
}

inline Dyadic::Dyadic(double value) {
  const auto pattern = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(pattern >> 52 & 0x7ff);
  std::uint64_t significand = pattern & ((std::uint64_t{1} << 52) - 1);
  if (biased == 0x7ff) detail::exact_precondition_violated("Dyadic is made of a finite number");
  if (biased != 0) significand |= std::uint64_t{1} << 52;
  const int exponent = (biased == 0 ? 1 : biased) - 1075;  // value = +-significand * 2^exponent
  const int shift = exponent & 63;
  *this = of_wide(static_cast<detail::Wide>(significand) << shift, 0, (exponent - shift) / 64, pattern >> 63 != 0);
}

inline void Dyadic::normalise() {
  offset_ += static_cast<std::int64_t>(limbs_.trim());
  if (limbs_.empty()) {
    offset_ = 0;
    negative_ = false;
  }
}

inline std::int64_t Dyadic::high_exponent() const {
  if (limbs_.empty()) detail::exact_precondition_violated("high_exponent of a number that is not zero");
  return 64 * end() - 1 - std::countl_zero(limbs_[limbs_.size() - 1]);
}

inline std::int64_t Dyadic::low_exponent() const {
  if (limbs_.empty()) detail::exact_precondition_violated("low_exponent of a number that is not zero");
  return 64 * offset_ + std::countr_zero(limbs_[0]);
}

inline Dyadic Dyadic::operator-() const& {
  Dyadic r = *this;
  r.negative_ = !r.negative_ && !r.limbs_.empty();
  return r;
}

inline Dyadic Dyadic::operator-() && {
  negative_ = !negative_ && !limbs_.empty();
  return std::move(*this);
}

inline std::strong_ordering Dyadic::compare_magnitudes(const Dyadic& a, const Dyadic& b) {
  if (a.limbs_.empty() || b.limbs_.empty()) return a.limbs_.size() <=> b.limbs_.size();
  if (a.end() != b.end()) return a.end() <=> b.end();
  const std::uint64_t *x = a.limbs_.data(), *y = b.limbs_.data();
  std::size_t i = a.limbs_.size(), j = b.limbs_.size();
  while (i > 0 && j > 0) {
    if (x[--i] != y[--j]) return x[i] <=> y[j];
  }
  return i <=> j;  // lowest limbs are not zero
}

inline std::strong_ordering operator<=>(const Dyadic& a, const Dyadic& b) {
  if (a.sign() != b.sign()) return a.sign() <=> b.sign();
  return a.negative_ ? Dyadic::compare_magnitudes(b, a) : Dyadic::compare_magnitudes(a, b);
}

/// |a| + |b|; a's lowest limb is not above b's.
inline Dyadic Dyadic::add_magnitudes(const Dyadic& a, const Dyadic& b) {
  const std::size_t na = a.limbs_.size(), nb = b.limbs_.size(), gap = distance(a, b);
  Dyadic r(detail::Limbs(std::max(na, gap + nb) + 1), a.offset_);
  detail::add(a.limbs_.data(), na, b.limbs_.data(), nb, gap, r.limbs_.data());
  return r;
}

inline Dyadic Dyadic::subtract_magnitudes(const Dyadic& larger, const Dyadic& smaller) {
  const std::size_t nl = larger.limbs_.size(), ns = smaller.limbs_.size();
  if (larger.offset_ <= smaller.offset_) {
    Dyadic r{detail::Limbs(nl), larger.offset_};
    detail::subtract(larger.limbs_.data(), nl, smaller.limbs_.data(), ns, distance(larger, smaller), r.limbs_.data());
    return r;
  }
  const std::size_t gap = distance(smaller, larger);
  Dyadic r{detail::Limbs(gap + nl), smaller.offset_};
  detail::subtract_lower(larger.limbs_.data(), nl, gap, smaller.limbs_.data(), ns, r.limbs_.data());
  return r;
}

inline Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, bool b_negative) {
  if (b.limbs_.empty()) return a;
  if (a.limbs_.empty()) {
    Dyadic r = b;
    r.negative_ = b_negative;
    return r;
  }
  if (a.offset_ == b.offset_ && a.is_short() && b.is_short()) {
    const detail::Wide x = a.short_magnitude(), y = b.short_magnitude();
    if (a.negative_ == b_negative) return of_wide(x + y, x + y < x ? 1 : 0, a.offset_, b_negative);
    return x < y ? of_wide(y - x, 0, a.offset_, b_negative) : of_wide(x - y, 0, a.offset_, a.negative_);
  }
  if (a.negative_ == b_negative) {
    Dyadic r = a.offset_ <= b.offset_ ? add_magnitudes(a, b) : add_magnitudes(b, a);
    r.negative_ = b_negative;
    r.normalise();
    return r;
  }
  const std::strong_ordering order = compare_magnitudes(a, b);
  if (order == 0) return {};
  Dyadic r = order > 0 ? subtract_magnitudes(a, b) : subtract_magnitudes(b, a);
  r.negative_ = order > 0 ? a.negative_ : b_negative;
  r.normalise();
  return r;
}

inline Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  const std::size_t na = a.limbs_.size(), nb = b.limbs_.size();
  if (na == 0 || nb == 0) return {};
  if (na == 1 && nb == 1) {
    const detail::Wide product = static_cast<detail::Wide>(*a.limbs_.data()) * *b.limbs_.data();
    return Dyadic::of_wide(product, 0, a.offset_ + b.offset_, a.negative_ != b.negative_);
  }
  Dyadic r(detail::Limbs(na + nb), a.offset_ + b.offset_);
  detail::multiply(a.limbs_.data(), na, b.limbs_.data(), nb, r.limbs_.data());
  r.negative_ = a.negative_ != b.negative_;
  r.normalise();
  return r;
}

inline Dyadic mul_pow2(const Dyadic& a, std::int64_t exponent) {
  const int shift = static_cast<int>(exponent & 63);
  if (a.limbs_.empty() || shift == 0) {
    Dyadic r = a;
    if (!a.limbs_.empty()) r.offset_ += exponent / 64;
    return r;
  }
  const std::size_t n = a.limbs_.size();
  Dyadic r(detail::Limbs(n + 1), a.offset_ + (exponent - shift) / 64);
  const std::uint64_t* in = a.limbs_.data();
  std::uint64_t* out = r.limbs_.data();
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = in[i] << shift | carry;
    carry = in[i] >> (64 - shift);
  }
  out[n] = carry;
  r.negative_ = a.negative_;
  r.normalise();
  return r;
}

inline std::uint64_t Dyadic::bits_from(std::int64_t position) const {
  const std::int64_t shift = ((position % 64) + 64) % 64;
  const std::int64_t index = (position - shift) / 64;
  const std::uint64_t low = limb_at(index) >> shift;
  return shift == 0 ? low : low | limb_at(index + 1) << (64 - shift);
}

namespace detail {
/// 2^exponent, a normal number.
template <std::floating_point Real>
constexpr Real power_of_two(std::int64_t exponent) {
  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;
  using Limits = std::numeric_limits<Real>;
  return std::bit_cast<Real>(static_cast<Bits>(exponent + Limits::max_exponent - 1) << (Limits::digits - 1));
}
}  // namespace detail

template <std::floating_point Real>
Real Dyadic::round(Direction direction) const {
  using Limits = std::numeric_limits<Real>;
  if (limbs_.empty()) return 0;
  const std::int64_t high = high_exponent();
  const bool away = direction == (negative_ ? Direction::down : Direction::up);  // directed rounding grows |*this|
  const bool nearest = direction == Direction::nearest;
  Real magnitude = 0;
  if (high >= Limits::max_exponent) {
    magnitude = nearest || away ? Limits::infinity() : Limits::max();
  } else {
    // The unit in the last place of the result: 2^ulp, with gradual underflow.
    constexpr std::int64_t lowest = Limits::min_exponent - Limits::digits;
    const std::int64_t ulp = std::max<std::int64_t>(high - (Limits::digits - 1), lowest);
    std::uint64_t m = high < ulp ? 0 : bits_from(ulp);  // below 2^digits
    const std::int64_t low = low_exponent();
    const bool half = high >= ulp - 1 && (bits_from(ulp - 1) & 1U) != 0;
    const bool rest = low < ulp - 1;
    const bool increment = nearest ? half && (rest || (m & 1U) != 0) : away && low < ulp;
    m += increment ? 1U : 0U;
    // m <= 2^digits and m * 2^ulp is a Real or overflows: no step of the scaling rounds. Factors are normal numbers.
    const std::int64_t first = std::max<std::int64_t>(ulp, Limits::min_exponent - 1);
    magnitude = static_cast<Real>(m) * detail::power_of_two<Real>(first) * detail::power_of_two<Real>(ulp - first);
  }
  return negative_ ? -magnitude : magnitude;
}

inline std::string Dyadic::to_string() const {
  if (limbs_.empty()) return "0x0p+0";
  std::string digits;
  const std::int64_t low = low_exponent();
  for (std::int64_t position = low; position <= high_exponent(); position += 4) {
    digits.insert(digits.begin(), "0123456789abcdef"[bits_from(position) & 15U]);
  }
  return (negative_ ? "-0x" : "0x") + digits + (low < 0 ? "p" : "p+") + std::to_string(low);
}

inline Dyadic abs(const Dyadic& a) { return a.sign() < 0 ? -a : a; }
inline Dyadic min(const Dyadic& a, const Dyadic& b) { return b < a ? b : a; }
inline Dyadic max(const Dyadic& a, const Dyadic& b) { return a < b ? b : a; }
inline Dyadic fma(const Dyadic& a, const Dyadic& b, const Dyadic& c) { return a * b + c; }

}  // namespace tightrope
