#pragma once
/// Which stage of method `tightrope` decides how many queries, and what that costs.

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "ccd/impact/stage.h"
#include "command/evaluation.h"

namespace tightrope::ccd {

struct StagesRequest {
  std::vector<std::string> paths;
  std::optional<Kind> kind;
  Question question = Question::whether;
  Precision precision = Precision::in_double;
};

inline constexpr std::array stages_in_order{Stage::first_look, Stage::separation, Stage::hull, Stage::subdivision,
                                            Stage::exact};
std::string_view name(Stage stage);  ///< "first-look", "separation", ..

/// The queries of one kind that one stage decides.
struct StageRow {
  Kind kind{};
  Stage stage{};
  std::uint64_t queries = 0;
  double fraction = 0;      ///< of the kind's queries
  double ns_per_query = 0;  ///< of these, from the start: with all stages that they pass
  double time_share = 0;    ///< of the time of all the kind's queries
};

/// Kind by kind, stage by stage; no kind without queries. The time is that of the queries which one stage decides,
/// measured as a group: medians of passes over blocks, summed.
std::variant<std::vector<StageRow>, FileError> stage_times(const StagesRequest& request);

}  // namespace tightrope::ccd
