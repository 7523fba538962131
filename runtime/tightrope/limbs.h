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

/// Owning sequence of limbs, zero when fresh.
class Limbs {
 public:
  Limbs() : Limbs(0) {}
  explicit Limbs(std::size_t size) : size_(size) {
    if (size > inline_capacity) heap_ = std::make_unique<std::uint64_t[]>(size);
  }
  Limbs(const Limbs& other) : Limbs(other.size_) { std::copy_n(other.data(), size_, data()); }
  Limbs(Limbs&& other) noexcept : size_(other.size_), heap_(std::move(other.heap_)) {
    if (!heap_) std::copy_n(other.inline_.data(), size_, inline_.data());
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
    if (!heap_) std::copy_n(other.inline_.data(), size_, inline_.data());
    other.size_ = 0;
    return *this;
  }
  ~Limbs() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint64_t* data() { return heap_ ? heap_.get() : inline_.data(); }
  const std::uint64_t* data() const { return heap_ ? heap_.get() : inline_.data(); }
  std::uint64_t operator[](std::size_t i) const { return data()[i]; }

  /// Removes zero limbs at both ends; returns how many were removed at the low end.
  std::size_t trim() {
    std::uint64_t* d = data();
    while (size_ > 0 && d[size_ - 1] == 0) --size_;
    std::size_t low = 0;
    while (low < size_ && d[low] == 0) ++low;
    if (low > 0) std::copy(d + low, d + size_, d);
    size_ -= low;
    return low;
  }

 private:
  static constexpr std::size_t inline_capacity = 6;  // 384 bits: degree 6 in doubles of one binade
  std::size_t size_;
  std::unique_ptr<std::uint64_t[]> heap_;
  std::array<std::uint64_t, inline_capacity> inline_ = {};
};

/// out[0 .. na+nb) = a * b, schoolbook; out must be zero.
inline void multiply(const std::uint64_t* a, std::size_t na, const std::uint64_t* b, std::size_t nb,
                     std::uint64_t* out) {
  for (std::size_t i = 0; i < na; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < nb; ++j) {  // (2^64-1)^2 + 2(2^64-1) = 2^128 - 1: no overflow
      const Wide t = static_cast<Wide>(a[i]) * b[j] + out[i + j] + carry;
      out[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    out[i + nb] = carry;
  }
}

/// inout[0 .. n) += a * 2^(64 offset); the sum must fit.
inline void add_to(std::uint64_t* inout, std::size_t n, const Limbs& a, std::size_t offset) {
  std::uint64_t carry = 0;
  for (std::size_t i = offset; i < n && (i < offset + a.size() || carry != 0); ++i) {
    const std::uint64_t limb = i - offset < a.size() ? a[i - offset] : 0;
    const Wide t = static_cast<Wide>(inout[i]) + limb + carry;
    inout[i] = static_cast<std::uint64_t>(t);
    carry = static_cast<std::uint64_t>(t >> 64);
  }
}

/// inout[0 .. n) -= a * 2^(64 offset); the difference must not be negative.
inline void subtract_from(std::uint64_t* inout, std::size_t n, const Limbs& a, std::size_t offset) {
  std::uint64_t borrow = 0;
  for (std::size_t i = offset; i < n && (i < offset + a.size() || borrow != 0); ++i) {
    const std::uint64_t limb = i - offset < a.size() ? a[i - offset] : 0;
    const Wide t = static_cast<Wide>(inout[i]) - limb - borrow;
    inout[i] = static_cast<std::uint64_t>(t);
    borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
  }
}

}  // namespace tightrope::detail
