#include "feldspar/study/words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace feldspar {

std::string table_number(double value) {
    if (!std::isfinite(value)) return "-";
    const double size = std::abs(value);
    return size >= 99.95 ? fmt::format("{:.1f}", value) : size >= 9.995 ? fmt::format("{:.2f}", value) : fmt::format("{:.3f}", value);
}

std::string wrapped_text(const std::string& text, const std::string& indent) {
    constexpr std::size_t longest = 110;
    std::string result, line;
    std::istringstream words(text);
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
