// Every input that is kept for the fuzzing targets: found by fuzzing, or written for a fault. Reading it ends as it should,
// whatever the compiler. And so for inputs that come of these by random edits, which need no Clang:
//
//   FELDSPAR_MUTATIONS=100000 build/release/test_corpus --gtest_filter='*Edited*/job'     so many; FELDSPAR_FIRST_MUTATION=n
//   begins elsewhere
//
// What ends the program, or takes more than 20 s of processor time, is in the file that the message names, or "last-input" in the
// current directory.
#include <gtest/gtest.h>
#include <sys/time.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

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

// By the names of their files, in order.
std::map<std::string, std::string> inputs_of(const Target& target) {
    std::map<std::string, std::string> inputs;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
        inputs[entry.path().string()] = read_text(entry.path());
    return inputs;
}

class Corpus : public testing::TestWithParam<Target> {};
INSTANTIATE_TEST_SUITE_P(Inputs, Corpus, testing::ValuesIn(all_targets()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Corpus, IsReadOrRefused) {
    const auto inputs = inputs_of(GetParam());
    ASSERT_FALSE(inputs.empty());
    for (const auto& [file, input] : inputs) {
        SCOPED_TRACE(file);
        EXPECT_NO_THROW(GetParam().feed(input));
    }
}

// Inputs by random edits of others: bytes, numbers, lines, and pieces of one another.
class Editor {
public:
    explicit Editor(const std::vector<std::string>& inputs) : inputs_(inputs) {}

    std::string input(std::uint64_t number) {
        random_.seed(number);
        std::string text = inputs_[below(inputs_.size())];
        for (std::size_t edits = 1 + below(below(4) == 0 ? 12 : 3); edits > 0; --edits) edit(text);
        return text.substr(0, 20'000);
    }

private:
    std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

    std::pair<std::size_t, std::size_t> a_line(const std::string& text) {  // begin and length, with its end
        const std::size_t at = below(text.size()), begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1,
                          end = std::min(text.find('\n', at), text.size() - 1);
        return {begin, end + 1 - begin};
    }

    void edit(std::string& text) {
        static const std::vector<std::string> pieces{"0",
                                                     "-1",
                                                     "1e308",
                                                     "-1e308",
                                                     "1e-320",
                                                     "nan",
                                                     "inf",
                                                     "1e999",
                                                     "9223372036854775807",
                                                     "-9223372036854775808",
                                                     "2147483648",
                                                     "4294967295",
                                                     "0.1",
                                                     "1e300",
                                                     "",
                                                     "\"\"",
                                                     "[]",
                                                     "{}",
                                                     "[[",
                                                     "]]",
                                                     "\n",
                                                     ",",
                                                     " ",
                                                     "=",
                                                     ".",
                                                     "\"",
                                                     "'",
                                                     "#",
                                                     "%",
                                                     "mm",
                                                     " GPa",
                                                     "true",
                                                     std::string(1, '\0'),
                                                     "\xff",
                                                     "\xc2\x9b",
                                                     std::string(300, 'a')};
        if (text.empty()) text = pieces[below(pieces.size())];
        if (text.empty()) return;
        const std::size_t at = below(text.size());
        switch (below(9)) {
            case 0:
                text[at] = static_cast<char>(random_());
                return;
            case 1:
                text.insert(at, pieces[below(pieces.size())]);
                return;
            case 2:
                text.erase(at, 1 + below(20));
                return;
            case 3:
                text.insert(at, text.substr(below(text.size()), below(60)));
                return;
            case 4: {  // a number
                std::size_t digit = text.find_first_of("0123456789", at);
                if (digit == std::string::npos) return;
                std::size_t end = text.find_first_not_of("0123456789.eE+-", digit);
                text.replace(digit, std::min(end, text.size()) - digit, pieces[below(15)]);
                return;
            }
            case 5: {
                const auto [begin, length] = a_line(text);
                text.erase(begin, length);
                return;
            }
            case 6: {
                const auto [begin, length] = a_line(text);
                const std::string line = text.substr(begin, length);
                text.insert(a_line(text).first, line);
                return;
            }
            case 7: {  // a line of another input
                const std::string& other = inputs_[below(inputs_.size())];
                if (other.empty()) return;
                const auto [begin, length] = a_line(other);
                text.insert(a_line(text).first, other.substr(begin, length));
                return;
            }
            default:
                text.resize(at);
                return;
        }
    }

    const std::vector<std::string>& inputs_;
    std::mt19937_64 random_;
};

TEST_P(Corpus, EditedIsReadOrRefused) {
    const auto number_of = [](const char* variable, std::uint64_t otherwise) {
        const char* text = std::getenv(variable);
        return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
    };
    const bool many = std::getenv("FELDSPAR_MUTATIONS") != nullptr;
    const std::uint64_t first = number_of("FELDSPAR_FIRST_MUTATION", 1), count = number_of("FELDSPAR_MUTATIONS", 40);
    std::vector<std::string> inputs;
    for (const auto& [file, input] : inputs_of(GetParam())) inputs.push_back(input);
    Editor editor(inputs);
    const itimerval limit{{0, 0}, {20, 0}};  // of processor time, so that a busy machine is no fault
    for (std::uint64_t number = first; number < first + count; ++number) {
        const std::string input = editor.input(number);
        if (many) {
            write_text("last-input", input);
            setitimer(ITIMER_PROF, &limit, nullptr);
        }
        try {
            GetParam().feed(input);
        } catch (const std::exception& error) {
            const std::string file = std::string("fault-") + GetParam().name + "-" + std::to_string(number);
            write_text(file, input);
            ADD_FAILURE() << "FELDSPAR_FIRST_MUTATION=" << number << ": " << error.what() << "\nin the file " << file;
        }
    }
    const itimerval none{};
    setitimer(ITIMER_PROF, &none, nullptr);
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
