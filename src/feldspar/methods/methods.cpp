#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

// A laboratory wraps the disc in a layer of masking tape, about 0.25 mm of a modulus near 0.4 GPa (docs/decisions, fixture of the
// Brazilian test).
constexpr double tape_Kn_Pa_m = 1.6e12;

template <class Such>
MethodId the_one(const Such& such, std::string_view what) {
    const std::span<const MethodId> all = test_methods();
    const auto found = std::ranges::find_if(all, such);
    if (found == all.end()) throw std::logic_error("no test method measures " + std::string(what));
    return *found;
}

}  // namespace

std::vector<StageGroup> stages_of(const TestSpec& test) {
    const auto& of_method = method_of(test).build.stages;
    return of_method != nullptr ? of_method(test) : test.stages;
}

std::span<const MethodId> test_methods() {
    static const std::array all{
#define FELDSPAR_METHOD(definition) MethodId(methods::definition),
#include "feldspar/methods/list.inc"
#undef FELDSPAR_METHOD
    };
    return all;
}

std::size_t MethodId::place(MethodId id) {
    const std::span<const MethodId> all = test_methods();
    return static_cast<std::size_t>(std::ranges::find(all, id) - all.begin());
}

const char* name(MethodId method) { return method.definition().name; }

std::optional<MethodId> find_method(std::string_view name) {
    const std::span<const MethodId> all = test_methods();
    const auto found = std::ranges::find_if(all, [&](MethodId id) { return name == id.definition().name; });
    return found == all.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string_view> short_method_names() {
    std::vector<std::string_view> names;
    for (const MethodId id : test_methods())
        if (const std::string_view strength = id.definition().strength.name; !strength.empty()) names.push_back(strength);
    return names;
}

std::optional<MethodId> find_method_called(std::string_view word) {
    if (const auto found = find_method(word)) return found;
    const auto capital = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
    const auto same = [&](std::string_view name) {
        return std::ranges::equal(word, name, [&](char a, char b) { return capital(a) == capital(b); });
    };
    const auto found =
        std::ranges::find_if(test_methods(), [&](MethodId id) { return !word.empty() && same(id.definition().strength.name); });
    return found == test_methods().end() ? std::nullopt : std::optional(*found);
}

MethodId method_of_strength(std::string_view name) {
    return the_one([&](MethodId id) { return id.definition().strength.name == name; }, name);
}

MethodId method_of_confined_strength() {
    return the_one([](MethodId id) { return id.definition().loading.on_envelope && id.definition().specimen.confined; },
                   "a confined strength");
}

TestSpec usual_test(MethodId kind, bool flattened) {
    TestSpec test;
    test.kind = kind;
    test.stop_fraction = method_of(kind).loading.stop_fraction;
    if (method_of(kind).specimen.own_disc && !flattened) {
        test.plates = PlateShape::curved;
        test.plate_Kn_Pa_m = tape_Kn_Pa_m;
    }
    return test;
}

}  // namespace feldspar
