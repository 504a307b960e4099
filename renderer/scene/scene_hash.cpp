// The only door to xxHash.
#include "renderer/scene/scene_hash.h"

#include <cstdint>

#include <xxhash.h>

namespace marrow {

struct SceneHash::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

void SceneHash::Release::operator()(State* state) const { delete state; }

SceneHash::SceneHash() : state_(new State) { XXH3_128bits_reset(state_->xxh); }

void SceneHash::add(std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  unsigned char length[8];  // little endian on every machine
  for (int i = 0; i < 8; ++i) length[i] = static_cast<unsigned char>(size >> (8 * i));
  XXH3_128bits_update(state_->xxh, length, sizeof length);
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

std::string SceneHash::hex() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->xxh));
  constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : canonical.digest) (text += digits[byte >> 4]) += digits[byte & 15];
  return text;
}

}  // namespace marrow
