// Text of a user's as it may be shown: a control character in a name must not command the terminal.
#pragma once

#include <string>
#include <string_view>

namespace feldspar {

/// How printable() shows line ends and tabs: as they are, or as escapes, where the text must stay in its line.
enum class LineEnds { kept, escaped };

/// The text with control characters (below 0x20, 0x7f, and U+0080 to U+009F) as escapes such as \x1b. Line ends ("\n", "\r\n")
/// and tabs stay unless they are to be escaped, too.
inline std::string printable(std::string_view text, LineEnds line_ends = LineEnds::kept) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string shown;
    const auto escape = [&](unsigned char c) {
        shown += "\\x";
        shown += digits[c >> 4U];
        shown += digits[c & 15U];
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        const bool kept = line_ends == LineEnds::kept && (c == '\n' || c == '\t' || (c == '\r' && next == '\n'));
        if ((c < 0x20U && !kept) || c == 0x7fU) {
            escape(c);
        } else if (c == 0xc2U && next >= 0x80U && next < 0xa0U) {  // U+0080 to U+009F in UTF-8: some terminals obey them
            escape(static_cast<unsigned char>(next));
            ++i;
        } else {
            shown += text[i];
        }
    }
    return shown;
}

}  // namespace feldspar
