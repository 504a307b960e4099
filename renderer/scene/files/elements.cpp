// The table of elements.
#include "renderer/scene/files/elements.h"

namespace marrow {
namespace {

// Symbol, van der Waals radius, covalent radius, in angstrom, in the order of the atomic number; 0 is not known.
// Carbon has its sp3 covalent radius; manganese, iron and cobalt theirs of high spin, the larger ones.
// clang-format off
constexpr std::array<Element, element_count> table{{
    {"H", 1.1, 0.31}, {"He", 1.4, 0.28}, {"Li", 1.81, 1.28}, {"Be", 1.53, 0.96}, {"B", 1.92, 0.84}, {"C", 1.7, 0.76},
    {"N", 1.55, 0.71}, {"O", 1.52, 0.66}, {"F", 1.47, 0.57}, {"Ne", 1.54, 0.58}, {"Na", 2.27, 1.66},
    {"Mg", 1.73, 1.41}, {"Al", 1.84, 1.21}, {"Si", 2.1, 1.11}, {"P", 1.8, 1.07}, {"S", 1.8, 1.05}, {"Cl", 1.75, 1.02},
    {"Ar", 1.88, 1.06}, {"K", 2.75, 2.03}, {"Ca", 2.31, 1.76}, {"Sc", 2.58, 1.7}, {"Ti", 2.46, 1.6},
    {"V", 2.42, 1.53}, {"Cr", 2.45, 1.39}, {"Mn", 2.45, 1.61}, {"Fe", 2.44, 1.52}, {"Co", 2.4, 1.5},
    {"Ni", 2.4, 1.24}, {"Cu", 2.38, 1.32}, {"Zn", 2.39, 1.22}, {"Ga", 1.87, 1.22}, {"Ge", 2.11, 1.2},
    {"As", 1.85, 1.19}, {"Se", 1.9, 1.2}, {"Br", 1.83, 1.2}, {"Kr", 2.02, 1.16}, {"Rb", 3.03, 2.2},
    {"Sr", 2.49, 1.95}, {"Y", 2.75, 1.9}, {"Zr", 2.52, 1.75}, {"Nb", 2.56, 1.64}, {"Mo", 2.45, 1.54},
    {"Tc", 2.44, 1.47}, {"Ru", 2.46, 1.46}, {"Rh", 2.44, 1.42}, {"Pd", 2.15, 1.39}, {"Ag", 2.53, 1.45},
    {"Cd", 2.49, 1.44}, {"In", 1.93, 1.42}, {"Sn", 2.17, 1.39}, {"Sb", 2.06, 1.39}, {"Te", 2.06, 1.38},
    {"I", 1.98, 1.39}, {"Xe", 2.16, 1.4}, {"Cs", 3.43, 2.44}, {"Ba", 2.68, 2.15}, {"La", 2.98, 2.07},
    {"Ce", 2.88, 2.04}, {"Pr", 2.92, 2.03}, {"Nd", 2.95, 2.01}, {"Pm", 0, 1.99}, {"Sm", 2.9, 1.98},
    {"Eu", 2.87, 1.98}, {"Gd", 2.83, 1.96}, {"Tb", 2.79, 1.94}, {"Dy", 2.87, 1.92}, {"Ho", 2.81, 1.92},
    {"Er", 2.83, 1.89}, {"Tm", 2.79, 1.9}, {"Yb", 2.8, 1.87}, {"Lu", 2.74, 1.87}, {"Hf", 2.63, 1.75},
    {"Ta", 2.53, 1.7}, {"W", 2.57, 1.62}, {"Re", 2.49, 1.51}, {"Os", 2.48, 1.44}, {"Ir", 2.41, 1.41},
    {"Pt", 2.29, 1.36}, {"Au", 2.32, 1.36}, {"Hg", 2.45, 1.32}, {"Tl", 1.96, 1.45}, {"Pb", 2.02, 1.46},
    {"Bi", 2.07, 1.48}, {"Po", 1.97, 1.4}, {"At", 2.02, 1.5}, {"Rn", 2.2, 1.5}, {"Fr", 3.48, 2.6}, {"Ra", 2.83, 2.21},
    {"Ac", 2.8, 2.15}, {"Th", 2.93, 2.06}, {"Pa", 2.88, 2}, {"U", 2.71, 1.96}, {"Np", 2.82, 1.9}, {"Pu", 2.81, 1.87},
    {"Am", 2.83, 1.8}, {"Cm", 3.05, 1.69}, {"Bk", 3.4, 0}, {"Cf", 3.05, 0}, {"Es", 2.7, 0}, {"Fm", 0, 0},
    {"Md", 0, 0}, {"No", 0, 0}, {"Lr", 0, 0}, {"Rf", 0, 0}, {"Db", 0, 0}, {"Sg", 0, 0}, {"Bh", 0, 0}, {"Hs", 0, 0},
    {"Mt", 0, 0}, {"Ds", 0, 0}, {"Rg", 0, 0}, {"Cn", 0, 0}, {"Nh", 0, 0}, {"Fl", 0, 0}, {"Mc", 0, 0}, {"Lv", 0, 0},
    {"Ts", 0, 0}, {"Og", 0, 0},
}};
// clang-format on

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool is_letter(char c) { return upper(c) >= 'A' && upper(c) <= 'Z'; }

}  // namespace

const std::array<Element, element_count>& elements() { return table; }

std::optional<std::uint8_t> find_element(std::string_view symbol) {
  while (!symbol.empty() && !is_letter(symbol.back())) symbol.remove_suffix(1);
  if (symbol.empty() || symbol.size() > 2) return std::nullopt;
  const char name[2] = {upper(symbol[0]), symbol.size() > 1 ? lower(symbol[1]) : '\0'};
  const std::string_view wanted(name, symbol.size());
  if (wanted == "D" || wanted == "T") return std::uint8_t{0};
  for (std::size_t i = 0; i < table.size(); ++i)
    if (wanted == table[i].symbol) return static_cast<std::uint8_t>(i);
  return std::nullopt;
}

}  // namespace marrow
