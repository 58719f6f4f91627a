// Tables, numbers and paragraphs for a terminal. Control characters in them stand as escapes (printable.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace feldspar {

using Row = std::vector<std::string>;

inline constexpr std::size_t usual_text_width = 110;

/// Columns as wide as their widest cell, a line under the first row; `left` columns from the first on are flush left, the others
/// flush right. Line ends in a cell stand as escapes, too. @param rows  at least one, all equally long
/// @param widest  columns of the terminal: a table that is wider is broken into several, one below the other, each of which
/// begins with the first `repeated` columns (1 or more); 0: as wide as it is
std::string aligned(const std::vector<Row>& rows, std::size_t left, std::size_t widest = 0, std::size_t repeated = 1);

/// Four digits or so; "-" for not-a-number.
std::string table_number(double value);

/// Words broken into lines of about 110 letters, each behind the indent. @param widest  columns of the terminal, if it has fewer;
/// 0: unknown
std::string wrapped_text(const std::string& text, const std::string& indent = {}, std::size_t widest = 0);

}  // namespace feldspar
