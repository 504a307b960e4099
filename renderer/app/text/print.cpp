// The C streams, because they neither throw nor mix badly with libraries that use them.
#include "renderer/app/text/print.h"

#include <cstdio>

namespace marrow {

void say(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void complain(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace marrow
