#pragma once
/// The files of a fit: predicates, C++ around them, a program that checks both, and their build.

#include <string>
#include <vector>

#include "fit/choice.h"

namespace tightrope::ccd {

struct FitFile {
  std::string name;
  std::string text;
};

/// What files, functions and predicates are called: letters, digits and _, the first a letter.
bool is_fit_name(const std::string& name);

/// All but the report. The same choices give the same bytes. `times`: functions that give the time of impact, too.
std::vector<FitFile> fit_files(const std::string& name, const std::vector<Choice>& choices, bool times);

}  // namespace tightrope::ccd
