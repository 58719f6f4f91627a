// All mistakes of a job at once: in the order of lines, each as it is told when it is the only one, and none that only follows
// from another.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "broken_lines.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/mistakes.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

using Edits = std::vector<std::pair<std::string, std::string>>;

std::vector<InputError> mistakes_of(const std::string& text) {
    try {
        (void)parse_job(text, "job.toml");
    } catch (const InputError& error) {
        return each_mistake(error);
    }
    return {};
}

std::string message_of(const std::string& text) {
    try {
        (void)parse_job(text, "job.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

// Each edit keeps its line where it is.
void expect_told_together(const Edits& edits, const std::string& original) {
    std::string text = original, wanted;
    for (const auto& [from, to] : edits) {
        text = edited(from, to, text);
        wanted += (wanted.empty() ? "" : "\n") + message_of(edited(from, to, original));
    }
    EXPECT_EQ(message_of(text), wanted);
    EXPECT_EQ(mistakes_of(text).size(), edits.size());
}

TEST(Mistakes, FiveOfAJobAreToldInTheOrderOfLinesEachAsIfAlone) {
    expect_told_together({{"width = \"80 mm\"", "width = \"80 mn\""},
                          {"porosity = 0.10", "porosity = 1.1"},
                          {"kind = \"flexible\"", "kind = \"flexibel\""},
                          {"Kn = ", "kn = "},
                          {"seeds = [1, 2, 3, 4, 5]", "seeds = [1, 2, 1]"}},
                         sample_job);
}

TEST(Mistakes, OfEverySectionOfAJobAreToldTogether) {
    expect_told_together({{"shape = \"rectangle\"", "shape = \"square\""},
                          {"distribution = \"uniform\"", "distribution = \"even\""},
                          {"merge_length = \"auto\"", "merge_length = \"some\""},
                          {"plane = \"stress\"", "plane = \"bent\""},
                          {"nu = 0.23", "nu = 0.5"},
                          {"law = \"bilinear\"", "law = \"bilinaer\""},
                          {"Gfs = \"800 N/m\"", "Gfs = \"800 MPa\""},
                          {"accuracy = \"0.5 %\"", "accuracy = \"50 %\""},
                          {"kind = \"uniaxial-compression\"", "kind = \"uniaxial\""},
                          {"UCS = \"122.1 MPa\"", "UCS = 122.1"}},
                         sample_job);
}

TEST(Mistakes, OfVariantsAreToldTogetherAndThoseOfTheJobOnce) {
    expect_told_together({{"strength_preset = \"augig-table2-bilinear\"", "strength_preset = \"augig-table2\""},
                          {"seeds = [2]", "seeds = [-2]"},
                          {"nu = 0.25", "nu = 0.75"},
                          {"normal = \"edge\"", "normal = \"edges\""},
                          {"membrane_plates = 12", "membrane_plates = 0"}},
                         variant_job);
}

TEST(Mistakes, EveryBadElementOfAListIsTold) {
    const std::vector<InputError> found = mistakes_of(edited("seeds = [1, 2, 3, 4, 5]", "seeds = [1, -2, 3, 1, 0.5]"));
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].place().line, 34);
        if (i > 0) {
            EXPECT_GT(found[i].place().column, found[i - 1].place().column);
        }
    }
}

TEST(Mistakes, AreToldUpToTwentyAndTheRestCounted) {
    std::string text = "[specimen]\n";
    for (int i = 0; i < 27; ++i) text += "nothing_like_it_" + std::to_string(i) + " = 1\n";
    const std::string message = message_of(edited("[specimen]\n", text));
    EXPECT_NE(message.find("nothing_like_it_19:"), std::string::npos);
    EXPECT_EQ(message.find("nothing_like_it_20:"), std::string::npos);
    EXPECT_TRUE(message.ends_with("\nand 7 more")) << message;
    EXPECT_EQ(mistakes_of(edited("[specimen]\n", text)).size(), 27u);
}

// A file of another kind, with a mistake in every line, is refused as quickly as a job, whatever its size.
TEST(Mistakes, ByTheThousandEndTheReading) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += "k" + std::to_string(i) + " = 1\n";
    EXPECT_TRUE(message_of(text).ends_with("\nand at least 980 more"));
    EXPECT_EQ(mistakes_of(text).size(), InputErrors::most_kept);
    text = "[specimen]\nshape = \"rectangle\"\n";
    for (int i = 0; i < 20'000; ++i) text += "[[test]]\nkind = \"\"\n";
    EXPECT_EQ(mistakes_of(text).size(), InputErrors::most_kept);
}

TEST(Mistakes, ASyntaxErrorStaysAlone) {
    const std::string text = edited("width = \"80 mm\"", "width = 80 mm", edited("porosity = 0.10", "porosity = 1.1"));
    ASSERT_EQ(mistakes_of(text).size(), 1u);
    EXPECT_NE(message_of(text).find("syntax error"), std::string::npos);
}

// What rests on the broken value must not be held against what stands in for it.
TEST(Mistakes, OneBrokenLineIsOneMistakeAtItsLine) {
    for (const std::string& job :
         {sample_job, variant_job, job_template("laboratory"), job_template("brazilian"), job_template("biaxial")})
        for (const BrokenLine& broken : broken_lines(job)) {
            const std::vector<InputError> found = mistakes_of(broken.text);
            ASSERT_EQ(found.size(), 1u) << broken.written << "\n" << message_of(broken.text);
            if (found.front().problem().find("syntax error") != std::string::npos)
                continue;  // a head that tears a list of tables in two
            EXPECT_EQ(found.front().place().line, broken.line) << broken.written << "\n" << found.front().what();
        }
}

TEST(Mistakes, TwoBrokenLinesAreTwoMistakes) {
    const std::vector<BrokenLine> first = broken_lines(sample_job);
    std::size_t tried = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i].written.starts_with('[')) continue;  // what is in a table of an unknown name is not read
        const std::vector<BrokenLine> both = broken_lines(first[i].text);
        for (std::size_t j = 0; j < both.size(); ++j) {
            if (both[j].line <= first[i].line || both[j].written.starts_with('[')) continue;
            const std::vector<InputError> found = mistakes_of(both[j].text);
            ASSERT_EQ(found.size(), 2u) << first[i].written << "\n" << both[j].written << "\n" << message_of(both[j].text);
            EXPECT_EQ(found[0].place().line, first[i].line);
            EXPECT_EQ(found[1].place().line, both[j].line);
            ++tried;
        }
    }
    EXPECT_GT(tried, 1000u);
}

}  // namespace
}  // namespace feldspar
