#pragma once
/// Seeded mutations of programs: damage of the kinds that typing, copying and broken storage do.

#include <random>
#include <string>
#include <vector>

namespace tightrope::fuzz {

/// Every .pred file of the repository, sorted by path: the predicates of the house, the examples and the error cases.
std::vector<std::string> corpus();

/// `text` with one to eight mutations; pieces of other programs come from `programs`.
std::string mutate(std::string text, const std::vector<std::string>& programs, std::mt19937_64& random);

}  // namespace tightrope::fuzz
