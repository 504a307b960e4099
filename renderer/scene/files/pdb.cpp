// Records by their fixed columns; CONECT refers to serial numbers, which are looked up at the end.
#include "renderer/scene/files/pdb.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/molecule.h"
#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

// Columns `first` to `last`, counted from 1 as the guide does; what the line does not reach is left out.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < first) return {};
  return line.substr(first - 1, last - first + 1);
}

std::optional<std::int32_t> serial_in(std::string_view field) {
  const auto number = finite_number(trimmed(field));
  const auto whole = number ? whole_number(*number) : std::nullopt;
  return whole && *whole >= 0 && *whole < 1'000'000 ? std::optional(static_cast<std::int32_t>(*whole)) : std::nullopt;
}

// Names are right-aligned on their element: " CA " is carbon, "CA  " calcium. Names of four letters begin in its
// column, and those of ATOM are never metals.
std::optional<std::uint8_t> element_of(std::string_view line, bool is_hetero) {
  const std::string_view told = trimmed(columns(line, 77, 78));
  if (const auto element = find_element(told)) return element;
  const std::string_view name = columns(line, 13, 16);
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  if (name.size() > 1 && is_letter(name[0]) && is_letter(name[1]) && is_hetero && trimmed(name).size() < 4)
    if (const auto element = find_element(name.substr(0, 2))) return element;
  const auto first = std::find_if(name.begin(), name.end(), is_letter);
  return first == name.end() ? std::nullopt : find_element({first, first + 1});
}

class PdbReader {
 public:
  PdbReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : lines_(text), options_(options), problems_(text, name) {}

  Result<SkeletonFile> read() {
    for (std::string_view line; !problems_.is_full() && lines_.next(line);) {
      const std::string_view record = columns(line, 1, 6);
      if (record == "ATOM  " || record == "HETATM") read_atom(line, record == "HETATM");
      else if (record == "ENDMDL") is_first_model_ = false;
      else if (record == "CONECT" && options_.bonds) read_links(line);
    }
    if (problems_.none()) link();
    SkeletonFile made;
    if (problems_.none()) made = skeleton_of(std::move(molecule_), options_, problems_);
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  struct Serial {
    std::int32_t serial, atom;
    friend auto operator<=>(const Serial&, const Serial&) = default;
  };

  void read_atom(std::string_view line, bool is_hetero) {
    if (!is_first_model_ || !is_chosen_location(line)) return;
    Atom atom{};
    double* const coordinates[] = {&atom.at.x, &atom.at.y, &atom.at.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = trimmed(columns(line, 31 + 8 * axis, 38 + 8 * axis));
      const auto number = finite_number(word);
      if (!number && line.size() < 54)
        return problems_.complain(line.data() + line.size(), "the line ends before its coordinates",
                                  "they stand in columns 31 to 54");
      if (!number)
        problems_.complain(word, quoted_word(word) + " is not a finite number",
                           "coordinates stand in columns 31 to 54, eight each");
      else refuse_beyond(*number * options_.scale, word.data(), problems_);
      *coordinates[axis] = number.value_or(0);
    }
    const auto element = element_of(line, is_hetero);
    if (!element)
      return problems_.complain(line.data() + 12,
                                "the atom " + quoted_word(trimmed(columns(line, 13, 16))) + " is of no known element",
                                "columns 77 and 78 name it");
    atom.element = *element;
    if (molecule_.atoms.size() >= NodeList::max_nodes)
      return problems_.give_up(line.data(), "the file has too many atoms");
    if (const auto serial = options_.bonds ? serial_in(columns(line, 7, 11)) : std::nullopt)
      serials_.push_back({*serial, static_cast<std::int32_t>(molecule_.atoms.size())});
    molecule_.atoms.push_back(atom);
  }

  // Column 17 names the location, columns 22 to 27 the residue.
  bool is_chosen_location(std::string_view line) {
    const std::string_view location = columns(line, 17, 17), residue = columns(line, 22, 27);
    if (location.empty() || location == " ") return true;
    if (residue != residue_ || location_.empty()) {
      residue_ = residue;
      location_ = location;
    }
    return location == location_;
  }

  void read_links(std::string_view line) {
    const auto from = serial_in(columns(line, 7, 11));
    for (std::size_t column = 12; from && column <= 27; column += 5)
      if (const auto to = serial_in(columns(line, column, column + 4))) links_.push_back({*from, *to});
  }

  // Links to atoms that were left out are left out as well.
  void link() {
    std::sort(serials_.begin(), serials_.end());
    const auto atom = [this](std::int32_t serial) {
      const auto found = std::lower_bound(serials_.begin(), serials_.end(), Serial{serial, 0});
      return found != serials_.end() && found->serial == serial ? found->atom : -1;
    };
    for (const auto& [from, to] : links_)
      if (const auto [a, b] = std::minmax({atom(from), atom(to)}); a >= 0 && a < b) molecule_.bonds.push_back({a, b});
  }

  Lines lines_;
  const SkeletonOptions& options_;
  FileProblems problems_;
  Molecule molecule_;
  std::vector<Serial> serials_;
  std::vector<std::array<std::int32_t, 2>> links_;
  std::string_view residue_, location_;
  bool is_first_model_ = true;
};

}  // namespace

Result<SkeletonFile> read_pdb(std::string_view text, const SkeletonOptions& options, const std::string& name) {
  return PdbReader(text, options, name).read();
}

}  // namespace marrow
