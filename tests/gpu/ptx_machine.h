#pragma once
/// What the C++ made of PTX (ptx_to_cpp.py) runs on: one fiber a thread, a warp of 32 at a time. A fiber runs until the
/// warp has to meet; blocks run one after another. Registers and memory start with garbage.

#include <ucontext.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace tightrope::ptx {

inline constexpr std::size_t most_shared = 1U << 16;
inline constexpr int lanes = 32;

class Warp;

struct Thread {
  std::uint32_t tid, ntid, ctaid, nctaid;
  unsigned char* shared;
  Warp* warp;
  int lane;

  void wait();
  std::uint32_t ballot(bool mine);
  std::uint32_t shuffle(std::uint32_t mine, std::int64_t from);
};

using Run = void (*)(Thread&, unsigned char* parameter);
struct Kernel {
  std::string name;  ///< mangled
  Run run;
};
const std::vector<Kernel>& kernels();

/// Runs a kernel with one parameter.
void launch(Run kernel, const void* parameter, std::size_t bytes, std::uint32_t blocks, std::uint32_t threads);

template <class To>
To from_bits(std::conditional_t<sizeof(To) == 8, std::uint64_t, std::uint32_t> bits) {
  To to;
  std::memcpy(&to, &bits, sizeof(to));
  return to;
}

/// A value as an instruction of type To reads it: numbers are converted, registers of bits are read as they are.
template <class To, class From>
To as(From x) {
  if constexpr (std::is_floating_point_v<To> != std::is_floating_point_v<From> && sizeof(To) == sizeof(From)) {
    To to;
    std::memcpy(&to, &x, sizeof(to));
    return to;
  } else {
    return static_cast<To>(x);
  }
}
template <class To, class From>
void set(To& to, From x) {
  to = as<To>(x);
}

/// A register of the parts, lowest first, and the parts of a register.
template <class To, class... Part>
void pack(To& to, Part... parts) {
  unsigned char* at = reinterpret_cast<unsigned char*>(&to);
  ((std::memcpy(at, &parts, sizeof(parts)), at += sizeof(parts)), ...);
}
template <class From, class... Part>
void unpack(From from, Part&... parts) {
  const unsigned char* at = reinterpret_cast<const unsigned char*>(&from);
  ((std::memcpy(&parts, at, sizeof(parts)), at += sizeof(parts)), ...);
}

template <class T>
T load(const unsigned char* from) {
  T x;
  std::memcpy(&x, from, sizeof(x));
  return x;
}
template <class T, class From>
void store(unsigned char* to, From x) {
  const T y = as<T>(x);
  std::memcpy(to, &y, sizeof(y));
}
template <class T>
T add_to(unsigned char* to, std::int64_t x) {
  const T before = load<T>(to);
  store<T>(to, static_cast<T>(before + static_cast<T>(x)));
  return before;
}
template <class T, std::size_t N>
void scramble(T (&registers)[N]) {
  std::memset(registers, std::is_same_v<T, bool> ? 1 : 0xab, sizeof(registers));
}

template <class T>
bool is_unordered(T a, T b) {
  return a != a || b != b;
}
template <class T>
T shift_left(T x, std::uint32_t by) {
  return by >= 8 * sizeof(T) ? T(0) : static_cast<T>(x << by);
}
template <class T>
T shift_right(T x, std::uint32_t by) {
  return by >= 8 * sizeof(T) ? static_cast<T>(x < 0 ? -1 : 0) : static_cast<T>(x >> by);
}
/// A NaN is passed over; +0 is above -0.
template <class T>
T maximum_of(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (a != a) return b;
    if (b != b) return a;
    if (a == b) return std::signbit(a) ? b : a;
  }
  return a > b ? a : b;
}
template <class T>
T minimum_of(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (a != a) return b;
    if (b != b) return a;
    if (a == b) return std::signbit(a) ? a : b;
  }
  return a < b ? a : b;
}
/// A defect: magnitudes keep their signs. The tests must notice.
inline bool forgets_magnitudes = false;
template <class T>
T absolute(T a) {
  if (forgets_magnitudes) return a;
  return a < 0 || (std::is_floating_point_v<T> && std::signbit(static_cast<double>(a))) ? -a : a;
}
inline std::uint32_t popc(std::uint32_t x) { return static_cast<std::uint32_t>(__builtin_popcount(x)); }
inline std::uint32_t brev(std::uint32_t x) {
  std::uint32_t y = 0;
  for (int i = 0; i < 32; ++i) y |= (x >> i & 1U) << (31 - i);
  return y;
}
inline std::uint32_t bfind_shiftamt(std::uint32_t x) {
  return x == 0 ? 0xffffffffU : static_cast<std::uint32_t>(__builtin_clz(x));
}
/// The bytes of (b, a) that the selector names.
inline std::uint32_t prmt(std::uint32_t a, std::uint32_t b, std::uint32_t selector) {
  const std::uint64_t bytes = std::uint64_t{b} << 32 | a;
  std::uint32_t result = 0;
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t which = selector >> (4 * i) & 15U;
    std::uint32_t byte = static_cast<std::uint32_t>(bytes >> (8 * (which & 7U)) & 255U);
    if ((which & 8U) != 0) byte = (byte & 128U) != 0 ? 255U : 0U;
    result |= byte << (8 * i);
  }
  return result;
}

}  // namespace tightrope::ptx
