#pragma once
/// The atlas as JSON. docs/stability.md describes the fields.

#include <string>
#include <string_view>
#include <variant>

#include "stability/atlas.h"

namespace tightrope::ccd::stability {

/// One array of counts a line; the bytes depend on the atlas alone.
std::string to_json(const Atlas& atlas);

struct NoAtlas {
  std::string message;  ///< one line: what is wrong with the text
};

/// The atlas that to_json() wrote.
std::variant<Atlas, NoAtlas> atlas_from_json(std::string_view text);

}  // namespace tightrope::ccd::stability
