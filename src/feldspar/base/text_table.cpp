#include "feldspar/base/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "feldspar/base/printable.hpp"

namespace feldspar {

std::string aligned(const std::vector<Row>& given, std::size_t left) {
    std::vector<Row> rows = given;
    for (Row& row : rows)
        for (std::string& cell : row) cell = printable(cell, LineEnds::escaped);
    std::vector<std::size_t> width(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    std::string text;
    const auto line = [&](const Row& row) {
        std::string one;
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (c > 0) one += "  ";
            one += c < left ? fmt::format("{:<{}}", row[c], width[c]) : fmt::format("{:>{}}", row[c], width[c]);
        }
        while (!one.empty() && one.back() == ' ') one.pop_back();
        text += one + "\n";
    };
    line(rows.front());
    std::size_t total = 2 * (width.size() - 1);
    for (std::size_t w : width) total += w;
    text += std::string(total, '-') + "\n";
    for (std::size_t r = 1; r < rows.size(); ++r) line(rows[r]);
    return text;
}

std::string table_number(double value) {
    if (!std::isfinite(value)) return "-";
    const double size = std::abs(value);
    return size >= 99.95 ? fmt::format("{:.1f}", value) : size >= 9.995 ? fmt::format("{:.2f}", value) : fmt::format("{:.3f}", value);
}

std::string wrapped_text(const std::string& text, const std::string& indent) {
    constexpr std::size_t longest = 110;
    std::string result, line;
    std::istringstream words(printable(text));
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > longest) {
            result += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return result + indent + line + "\n";
}

}  // namespace feldspar
