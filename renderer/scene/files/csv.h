// Skeletons in tables (CSV, TSV): a node a row.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// The rows of a table (table_rows.h). Columns are named or counted by `SkeletonOptions::columns`; those that are not
/// named there are looked for in the header as x, y, z, radius, strand, id and parent, whatever their case. Rows are
/// joined to the row before of the same strand (any word; `1` and `1.0` are two), or to their parents, or are points. A
/// parent that is empty, negative, or 0 where no row has the id 0 makes a root. A header is a first row with a word
/// where a number is needed. Errors: columns that do not exist; fields that are no numbers, up to 20; rows with more
/// fields than the first, or without a strand; no radius; what parent_indices() reports.
Result<SkeletonFile> read_csv(std::string_view text, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
