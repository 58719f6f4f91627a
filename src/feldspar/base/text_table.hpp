// Tables for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace feldspar {

using Row = std::vector<std::string>;

/// Columns as wide as their widest cell, a line under the first row; `left` columns from the first on are flush left, the others
/// flush right. @param rows  at least one, all equally long
std::string aligned(const std::vector<Row>& rows, std::size_t left);

}  // namespace feldspar
