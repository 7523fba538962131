#pragma once
/// The stability atlas: how often each method is wrong, in doubt, or in need of exact arithmetic, in every cell of a
/// sweep around degenerate queries.

#include <cstdint>
#include <string>
#include <vector>

#include "stability/axes.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd::stability {

using Counts = std::vector<std::uint32_t>;  ///< one a cell, in the order of Axes::cell

/// What one method answered in the cells of a map.
struct MethodCounts {
  std::string method;
  Counts misses;           ///< contacts denied
  Counts false_alarms;     ///< contacts claimed where there is none
  Counts uncertain;        ///< queries that met a sign that error bounds could not tell
  Counts signs;            ///< that were read
  Counts uncertain_signs;  ///< of them
  Counts exact;            ///< queries that exact arithmetic decided; empty: the method has none
};

/// One family, one kind, one type.
struct Map {
  std::string family;
  Kind kind{};
  Real real{};
  Counts queries;   ///< those whose coordinates are finite in the type
  Counts contacts;  ///< of them, by the exact oracle
  std::vector<MethodCounts> methods;
};

/// A method, and what it promises.
struct AtlasMethod {
  std::string name;
  bool conservative = false;  ///< misses must be 0
  bool exact = false;         ///< false alarms must be 0
  bool operator==(const AtlasMethod&) const = default;
};

/// A family of degenerate queries.
struct Family {
  std::string name;
  std::string what;  ///< in a few words
};

struct Atlas {
  std::uint64_t seed = 0;
  std::size_t queries = 0;  ///< a cell
  Axes axes;
  std::vector<Family> families;
  std::vector<AtlasMethod> methods;
  std::vector<Map> maps;
};

}  // namespace tightrope::ccd::stability
