#pragma once
/// What a reader wants to know of a cell, and of many together.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "stability/atlas.h"

namespace tightrope::ccd::stability {

enum class Figure { misses, false_alarms, uncertain, exact };
inline constexpr std::array<Figure, 4> all_figures = {Figure::misses, Figure::false_alarms, Figure::uncertain,
                                                      Figure::exact};

std::string_view name(Figure figure);  ///< "misses", "false alarms", "uncertain signs", "exact arithmetic"

/// So many of so many. Misses are of contacts, false alarms of queries without contact, uncertain signs of the signs
/// that were read, exact arithmetic of all queries.
struct Rate {
  std::uint64_t count = 0;
  std::uint64_t of = 0;

  Rate& operator+=(const Rate& other) {
    count += other.count;
    of += other.of;
    return *this;
  }
  bool known() const { return of > 0; }
  double value() const { return static_cast<double>(count) / static_cast<double>(of); }
};

Rate rate(Figure figure, const Map& map, const MethodCounts& method, std::size_t cell);
Rate rate(Figure figure, const Map& map, const MethodCounts& method);  ///< of all cells together

/// "0", "0.3 %", "12 %"; "-" if not known. Only 0 is "0".
std::string percent(const Rate& rate);

}  // namespace tightrope::ccd::stability
