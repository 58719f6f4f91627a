// Broken jobs by the thousand: each is read or refused with an InputError; nothing crashes, hangs or throws anything else.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_template.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

void expect_read_or_refused(const std::string& text) {
    try {
        (void)parse_job(text, "rubbish");
    } catch (const InputError&) {
    } catch (const std::exception& error) {
        ADD_FAILURE() << "threw something else: " << error.what() << "\non:\n" << text;
    }
}

TEST(JobRubbish, EveryBeginningOfAJob) {
    const std::string text = job_template("laboratory");
    for (std::size_t length = 0; length <= text.size(); length += 3) expect_read_or_refused(text.substr(0, length));
    for (std::size_t length = 0; length <= sample_job.size(); ++length) expect_read_or_refused(sample_job.substr(0, length));
}

TEST(JobRubbish, RandomEdits) {
    std::mt19937_64 random(3);
    const std::string bytes = std::string("[]{}=\"'#,.-+_\n\r\t 0129eExnaif\\\xff\xC2\xB0%mMPG") + '\0';
    for (int i = 0; i < 3000; ++i) {
        std::string text = sample_job;
        for (std::uint64_t edits = 1 + random() % 4; edits > 0; --edits) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
                case 0:
                    text[at] = bytes[random() % bytes.size()];
                    break;
                case 1:
                    text.insert(at, 1, bytes[random() % bytes.size()]);
                    break;
                case 2:
                    text.erase(at, 1 + random() % 12);
                    break;
                default:
                    text.insert(at, text.substr(random() % text.size(), random() % 40));
                    break;
            }
        }
        expect_read_or_refused(text);
    }
}

TEST(JobRubbish, LonelyTokens) {
    for (const char* text :
         {"[", "[[", "[a", "[[a",   "[a.",          "a",    "a=",   "a=[", "a={",  "a=\"",  "a='''",    "=",
          ".", "\"", "]",  "a.b.c", "a=1979-05-27", "a=0x", "a=1e", "a=+", "a=in", "a=tru", "\xEF\xBB", "\xEF\xBB\xBF[",
          "#", "\r", "\\"})
        expect_read_or_refused(text);
    expect_read_or_refused("a=" + std::string(100000, '['));
    std::string dotted = "a";
    for (int i = 0; i < 5000; ++i) dotted += ".a";
    expect_read_or_refused(dotted + " = 1");
    expect_read_or_refused(std::string(1000, '\0'));
}

}  // namespace
}  // namespace feldspar
