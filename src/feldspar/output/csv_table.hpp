// A table of columns as CSV, for columns that have name, unit, meaning, value(row) and say whether they are whole numbers.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>

namespace feldspar {

/// What the columns mean, a comment line each.
template <class Columns>
void append_meanings(std::string& text, const Columns& columns) {
    for (const auto& column : columns)
        fmt::format_to(std::back_inserter(text), "#   {} [{}] {}\n", column.name, column.unit, column.meaning);
}

/// The line of names, and a line a row.
template <class Columns, class Rows>
void append_csv(std::string& text, const Columns& columns, const Rows& rows) {
    auto out = std::back_inserter(text);
    const char* between = "";
    for (const auto& column : columns) {
        fmt::format_to(out, "{}{}", between, column.name);
        between = ",";
    }
    text += '\n';
    for (const auto& row : rows) {
        between = "";
        for (const auto& column : columns) {
            const double value = column.value(row);
            // {} prints the shortest decimal that reads back as the same double, whatever the locale
            if (column.whole)
                fmt::format_to(out, "{}{}", between, static_cast<long long>(value));
            else
                fmt::format_to(out, "{}{}", between, value);
            between = ",";
        }
        text += '\n';
    }
}

}  // namespace feldspar
