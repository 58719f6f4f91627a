#include "feldspar/base/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "feldspar/base/printable.hpp"
#include "feldspar/base/utf8.hpp"

namespace feldspar {

namespace {

constexpr std::size_t kBetween = 2;  // blanks between columns

// These columns alone, with a line under the first row.
std::string some_columns(const std::vector<Row>& rows, const std::vector<std::size_t>& columns,
                         const std::vector<std::size_t>& width, std::size_t left) {
    std::string text;
    const auto line = [&](const Row& row) {
        std::string one;
        for (const std::size_t c : columns) {
            if (c != columns.front()) one += std::string(kBetween, ' ');
            const std::string blanks(width[c] - text_columns(row[c]), ' ');
            one += c < left ? row[c] + blanks : blanks + row[c];
        }
        while (!one.empty() && one.back() == ' ') one.pop_back();
        text += one + "\n";
    };
    line(rows.front());
    std::size_t total = kBetween * (columns.size() - 1);
    for (const std::size_t c : columns) total += width[c];
    text += std::string(total, '-') + "\n";
    for (std::size_t r = 1; r < rows.size(); ++r) line(rows[r]);
    return text;
}

}  // namespace

std::string aligned(const std::vector<Row>& given, std::size_t left, std::size_t widest, std::size_t repeated) {
    std::vector<Row> rows = given;
    for (Row& row : rows)
        for (std::string& cell : row) cell = printable(cell, LineEnds::escaped);
    std::vector<std::size_t> width(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], text_columns(row[c]));

    std::string text;
    std::vector<std::size_t> columns;
    std::size_t total = 0;
    for (std::size_t c = 0; c < width.size(); ++c) {
        if (widest > 0 && columns.size() > repeated &&
            total + kBetween + width[c] > widest) {  // the rest below, behind the first columns again
            text += some_columns(rows, columns, width, left) + "\n";
            columns.resize(repeated);
            total = kBetween * (repeated - 1);
            for (const std::size_t first : columns) total += width[first];
        }
        total += (columns.empty() ? 0 : kBetween) + width[c];
        columns.push_back(c);
    }
    return text + some_columns(rows, columns, width, left);
}

std::string table_number(double value) {
    if (!std::isfinite(value)) return "-";
    const double size = std::abs(value);
    return size >= 99.95   ? fmt::format("{:.1f}", value)
           : size >= 9.995 ? fmt::format("{:.2f}", value)
                           : fmt::format("{:.3f}", value);
}

std::string wrapped_text(const std::string& text, const std::string& indent, std::size_t widest) {
    const std::size_t longest = widest > 0 ? std::min(widest, usual_text_width) : usual_text_width;
    std::string result, line;
    std::istringstream words(printable(text));
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + text_columns(line) + 1 + text_columns(word) > longest) {
            result += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return result + indent + line + "\n";
}

}  // namespace feldspar
