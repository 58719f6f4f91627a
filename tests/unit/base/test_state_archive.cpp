// States are written and read back to the bit, in few bytes; what is damaged is never taken.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <unordered_map>

#include "feldspar/base/state_archive.hpp"

namespace feldspar {
namespace {

struct Flat {
    double x = 0.0;
    bool on = false;
    int count = 0;

    bool operator==(const Flat&) const = default;
};

enum class Colour { red, green };

class Private {
public:
    explicit Private(int value = 0) : value_(value), squares_{{value, {1, 2}}, {-value, {3}}} {}
    bool operator==(const Private&) const = default;

    template <class Archive>
    void keep(Archive& archive) {
        auto& [value, squares] = *this;
        archive(value, squares);
    }

private:
    int value_;
    std::unordered_map<long long, std::vector<int>> squares_;
};

struct Everything {
    double number = 0.0;
    Colour colour = Colour::red;
    std::string text;
    std::vector<double> dense;
    std::vector<Flat> flats;
    std::vector<std::string> texts;
    std::array<std::vector<int>, 2> pair;
    std::optional<double> maybe, none;
    Private hidden;
    std::shared_ptr<const Flat> first, second, nobody;

    bool same_as(const Everything& o) const {
        return number == o.number && colour == o.colour && text == o.text && dense == o.dense && flats == o.flats &&
               texts == o.texts && pair == o.pair && maybe == o.maybe && none == o.none && hidden == o.hidden &&
               *first == *o.first && first == second && o.first == o.second && nobody == o.nobody;
    }
};

std::string written(const Everything& value, const StateBase& base) {
    std::string bytes;
    StateWriter writer([&](const void* data, std::size_t count) { bytes.append(static_cast<const char*>(data), count); }, base);
    writer.write(value);
    return bytes;
}

Everything some(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Everything value;
    value.number = 0.1;
    value.colour = Colour::green;
    value.text = "a text";
    for (int i = 0; i < 1003; ++i) {
        value.dense.push_back(random() % 3 == 0 ? static_cast<double>(random()) : 0.0);
        value.flats.push_back({static_cast<double>(random()), random() % 2 == 0, static_cast<int>(random() % 9)});
    }
    value.texts = {"one", "", "three"};
    value.pair = {std::vector<int>(300, 7), std::vector<int>(300, 7)};
    value.maybe = 2.5;
    value.hidden = Private(static_cast<int>(seed));
    value.first = value.second = std::make_shared<const Flat>(Flat{1.0, true, 2});
    return value;
}

TEST(StateArchive, GivesBackWhatWasWritten) {
    const Everything value = some(1);
    const StateBase nothing;
    const std::string bytes = written(value, nothing);
    Everything read = some(2);  // whatever was there goes
    StateReader reader(bytes);
    reader.read(read);
    EXPECT_TRUE(reader.at_end());
    EXPECT_TRUE(read.same_as(value));
}

TEST(StateArchive, WhatIsAsInTheBaseStateTakesNoSpace) {
    const Everything base_value = some(1);
    const StateBase base = StateBase::of(base_value);
    Everything value = base_value;
    value.flats[500].count += 1;
    const std::string bytes = written(value, base);
    EXPECT_LT(bytes.size(), 1003 * sizeof(int) + 1000);  // one column of the flats, and checksums
    Everything read = base_value;
    StateReader reader(bytes);
    reader.read(read);
    EXPECT_TRUE(read.same_as(value));
}

TEST(StateArchive, AnotherBaseStateIsRefused) {
    const StateBase base = StateBase::of(some(1));
    const std::string bytes = written(some(1), base);
    Everything other = some(2);
    StateReader reader(bytes);
    EXPECT_THROW(reader.read(other), StateError);
    EXPECT_NE(base.fingerprint(), StateBase::of(some(2)).fingerprint());
}

// Whatever the bytes are: an error, or values; never a crash or all memory.
TEST(StateArchive, DamageIsAnErrorOrAnotherState) {
    const StateBase nothing;
    const std::string good = written(some(1), nothing);
    std::mt19937 random(4);
    int refused = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        std::string bytes = good;
        if (trial % 3 == 0)
            bytes.resize(random() % bytes.size());
        else
            for (int k = 0; k < 1 + trial % 4; ++k)
                bytes[random() % (trial % 2 == 0 ? 200 : bytes.size())] = static_cast<char>(random());
        Everything read;
        try {
            StateReader reader(bytes);
            reader.read(read);
        } catch (const StateError&) {
            ++refused;
        } catch (const std::bad_alloc&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace feldspar
