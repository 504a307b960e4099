// A fingerprint of everything that was read: XXH3, 128 bits.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace marrow {

class SceneHash {
 public:
  SceneHash();
  /// Adds one piece. Its length is hashed too, so that pieces cannot run into each other.
  void add(std::string_view bytes);
  /// 32 hexadecimal digits of all pieces so far.
  std::string hex() const;

 private:
  struct State;
  struct Release {
    void operator()(State*) const;
  };
  std::unique_ptr<State, Release> state_;
};

}  // namespace marrow
