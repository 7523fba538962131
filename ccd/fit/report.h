#pragma once
/// What a fit tells about itself.

#include <string>

#include "fit/choice.h"

namespace tightrope::ccd {

/// The scene, what was measured, what was chosen, and why; lines of text.
std::string report(const SceneSample& sample, const Choice& choice, const FitRequest& request);

/// The chosen look in a few words: "double, range 2^-6, face at rest".
std::string in_words(const Look& look, Kind kind, const std::string& range);

}  // namespace tightrope::ccd
