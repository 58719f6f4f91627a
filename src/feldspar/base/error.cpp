#include "feldspar/base/error.hpp"

namespace feldspar {

std::string InputError::compose(const InputPlace& place, const std::string& problem, const std::string& allowed,
                                const std::string& suggestion) {
    std::string text = place.file;
    if (place.line > 0) text += ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
    if (!text.empty()) text += ": ";
    if (!place.key.empty()) text += place.key + ": ";
    text += problem;
    if (!allowed.empty()) text += "\n  allowed: " + allowed;
    if (!suggestion.empty()) text += "\n  " + suggestion;
    return text;
}

}  // namespace feldspar
