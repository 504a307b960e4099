// Where the checkout is, for tests that read its files.
#pragma once

#include <string>

namespace marrow::test {

/// Of all names in it: source_folder() + "/scenes/data/neuron.swc".
std::string source_folder();

}  // namespace marrow::test
