// Tables, numbers and paragraphs for a terminal. Control characters in them stand as escapes (printable.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace feldspar {

using Row = std::vector<std::string>;

/// Columns as wide as their widest cell, a line under the first row; `left` columns from the first on are flush left, the others
/// flush right. Line ends in a cell stand as escapes, too. @param rows  at least one, all equally long
std::string aligned(const std::vector<Row>& rows, std::size_t left);

/// Four digits or so; "-" for not-a-number.
std::string table_number(double value);

/// Words broken into lines of about 110 letters, each behind the indent.
std::string wrapped_text(const std::string& text, const std::string& indent = {});

}  // namespace feldspar
