#include <algorithm>
#include <array>

#include "tightrope/batch.h"

namespace tightrope::ccd {
namespace {

struct NamedSet {
  InstructionSet instructions;
  std::string_view name;
};
constexpr auto names = std::to_array<NamedSet>({{InstructionSet::scalar, "scalar"},
                                                {InstructionSet::sse4, "sse4"},
                                                {InstructionSet::neon, "neon"},
                                                {InstructionSet::avx2, "avx2"},
                                                {InstructionSet::avx512, "avx512"}});

}  // namespace

std::string_view name(InstructionSet instructions) {
  for (const NamedSet& set : names) {
    if (set.instructions == instructions) return set.name;
  }
  return {};
}

std::optional<InstructionSet> instruction_set_by_name(std::string_view name) {
  for (const NamedSet& set : names) {
    if (set.name == name) return set.instructions;
  }
  return std::nullopt;
}

}  // namespace tightrope::ccd
