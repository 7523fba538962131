#include "query_io/rational.h"

#include <gmpxx.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace tightrope::ccd {
namespace {

bool is_integer(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string_view without_plus(std::string_view text) {
  if (text.front() == '+') text.remove_prefix(1);
  return text;
}

/// The integer if |integer| <= 2^53, where int64 -> double is exact.
std::optional<std::int64_t> small_integer(std::string_view text) {
  constexpr std::int64_t limit = std::int64_t{1} << 53;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value > limit || value < -limit) return std::nullopt;
  return value;
}

/// Numerator and denominator of at most 53 bits: the quotient of the doubles is rounded once, and it is at least 2^-53
/// if not 0, so the fma gives the exact remainder.
Rational quotient_of_small(std::int64_t numerator, std::int64_t denominator) {
  const double n = static_cast<double>(numerator);
  const double d = static_cast<double>(denominator);
  const double quotient = numerator == 0 ? 0.0 : n / d;
  return {quotient, std::fma(quotient, d, -n) == 0};
}

/// Round to nearest, ties to even, subnormals included.
Rational quotient_of_big(mpz_class numerator, mpz_class denominator) {
  if (numerator == 0) return {};
  const bool negative = (sgn(numerator) < 0) != (sgn(denominator) < 0);
  numerator = abs(numerator);
  denominator = abs(denominator);
  const auto bits = [](const mpz_class& x) { return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2)); };
  // 2^(magnitude-1) < numerator / denominator < 2^(magnitude+1)
  const long magnitude = bits(numerator) - bits(denominator);
  if (magnitude > 1025) return {0, false, "value beyond the range of double"};
  if (magnitude < -1080) return {negative ? -0.0 : 0.0, false};
  // quotient = floor(numerator / denominator * 2^-lsb) with `lsb` the exponent of the double's last bit, or one below
  // it.
  const long lsb = std::max(magnitude - 54, -1075L);
  if (lsb < 0) numerator <<= static_cast<mp_bitcnt_t>(-lsb);
  if (lsb > 0) denominator <<= static_cast<mp_bitcnt_t>(lsb);
  mpz_class quotient;
  mpz_class remainder;
  mpz_fdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  // Drop the bits below the double's last one: to 53 bits, or to 2^-1074.
  const long dropped = std::max(bits(quotient) - 53, -1074 - lsb);
  const mpz_class kept = quotient >> static_cast<mp_bitcnt_t>(dropped);
  const mpz_class low = quotient - (kept << static_cast<mp_bitcnt_t>(dropped));
  const mpz_class half = mpz_class(1) << static_cast<mp_bitcnt_t>(dropped - 1);
  const bool exact = low == 0 && remainder == 0;
  const bool tie = low == half && remainder == 0;
  const bool up = tie ? mpz_odd_p(kept.get_mpz_t()) != 0 : low >= half;
  const mpz_class rounded = up ? mpz_class(kept + 1) : kept;
  const double value = std::ldexp(rounded.get_d(), static_cast<int>(lsb + dropped));  // <= 2^53: both steps are exact
  if (std::isinf(value)) return {0, false, "value beyond the range of double"};
  return {negative ? -value : value, exact};
}

void append_integer(std::string& text, const mpz_class& value) { text += value.get_str(); }

}  // namespace

Rational parse_rational(std::string_view numerator, std::string_view denominator) {
  if (!is_integer(numerator)) return {0, false, "numerator is not an integer"};
  if (!is_integer(denominator)) return {0, false, "denominator is not an integer"};
  numerator = without_plus(numerator);
  denominator = without_plus(denominator);
  const auto n = small_integer(numerator);
  const auto d = small_integer(denominator);
  if (d && *d == 0) return {0, false, "zero denominator"};
  if (n && d) return quotient_of_small(*n, *d);
  mpz_class big_denominator{std::string(denominator), 10};
  if (big_denominator == 0) return {0, false, "zero denominator"};
  return quotient_of_big(mpz_class{std::string(numerator), 10}, std::move(big_denominator));
}

void append_rational(std::string& text, double value) {
  if (value == 0) {
    text += "0,1";
    return;
  }
  // value = mantissa * 2^exponent, mantissa odd
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  exponent -= 53;
  while (mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
  if (exponent <= 0 && exponent >= -62) {
    text += std::to_string(mantissa);
    text += ',';
    text += std::to_string(std::int64_t{1} << -exponent);
    return;
  }
  const mpz_class power = mpz_class(1) << static_cast<mp_bitcnt_t>(std::abs(exponent));
  append_integer(
      text, exponent > 0 ? mpz_class(power * static_cast<long>(mantissa)) : mpz_class(static_cast<long>(mantissa)));
  text += ',';
  append_integer(text, exponent > 0 ? mpz_class(1) : power);
}

}  // namespace tightrope::ccd
