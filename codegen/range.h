#pragma once
/// Compile-time interval arithmetic on real numbers, rounded outwards.

#include <optional>

namespace tightrope::codegen {

/// The real numbers from lo to hi; an end may be infinite. Never empty.
struct Range {
  double lo = 0;
  double hi = 0;
  bool operator==(const Range&) const = default;
};

// Operations on doubles, never above (down) and never below (up) the exact result, and equal to it where it is a
// double of ordinary size: 2 * 2 is 4, so that a range that ends at a power of two stays there.
double sum_up(double x, double y);
double sum_down(double x, double y);
double product_up(double x, double y);
double product_down(double x, double y);
double quotient_up(double x, double y);  ///< y != 0
double quotient_down(double x, double y);
double root_up(double x);  ///< x >= 0
double root_down(double x);
double scaled_up(double x, int exponent);  ///< x * 2^exponent
double scaled_down(double x, int exponent);

Range symmetric(double magnitude);  ///< [-magnitude, magnitude]
double magnitude(const Range& x);   ///< the largest |element|
double mignitude(const Range& x);   ///< the smallest |element|
bool contains_zero(const Range& x);

Range operator+(const Range& x, const Range& y);
Range operator-(const Range& x, const Range& y);
Range operator-(const Range& x);
Range operator*(const Range& x, const Range& y);
Range square(const Range& x);
Range quotient(const Range& x, const Range& y);  ///< y does not contain 0
Range root(const Range& x);                      ///< of the elements that are not negative
Range scaled(const Range& x, int exponent);
Range absolute(const Range& x);
Range minimum(const Range& x, const Range& y);
Range maximum(const Range& x, const Range& y);
Range hull(const Range& x, const Range& y);
/// All numbers within `distance` of an element.
Range widened(const Range& x, double distance);
/// The elements that two enclosures of the same number share.
Range intersection(const Range& x, const Range& y);

}  // namespace tightrope::codegen
