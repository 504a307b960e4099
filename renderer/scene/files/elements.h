// Chemical elements and their radii.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace marrow {

struct Element {
  const char* symbol;
  double van_der_waals;  ///< angstrom; 0: not known
  double covalent;       ///< angstrom; 0: not known
};

inline constexpr std::size_t element_count = 118;

/// By atomic number less one. Van der Waals radii: main group from Mantina et al., J. Phys. Chem. A 113 (2009) 5806,
/// Table 12 (which keeps Bondi's values of 1964 where he has them), the others from Alvarez, Dalton Trans. 42 (2013)
/// 8617. Covalent radii: Cordero et al., Dalton Trans. (2008) 2832, Table 2.
const std::array<Element, element_count>& elements();

/// The index of a symbol in any case; what follows its letters (a count, a charge) is left out. D and T are hydrogen.
std::optional<std::uint8_t> find_element(std::string_view symbol);

}  // namespace marrow
