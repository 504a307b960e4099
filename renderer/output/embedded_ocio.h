// The OpenColorIO configuration inside the program: the text of marrow-figures.ocio.
#pragma once

#include <string_view>

namespace marrow {

std::string_view embedded_ocio();

}  // namespace marrow
