// Tables and paragraphs for a terminal.
#include <gtest/gtest.h>

#include "feldspar/base/text_table.hpp"

namespace feldspar {
namespace {

TEST(TextTable, IsAsWideAsWhatItShows) {
    EXPECT_EQ(aligned({{"name", "MPa"}, {"a", "12.5"}}, 1), "name   MPa\n----------\na     12.5\n");
}

TEST(TextTable, ShowsControlCharactersEscapedAndStaysInItsLines) {
    EXPECT_EQ(aligned({{"name", "MPa"}, {"\x1b[31ma\r\nb\a", "1"}}, 1),
              "name                    MPa\n"
              "---------------------------\n"
              "\\x1b[31ma\\x0d\\x0ab\\x07    1\n");
}

TEST(WrappedText, ShowsControlCharactersEscaped) { EXPECT_EQ(wrapped_text("a \x1b[2J b\rc\x7f", "  "), "  a \\x1b[2J b\\x0dc\\x7f\n"); }

}  // namespace
}  // namespace feldspar
