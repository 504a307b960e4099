// What a scene may say about a skeleton file.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "field/base/diagnostics.h"
#include "field/description/field_node.h"

namespace marrow {

/// A column of a table: its name in the header, or its place, counted from 1.
using ColumnName = std::variant<std::string, int>;

/// Which column holds what. Without x, y and z the header must name them so.
struct CsvColumns {
  std::optional<ColumnName> x = {}, y = {}, z = {};
  std::optional<ColumnName> radius = {};
  std::optional<ColumnName> strand = {};  ///< rows with the same value are joined, in the order of the file
  std::optional<ColumnName> id = {};      ///< what `parent` refers to; without it rows are counted from 1
  std::optional<ColumnName> parent = {};  ///< rows are joined to their parents
};

struct SkeletonOptions {
  double scale = 1;                        ///< multiplies positions and the radii of the file
  std::optional<double> min_radius = {};   ///< in scene units; thinner nodes get this radius
  std::optional<double> radius = {};       ///< in scene units; of all nodes, in place of those of the file
  double radius_scale = 1;                 ///< multiplies the radii of the file once more
  CsvColumns columns = {};                 ///< tables only
  std::optional<double> bonds = {};        ///< molecules only: radius of bonds, in scene units; none when left out
  std::vector<std::string> elements = {};  ///< molecules only: symbols of the atoms to take; all when empty
};

/// What a reader makes of a file.
struct SkeletonFile {
  SkeletonGraph graph;
  Diagnostics warnings;
};

}  // namespace marrow
