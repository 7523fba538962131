#pragma once
/// A chart as one interactive page.

#include <string>

#include "codegen/charts/layout.h"

namespace tightrope::charts {

/// A page that needs no other file and no network: the picture `svg`, above it a place for each marker that shows its
/// facts under the pointer, a finger or the keyboard's focus, below it the facts of all markers as a table. It is
/// well-formed XML, too.
std::string html_page(const Chart& chart, const Layout& layout, const std::string& svg);

}  // namespace tightrope::charts
