#include "codegen/hash.h"

namespace tightrope::codegen {

void Fnv1a::add(std::string_view bytes) {
  for (const char c : bytes) {
    state_ ^= static_cast<unsigned char>(c);
    state_ *= 0x100000001b3U;  // the published prime, 2^40 + 2^8 + 0xb3
  }
}

void Fnv1a::add_text(std::string_view text) {
  char length[8];  // little-endian, the same on every machine
  for (int i = 0; i < 8; ++i) length[i] = static_cast<char>((text.size() >> (8 * i)) & 0xff);
  add({length, sizeof length});
  add(text);
}

}  // namespace tightrope::codegen
