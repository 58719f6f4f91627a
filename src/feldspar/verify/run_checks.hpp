// Runs checks and judges what they found.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/verify/check.hpp"

namespace feldspar {

/// A comparison and whether it lies within the check's bound.
struct Judged {
    CheckedValue comparison;
    double error = 0.0;  ///< found - expected, over the expected value where the bound is relative
    bool within = false;
};

/// A check that was run.
struct CheckResult {
    const Check* check = nullptr;
    const char* topic = "";
    std::vector<Judged> judged;
    std::string failure;   ///< what the check threw, if it did
    double seconds = 0.0;  ///< of one thread

    /// All its comparisons lie within the bound. A check that compares nothing, or threw, does not.
    bool within() const;
    /// The comparison that comes nearest to the bound, or goes farthest beyond it; null without any.
    const Judged* worst() const;
};

/// What the comparisons of a check are worth. A value that is not finite, and an expected zero under a relative bound, lie
/// outside.
CheckResult judge(const Check& check, const char* topic, const std::vector<CheckedValue>& comparisons);

/// Runs one check. Never throws because of what the check throws.
CheckResult run_check(const Check& check, const char* topic);

/// Runs all checks of the topics whose name or topic the filter lets pass. @param filter  may be empty: all  @param threads
/// checks side by side; the values do not depend on it  @param told  called for each that is done, one at a time; may be empty
/// @return in the order of the list
std::vector<CheckResult> run_checks(const std::vector<Topic>& topics, const std::function<bool(const Check&)>& filter,
                                    int threads, const std::function<void(const CheckResult&)>& told = {});

}  // namespace feldspar
