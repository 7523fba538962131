#pragma once
/// The fingerprint of source files that generated code carries.

#include <cstdint>
#include <string_view>

namespace tightrope::codegen {

/// FNV-1a, 64 bits [Fowler, Noll, Vo 1991]: recognises an edited source file; not meant to withstand forgery.
class Fnv1a {
 public:
  void add(std::string_view bytes);
  /// A text with its length, so that ("ab", "c") and ("a", "bc") differ.
  void add_text(std::string_view text);
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;  // the published offset basis
};

}  // namespace tightrope::codegen
