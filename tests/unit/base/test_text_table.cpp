// Tables and paragraphs for a terminal.
#include <gtest/gtest.h>

#include "feldspar/base/text_table.hpp"
#include "feldspar/base/utf8.hpp"

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

TEST(TextTable, CountsCharactersAndNotBytes) {
    EXPECT_EQ(aligned({{"name", "n"}, {"Größe", "1"}}, 1), "name   n\n--------\nGröße  1\n");
}

TEST(TextTable, IsBrokenWhereTheTerminalEnds) {
    const std::vector<Row> rows{{"name", "one", "two", "three"}, {"a", "1", "2", "3"}};
    EXPECT_EQ(aligned(rows, 1, 21), "name  one  two  three\n---------------------\na       1    2      3\n");
    EXPECT_EQ(aligned(rows, 1, 20), "name  one  two\n--------------\na       1    2\n\nname  three\n-----------\na         3\n");
    EXPECT_EQ(
        aligned(rows, 1, 1),
        "name  one\n---------\na       1\n\nname  two\n---------\na       2\n\nname  three\n-----------\na         3\n");  // no
                                                                                                                           // narrower
                                                                                                                           // than
                                                                                                                           // a
                                                                                                                           // column
    EXPECT_EQ(aligned(rows, 1, 17, 2),
              "name  one  two\n--------------\na       1    2\n\nname  one  three\n----------------\na       1      3\n");
}

TEST(WrappedText, IsNoWiderThanTheTerminal) {
    EXPECT_EQ(wrapped_text("one two three", {}, 8), "one two\nthree\n");
    EXPECT_EQ(wrapped_text("öne twö three", {}, 7), "öne twö\nthree\n");
    EXPECT_EQ(wrapped_text("one two", {}, 200), "one two\n");
}

TEST(Utf8, KnowsWholeCharacters) {
    EXPECT_EQ(text_columns("Größe"), 5u);
    EXPECT_EQ(first_columns("Größe", 3), "Grö");
    EXPECT_EQ(first_columns("ab", 5), "ab");
    EXPECT_EQ(character_length("ö", 0), 2u);
    EXPECT_EQ(character_length("\xc3", 0), 0u);      // cut
    EXPECT_EQ(character_length("\xc0\x80", 0), 0u);  // a zero in disguise
    EXPECT_TRUE(made_of_letters_and("Žula-2", "-"));
    EXPECT_FALSE(made_of_letters_and("a b", "-"));
    EXPECT_FALSE(made_of_letters_and("a\xc2\x85", "-"));      // U+0085, a line end
    EXPECT_FALSE(made_of_letters_and("a\xe2\x80\xae", "-"));  // U+202E turns the text around
}

TEST(WrappedText, ShowsControlCharactersEscaped) {
    EXPECT_EQ(wrapped_text("a \x1b[2J b\rc\x7f", "  "), "  a \\x1b[2J b\\x0dc\\x7f\n");
}

}  // namespace
}  // namespace feldspar
