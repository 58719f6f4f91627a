// A closed form that Feldspar is held against, as data and one function. `feldspar verify` runs all of them on a user's machine,
// and the fast tests go through the same list, so that an expected value stands once.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace feldspar {

/// By how much a found value may differ from the expected one.
struct CheckBound {
    double size = 0.0;      ///< greater than zero
    bool relative = false;  ///< of the expected value, which is then not zero; else in the unit of the check
};

inline CheckBound relative(double size) { return {size, true}; }
inline CheckBound absolute(double size) { return {size, false}; }

/// An expected value and the one that was found, in the unit of the check.
struct CheckedValue {
    std::string what{};  ///< which case of the check: "span 6 h"; empty where there is one only
    double expected = 0.0;
    double found = std::numeric_limits<double>::quiet_NaN();
};

/// One closed form.
struct Check {
    std::string name{};      ///< "two-grains.strength": topic and what is checked, by lower-case letters, digits, hyphens
    std::string sentence{};  ///< what is checked, in one plain sentence
    std::string formula{};   ///< as text
    std::string source{};    ///< equation of docs/theory as "(C9)", paper or handbook
    std::string unit{};      ///< of all its values; empty for plain numbers
    CheckBound bound{};
    std::string reason{};  ///< why the bound is what it is
    std::function<std::vector<CheckedValue>()> compare{};
    std::string run{};  ///< checks of the same name here, one after the other in the list, stand on one computation; empty: none
};

/// The checks of one topic, each in a file of its own.
struct Topic {
    const char* title;
    std::vector<Check> checks;
};

/// All topics, from single points to whole specimens.
const std::vector<Topic>& all_topics();

}  // namespace feldspar
