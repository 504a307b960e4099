// A source of its own, so that what is compiled of other tests does not depend on where the checkout is.
#include "tests/source_folder.h"

namespace marrow::test {

std::string source_folder() { return MARROW_SOURCE_DIR; }

}  // namespace marrow::test
