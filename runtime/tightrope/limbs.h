#pragma once
/// Magnitudes of exact numbers: little-endian 64-bit limbs, the first few without heap storage. Used by dyadic.h only.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

namespace tightrope::detail {

__extension__ using Wide = unsigned __int128;

/// Ends the program: a precondition of exact arithmetic was violated. Checked in every build type, because exact
/// arithmetic is there to judge other code and must not answer nonsense.
[[noreturn]] inline void exact_precondition_violated(const char* what) {
  std::fprintf(stderr, "tightrope exact arithmetic: precondition violated: %s\n", what);
  std::abort();
}

/// Owning sequence of limbs, zero when fresh. Inline limbs are copied all at once: cheaper than asking how many.
class Limbs {
 public:
  Limbs() = default;
  explicit Limbs(std::size_t size) : size_(size) {
    if (size > inline_capacity) heap_ = std::make_unique<std::uint64_t[]>(size);
  }
  Limbs(const Limbs& other) : size_(other.size_), inline_(other.inline_) {
    if (other.heap_) copy_to_heap(other);
  }
  Limbs(Limbs&& other) noexcept : size_(other.size_), heap_(std::move(other.heap_)), inline_(other.inline_) {
    other.size_ = 0;
  }
  Limbs& operator=(const Limbs& other) {
    if (this != &other) *this = Limbs(other);
    return *this;
  }
  Limbs& operator=(Limbs&& other) noexcept {
    if (this == &other) return *this;
    size_ = other.size_;
    heap_ = std::move(other.heap_);
    inline_ = other.inline_;
    other.size_ = 0;
    return *this;
  }
  ~Limbs() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint64_t* data() { return heap_ ? heap_.get() : inline_.data(); }
  const std::uint64_t* data() const { return heap_ ? heap_.get() : inline_.data(); }
  std::uint64_t operator[](std::size_t i) const { return data()[i]; }

  /// Up to three limbs, zero ones at the high end left out; for an object without limbs, low not zero.
  void set(std::uint64_t low, std::uint64_t middle, std::uint64_t high) {
    inline_[0] = low;
    inline_[1] = middle;
    inline_[2] = high;
    size_ = high != 0 ? 3 : middle != 0 ? 2 : 1;
  }

  /// Removes zero limbs at both ends; returns how many were removed at the low end.
  std::size_t trim() {
    std::uint64_t* d = data();
    while (size_ > 0 && d[size_ - 1] == 0) --size_;
    if (size_ == 0 || d[0] != 0) return 0;
    std::size_t low = 0;
    while (d[low] == 0) ++low;
    std::copy(d + low, d + size_, d);
    size_ -= low;
    return low;
  }

 private:
  void copy_to_heap(const Limbs& other) {
    heap_ = std::make_unique<std::uint64_t[]>(size_);
    std::copy_n(other.heap_.get(), size_, heap_.get());
  }

  static constexpr std::size_t inline_capacity = 8;  // 512 bits: degree 8 in doubles of one binade
  std::size_t size_ = 0;
  std::unique_ptr<std::uint64_t[]> heap_;
  std::array<std::uint64_t, inline_capacity> inline_ = {};
};

/// a + b + carry; carry (0 or 1) becomes that of the sum.
inline std::uint64_t add_limbs(std::uint64_t a, std::uint64_t b, std::uint64_t& carry) {
  const Wide t = static_cast<Wide>(a) + b + carry;
  carry = static_cast<std::uint64_t>(t >> 64);
  return static_cast<std::uint64_t>(t);
}

/// a - b - borrow; borrow (0 or 1) becomes that of the difference.
inline std::uint64_t subtract_limbs(std::uint64_t a, std::uint64_t b, std::uint64_t& borrow) {
  const Wide t = static_cast<Wide>(a) - b - borrow;
  borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
  return static_cast<std::uint64_t>(t);
}

/// out[0 .. na + nb) = a * b, schoolbook; na, nb > 0.
inline void multiply(const std::uint64_t* a, std::size_t na, const std::uint64_t* b, std::size_t nb,
                     std::uint64_t* out) {
  std::uint64_t carry = 0;
  for (std::size_t j = 0; j < nb; ++j) {
    const Wide t = static_cast<Wide>(a[0]) * b[j] + carry;
    out[j] = static_cast<std::uint64_t>(t);
    carry = static_cast<std::uint64_t>(t >> 64);
  }
  out[nb] = carry;
  for (std::size_t i = 1; i < na; ++i) {
    carry = 0;
    for (std::size_t j = 0; j < nb; ++j) {  // (2^64-1)^2 + 2(2^64-1) = 2^128 - 1: no overflow
      const Wide t = static_cast<Wide>(a[i]) * b[j] + out[i + j] + carry;
      out[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    out[i + nb] = carry;
  }
}

/// out[0 .. max(na, gap + nb)] = a + b * 2^(64 gap); out must be zero.
inline void add(const std::uint64_t* a, std::size_t na, const std::uint64_t* b, std::size_t nb, std::size_t gap,
                std::uint64_t* out) {
  std::uint64_t carry = 0;
  for (std::size_t k = 0; k < gap && k < na; ++k) out[k] = a[k];
  std::size_t k = gap, j = 0;
  for (; k < na && j < nb; ++k, ++j) out[k] = add_limbs(a[k], b[j], carry);
  for (; j < nb; ++k, ++j) out[k] = add_limbs(b[j], 0, carry);
  for (; k < na; ++k) out[k] = add_limbs(a[k], 0, carry);
  out[k] = carry;
}

/// out[0 .. na) = a - b * 2^(64 gap), which must not be negative; gap + nb <= na.
inline void subtract(const std::uint64_t* a, std::size_t na, const std::uint64_t* b, std::size_t nb, std::size_t gap,
                     std::uint64_t* out) {
  std::uint64_t borrow = 0;
  for (std::size_t k = 0; k < gap; ++k) out[k] = a[k];
  std::size_t k = gap;
  for (std::size_t j = 0; j < nb; ++k, ++j) out[k] = subtract_limbs(a[k], b[j], borrow);
  for (; k < na; ++k) out[k] = subtract_limbs(a[k], 0, borrow);
}

/// out[0 .. gap + na) = a * 2^(64 gap) - b, which must not be negative; nb <= gap + na.
inline void subtract_lower(const std::uint64_t* a, std::size_t na, std::size_t gap, const std::uint64_t* b,
                           std::size_t nb, std::uint64_t* out) {
  std::uint64_t borrow = 0;
  std::size_t k = 0, i = 0;
  for (; k < gap; ++k) out[k] = subtract_limbs(0, k < nb ? b[k] : 0, borrow);
  for (; k < nb; ++k, ++i) out[k] = subtract_limbs(a[i], b[k], borrow);
  for (; i < na; ++k, ++i) out[k] = subtract_limbs(a[i], 0, borrow);
}

}  // namespace tightrope::detail
