// Every input that is kept for the fuzzing targets: found by fuzzing, or written for a fault. Reading it ends as it should, whatever the compiler.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fuzz.hpp"

namespace feldspar::fuzz {

#define TARGET(name) void name(std::string_view input);
#include "targets.inc"
#undef TARGET

namespace {

struct Target {
    const char* name;
    void (*feed)(std::string_view);
};

const std::vector<Target>& all_targets() {
    static const std::vector<Target> targets{
#define TARGET(name) {#name, name},
#include "targets.inc"
#undef TARGET
    };
    return targets;
}

class Corpus : public testing::TestWithParam<Target> {};
INSTANTIATE_TEST_SUITE_P(Inputs, Corpus, testing::ValuesIn(all_targets()), [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Corpus, IsReadOrRefused) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    ASSERT_FALSE(files.empty());
    for (const std::filesystem::path& file : files) {
        SCOPED_TRACE(file.string());
        EXPECT_NO_THROW(GetParam().feed(read_text(file)));
    }
}

TEST_P(Corpus, HasNothingAndRubbishInIt) {
    EXPECT_NO_THROW(GetParam().feed(""));
    EXPECT_NO_THROW(GetParam().feed("\n"));
    EXPECT_NO_THROW(GetParam().feed(std::string(1000, '\0')));
    EXPECT_NO_THROW(GetParam().feed(std::string(1000, '[')));
    EXPECT_NO_THROW(GetParam().feed("\xff\xfe\x80\n\xc2"));
}

}  // namespace
}  // namespace feldspar::fuzz
