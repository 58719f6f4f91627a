// Text in UTF-8: what of it is whole, how wide it is on a terminal, and what of it may stand in a name.
#pragma once

#include <cctype>
#include <cstddef>
#include <string_view>

namespace feldspar {

/// Not the first byte of a character.
constexpr bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

/// Number of characters, each of which takes a column of a terminal. Wide ones (Chinese, say) and combining ones are counted
/// once, too.
inline std::size_t text_columns(std::string_view text) {
    std::size_t columns = 0;
    for (const char c : text) columns += continues_character(c) ? 0 : 1;
    return columns;
}

/// The beginning of the text, of at most so many characters; never half a character.
inline std::string_view first_columns(std::string_view text, std::size_t columns) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (continues_character(text[i])) continue;
        if (seen == columns) return text.substr(0, i);
        ++seen;
    }
    return text;
}

/// The length in bytes of the character that begins at `at`; 0 if there is no whole one.
inline std::size_t character_length(std::string_view text, std::size_t at) {
    const auto c = static_cast<unsigned char>(text[at]);
    const std::size_t length = c < 0x80U                 ? 1
                               : c >= 0xc2U && c < 0xe0U ? 2
                               : c >= 0xe0U && c < 0xf0U ? 3
                               : c >= 0xf0U && c < 0xf5U ? 4
                                                         : 0;
    if (length == 0 || at + length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (!continues_character(text[at + i])) return 0;
    return length;
}

/// Whether the text is made of letters and digits of any script, and of the given further signs. Everything of two bytes or more
/// passes for a letter, but for the control characters U+0080 to U+009F and blanks such as U+00A0 and U+2000 to U+206F.
inline bool made_of_letters_and(std::string_view text, std::string_view further) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_length(text, i);
        if (length == 0) return false;
        const auto c = static_cast<unsigned char>(text[i]);
        if (length == 1 && std::isalnum(c) == 0 && further.find(text[i]) == std::string_view::npos) return false;
        if (c == 0xc2U && static_cast<unsigned char>(text[i + 1]) < 0xa2U) return false;
        if (c == 0xe2U && (static_cast<unsigned char>(text[i + 1]) == 0x80U || static_cast<unsigned char>(text[i + 1]) == 0x81U))
            return false;
        i += length;
    }
    return true;
}

}  // namespace feldspar
