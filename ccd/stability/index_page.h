#pragma once
/// The atlas as one interactive page.

#include <span>
#include <string>

#include "stability/pages.h"

namespace tightrope::ccd::stability {

/// A page of HTML that needs no other file and no network: all pages of heat maps, of which one is shown at a time, the
/// figures of each cell under the pointer, a finger or the keyboard's cursor, a table of each method's rates, and what
/// the axes mean. It is well-formed XML, too. `json`: to_json(atlas).
std::string index_page(const Atlas& atlas, std::span<const Page> pages, const std::string& json);

}  // namespace tightrope::ccd::stability
